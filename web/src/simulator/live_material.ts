// SPDX-License-Identifier: Apache-2.0
import { Color, type MeshPhysicalMaterial, type Plane } from 'three';
import type { SkyShadow } from '../sky_shadow.ts';
import { createTissueMaterial } from '../tissue_material.ts';

/** What is painted on the body. */
export type Paint = 'tissue' | 'stress' | 'pieces';

/** From low to high, evenly; lightness grows all the way, so that it also reads in grey. */
export const scaleColours = ['#2a1658', '#3a4a92', '#1f7f93', '#33a877', '#9acb4a', '#fce65c'];

const declarations = /* glsl */ `
uniform int livePaint;
uniform vec2 liveRange;
uniform vec3 liveScale[${scaleColours.length}];
varying float liveStress;
varying float livePiece;
vec3 scaleColour(float t) {
  float at = clamp(t, 0.0, 1.0) * ${(scaleColours.length - 1).toFixed(1)};
  int low = min(int(at), ${scaleColours.length - 2});
  return mix(liveScale[low], liveScale[low + 1], at - float(low));
}
vec3 pieceColour(float id) {
  vec3 hue = fract(vec3(id * 0.381966) + vec3(0.02, 0.36, 0.69));
  return mix(vec3(0.72, 0.62, 0.55), 0.5 + 0.5 * cos(6.2831853 * hue), 0.45);
}
`;

/** A body that is clipped shows its inner side: flesh. */
const paint = /* glsl */ `
if (livePaint == 1) diffuseColor.rgb = scaleColour((liveStress - liveRange.x) / max(liveRange.y - liveRange.x, 1.0e-9));
else if (livePaint == 2) diffuseColor.rgb = pieceColour(livePiece);
else if (!gl_FrontFacing) diffuseColor.rgb = mix(fleshColour, fleshSpot, 0.5);
`;

/** The engine's normals are smooth all over the skin; where the body has an edge, as a block has, the face's own is taken. */
const edges = /* glsl */ `#include <normal_fragment_begin>
{
  vec3 ofFace = normalize(cross(dFdx(vViewPosition), dFdy(vViewPosition)));
  normal = normalize(mix(ofFace, normal, smoothstep(0.75, 0.92, dot(ofFace, normal))));
  nonPerturbedNormal = normal;
}`;

/** Flesh lets light through: however narrow, a wound is red inside, not black. */
const wound = /* glsl */ `
outgoingLight += tissueInside * (livePaint == 0 ? 1.0 : 0.3) * vec3(0.075, 0.013, 0.010);
if (!gl_FrontFacing && livePaint == 0) outgoingLight = 0.55 * diffuseColor.rgb;
#include <opaque_fragment>`;

export interface LiveMaterial {
  material: MeshPhysicalMaterial;
  setPaint(paint: Paint): void;
  /** Of stresses, Pa, that the colours span. */
  setRange(low: number, high: number): void;
  setSize(size: number): void;
  setClip(plane: Plane | undefined): void;
  setTranslucent(on: boolean): void;
  setSky(on: boolean): void;
}

export function createLiveMaterial(sky: SkyShadow): LiveMaterial {
  const uniforms = {
    livePaint: { value: 0 },
    liveRange: { value: [0, 1] },
    liveScale: { value: scaleColours.map((colour) => new Color(colour)) },
  };
  const material = createTissueMaterial(sky, 1, (shader) => {
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', '#include <common>\nattribute float stress;\nattribute float piece;\nvarying float liveStress;\nvarying float livePiece;')
      .replace('#include <begin_vertex>', '#include <begin_vertex>\nliveStress = stress;\nlivePiece = piece;');
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', '#include <common>\n' + declarations)
      .replace('diffuseColor.rgb = mix(skin, flesh, tissueInside);', 'diffuseColor.rgb = mix(skin, flesh, tissueInside);' + paint)
      .replace('#include <normal_fragment_begin>', edges)
      .replace('#include <opaque_fragment>', wound);
  });
  const paints: Paint[] = ['tissue', 'stress', 'pieces'];
  return {
    material,
    setPaint: (wanted) => {
      uniforms.livePaint.value = paints.indexOf(wanted);
      material.clearcoat = wanted === 'tissue' ? 0.85 : 0.25;
    },
    setRange: (low, high) => {
      uniforms.liveRange.value = [low, high];
    },
    setSize: (size) => {
      (material.userData.scale as { value: number }).value = 1 / size;
    },
    setClip: (plane) => {
      material.clippingPlanes = plane ? [plane] : [];
      material.clipShadows = true;
      material.needsUpdate = true;
    },
    setTranslucent: (on) => {
      material.transparent = on;
      material.opacity = on ? 0.28 : 1;
      material.depthWrite = !on;
    },
    setSky: (on) => {
      if (on) delete material.defines!.NO_SKY;
      else material.defines!.NO_SKY = '';
      material.needsUpdate = true;
    },
  };
}
