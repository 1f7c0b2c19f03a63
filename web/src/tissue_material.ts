// SPDX-License-Identifier: Apache-2.0
import { Color, DoubleSide, MeshPhysicalMaterial } from 'three';
import { shadeBySky, type SkyShadow } from './sky_shadow.ts';

const noise = /* glsl */ `
varying vec3 tissuePlace;
varying float tissueInside;
uniform vec3 skinColour, skinSpot, fleshColour, fleshSpot;
float hash(vec3 p) {
  p = fract(p * vec3(0.1031, 0.1030, 0.0973));
  p += dot(p, p.yxz + 33.33);
  return fract((p.x + p.y) * p.z);
}
float lumps(vec3 p) {
  vec3 i = floor(p), f = fract(p);
  f = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
  return mix(
    mix(mix(hash(i), hash(i + vec3(1, 0, 0)), f.x), mix(hash(i + vec3(0, 1, 0)), hash(i + vec3(1, 1, 0)), f.x), f.y),
    mix(mix(hash(i + vec3(0, 0, 1)), hash(i + vec3(1, 0, 1)), f.x), mix(hash(i + vec3(0, 1, 1)), hash(i + vec3(1, 1, 1)), f.x), f.y),
    f.z);
}
float cloud(vec3 p) {
  return 0.53 * lumps(p) + 0.27 * lumps(2.03 * p + 17.0) + 0.13 * lumps(4.1 * p + 5.0) + 0.07 * lumps(8.3 * p + 9.0);
}
vec3 slope(vec3 p) {
  const float e = 0.15;
  return vec3(lumps(p + vec3(e, 0, 0)), lumps(p + vec3(0, e, 0)), lumps(p + vec3(0, 0, e))) - lumps(p);
}
`;

/** Broad mottling on the skin; a fine grain with paler lobules where the blade opened the organ. */
const paint = /* glsl */ `#include <color_fragment>
float mottle = smoothstep(0.3, 0.7, cloud(9.0 * tissuePlace));
float speck = cloud(60.0 * tissuePlace);
vec3 skin = mix(skinColour, skinSpot, mottle) * (0.9 + 0.2 * speck);
float grain = smoothstep(0.3, 0.75, cloud(75.0 * tissuePlace));
vec3 flesh = mix(fleshColour, fleshSpot, 0.65 * grain + 0.35 * mottle);
diffuseColor.rgb = mix(skin, flesh, tissueInside);
`;

/** The wet film lies smoothly on the skin and breaks up on the cut faces. */
const relief = /* glsl */ `#include <clearcoat_normal_fragment_begin>
{
  vec3 broad = (viewMatrix * vec4(slope(26.0 * tissuePlace), 0.0)).xyz;
  vec3 fine = (viewMatrix * vec4(slope(90.0 * tissuePlace), 0.0)).xyz;
  normal = normalize(normal - mix(0.30, 0.25, tissueInside) * broad - mix(0.12, 0.65, tissueInside) * fine);
  clearcoatNormal = normalize(clearcoatNormal - 0.10 * broad - mix(0.02, 0.40, tissueInside) * fine);
}
`;

/** Light that enters flesh leaves it red nearby: a faint warm edge stands in for scattering below the surface. */
const glow = /* glsl */ `
float edge = pow(1.0 - abs(dot(normalize(vNormal), normalize(vViewPosition))), 2.5);
outgoingLight += open * edge * vec3(0.085, 0.012, 0.010);
#include <opaque_fragment>`;

/**
 * Wet organ tissue, painted in material coordinates so that the pattern stays with the flesh when it moves, and runs on
 * from one side of a cut to the other. `size` is the rest diagonal that one pattern spans.
 */
export function createTissueMaterial(sky: SkyShadow, size: number): MeshPhysicalMaterial {
  const material = new MeshPhysicalMaterial({
    side: DoubleSide,
    roughness: 0.46,
    clearcoat: 0.85,
    clearcoatRoughness: 0.17,
    specularIntensity: 0.5,
    sheen: 0.2,
    sheenColor: new Color(0xff6048),
    sheenRoughness: 0.5,
  });
  const uniforms = {
    tissueScale: { value: 1 / size },
    skinColour: { value: new Color(0x7d2019) },
    skinSpot: { value: new Color(0x5d130f) },
    fleshColour: { value: new Color(0x8e2a22) },
    fleshSpot: { value: new Color(0xc0655a) },
  };
  shadeBySky(material, sky, (shader) => {
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', '#include <common>\nattribute vec3 rest;\nattribute float inside;\nuniform float tissueScale;\nvarying vec3 tissuePlace;\nvarying float tissueInside;')
      .replace('#include <begin_vertex>', '#include <begin_vertex>\ntissuePlace = rest * tissueScale;\ntissueInside = inside;');
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', '#include <common>\n' + noise)
      .replace('#include <color_fragment>', paint)
      .replace('#include <clearcoat_normal_fragment_begin>', relief)
      .replace('#include <opaque_fragment>', glow);
  });
  return material;
}
