// SPDX-License-Identifier: Apache-2.0
import {
  AdditiveBlending, FloatType, HalfFloatType, Mesh, OrthographicCamera, PlaneGeometry, Scene, ShaderMaterial, WebGLRenderTarget,
  type PerspectiveCamera, type WebGLRenderer,
} from 'three';
import { radicalInverse } from './spread.ts';

const vertexShader = /* glsl */ `varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }`;

/** Very bright glints are held, or one pass alone would leave specks in the mean. */
const addShader = /* glsl */ `
uniform sampler2D picture; uniform float weight; varying vec2 at;
void main() { gl_FragColor = vec4(weight * min(texture2D(picture, at).rgb, vec3(3.0)), 1.0); }`;

/** Dithering keeps the dark background free of bands in eight bits. */
const showShader = /* glsl */ `
uniform sampler2D picture; varying vec2 at;
void main() {
  vec2 off = at - 0.5;
  gl_FragColor = vec4(texture2D(picture, at).rgb * (1.0 - 0.55 * dot(off, off)), 1.0);
  #include <tonemapping_fragment>
  #include <colorspace_fragment>
  float dither = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  gl_FragColor.rgb += (dither - 0.5) / 255.0;
}`;

/**
 * Draws the scene many times, each time a part of a pixel aside and under other samples of its lights, and shows the
 * mean: smooth edges and soft shadows from plain hard-edged passes.
 */
export function accumulate(renderer: WebGLRenderer, scene: Scene, camera: PerspectiveCamera, passes: number, prepare: (pass: number) => void): void {
  const width = renderer.domElement.width, height = renderer.domElement.height;
  const blendsFloat = renderer.extensions.has('EXT_float_blend');
  const one = new WebGLRenderTarget(width, height, { type: HalfFloatType });
  const sum = new WebGLRenderTarget(width, height, { type: blendsFloat ? FloatType : HalfFloatType, depthBuffer: false });
  const add = new ShaderMaterial({
    vertexShader, fragmentShader: addShader, blending: AdditiveBlending, depthTest: false, depthWrite: false,
    uniforms: { picture: { value: one.texture }, weight: { value: 1 / passes } },
  });
  const show = new ShaderMaterial({ vertexShader, fragmentShader: showShader, depthTest: false, uniforms: { picture: { value: sum.texture } } });
  const sheet = new Mesh(new PlaneGeometry(2, 2), add);
  const flat = new Scene().add(sheet);
  const flatCamera = new OrthographicCamera();
  renderer.setRenderTarget(sum);
  renderer.setClearColor(0x000000, 0);
  renderer.clear();
  for (let pass = 0; pass < passes; ++pass) {
    prepare(pass);
    camera.setViewOffset(width, height, 1.2 * (radicalInverse(pass, 2) - 0.5), 1.2 * (radicalInverse(pass, 3) - 0.5), width, height);
    renderer.setRenderTarget(one);
    renderer.render(scene, camera);
    renderer.setRenderTarget(sum);
    renderer.autoClear = false;
    renderer.render(flat, flatCamera);
    renderer.autoClear = true;
  }
  sheet.material = show;
  renderer.setRenderTarget(null);
  renderer.render(flat, flatCamera);
  for (const used of [one, sum, add, show, sheet.geometry]) used.dispose();
}
