// SPDX-License-Identifier: Apache-2.0
import { Color, DoubleSide, MeshPhysicalMaterial } from 'three';
import { shadeBySky, type ShaderChange, type SkyShadow } from './sky_shadow.ts';

const noise = /* glsl */ `
varying vec3 tissuePlace;
varying float tissueInside;
uniform vec3 skinColour, skinSpot, fleshColour, fleshSpot;
float hash(vec3 p) {
  p = fract(p * vec3(0.1031, 0.1030, 0.0973));
  p += dot(p, p.yxz + 33.33);
  return fract((p.x + p.y) * p.z);
}
// Smooth noise about 0.5 (x) and its slope (yzw).
vec4 lumps(vec3 p) {
  vec3 i = floor(p), f = fract(p);
  vec3 u = f * f * (3.0 - 2.0 * f), du = 6.0 * f * (1.0 - f);
  float a = hash(i), b = hash(i + vec3(1, 0, 0)), c = hash(i + vec3(0, 1, 0)), d = hash(i + vec3(1, 1, 0));
  float e = hash(i + vec3(0, 0, 1)), g = hash(i + vec3(1, 0, 1)), h = hash(i + vec3(0, 1, 1)), k = hash(i + vec3(1, 1, 1));
  float near = mix(mix(a, b, u.x), mix(c, d, u.x), u.y), far = mix(mix(e, g, u.x), mix(h, k, u.x), u.y);
  float alongX = mix(mix(b - a, d - c, u.y), mix(g - e, k - h, u.y), u.z);
  float alongY = mix(mix(c - a, d - b, u.x), mix(h - e, k - g, u.x), u.z);
  return vec4(mix(near, far, u.z), du * vec3(alongX, alongY, far - near));
}
float cloud(vec3 p) {
  return 0.56 * lumps(p).x + 0.28 * lumps(2.03 * p + 17.0).x + 0.16 * lumps(4.1 * p + 5.0).x;
}
`;

/** Broad mottling on the skin; a fine grain with paler lobules where the blade opened the organ. */
const paint = /* glsl */ `#include <color_fragment>
float mottle = smoothstep(0.3, 0.7, cloud(9.0 * tissuePlace));
float speck = cloud(70.0 * tissuePlace);
vec3 skin = mix(skinColour, skinSpot, mottle) * (0.85 + 0.3 * speck);
vec3 flesh = mix(fleshColour, fleshSpot, 0.7 * smoothstep(0.3, 0.75, speck) + 0.3 * mottle);
diffuseColor.rgb = mix(skin, flesh, tissueInside);
`;

/** The wet film lies smoothly on the skin and breaks up on the cut faces. */
const relief = /* glsl */ `#include <clearcoat_normal_fragment_begin>
{
  vec3 broad = (viewMatrix * vec4(lumps(24.0 * tissuePlace).yzw, 0.0)).xyz;
  vec3 fine = (viewMatrix * vec4(lumps(90.0 * tissuePlace).yzw, 0.0)).xyz;
  normal = normalize(normal - 0.05 * broad - mix(0.02, 0.08, tissueInside) * fine);
  clearcoatNormal = normalize(clearcoatNormal - 0.04 * broad - mix(0.004, 0.05, tissueInside) * fine);
}
`;

/** Light that enters flesh leaves it red nearby: a faint warm edge stands in for scattering below the surface. */
const glow = /* glsl */ `
float edge = pow(1.0 - abs(dot(normalize(vNormal), normalize(vViewPosition))), 2.5);
outgoingLight += open * edge * vec3(0.085, 0.012, 0.010);
#include <opaque_fragment>`;

/**
 * Wet organ tissue, painted in material coordinates so that the pattern stays with the flesh when it moves, and runs on
 * from one side of a cut to the other. `size` is the rest diagonal that one pattern spans; `more` changes the shader
 * further. A live page sets another size in `userData.scale.value`, as one part by it.
 */
export function createTissueMaterial(sky: SkyShadow, size: number, more?: ShaderChange): MeshPhysicalMaterial {
  const material = new MeshPhysicalMaterial({
    side: DoubleSide,
    roughness: 0.46,
    clearcoat: 0.85,
    clearcoatRoughness: 0.2,
    specularIntensity: 0.5,
  });
  const uniforms = {
    tissueScale: { value: 1 / size },
    skinColour: { value: new Color(0x7a2a20) },
    skinSpot: { value: new Color(0x561a14) },
    fleshColour: { value: new Color(0x8f342a) },
    fleshSpot: { value: new Color(0xae5347) },
  };
  material.userData.scale = uniforms.tissueScale;
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
    more?.(shader);
  });
  return material;
}
