// SPDX-License-Identifier: Apache-2.0
import { ACESFilmicToneMapping, Box3, PCFShadowMap, PerspectiveCamera, Sphere, Vector3, WebGLRenderer } from 'three';
import { accumulate } from './accumulate.ts';
import { frameCamera, placeCamera } from './camera.ts';
import { createEnvironment } from './environment.ts';
import { readSurface } from './read_surface.ts';
import type { PictureRequest } from './request.ts';
import { buildStill } from './scene.ts';
import { splitCreases } from './split_creases.ts';
import type { Surface } from './surface.ts';

/** Enough edge, lamp and sky samples that no grain is left, few enough that software rendering stays in seconds. */
const passes = 14;

/** Makes all stills of the request the page; throws an Error whose text names the surface and the fault. */
export function drawPicture(request: PictureRequest): void {
  const page = drawStrip(request);
  page.style.width = `${request.size[0]}px`;
  page.style.height = `${request.size[1]}px`;
  document.body.replaceChildren(page);
}

/** All stills of the request side by side. */
export function drawStrip(request: PictureRequest): HTMLElement {
  const surfaces = request.surfaces.map(({ name, base64 }) => {
    try {
      return readSurface(name, bytesOf(base64));
    } catch (error) {
      throw new Error(`${name}: ${(error as Error).message}`);
    }
  });
  const width = Math.floor(request.size[0] / surfaces.length), height = request.size[1];
  const renderer = createRenderer(width, height);
  const environment = createEnvironment(renderer);
  const blade = request.blade && {
    heel: new Vector3().fromArray(request.blade.heel),
    tip: new Vector3().fromArray(request.blade.tip),
  };
  const points = gatherPoints(surfaces, blade);
  const box = new Box3().setFromArray(gatherPoints(surfaces, undefined));
  const bounds = box.getBoundingSphere(new Sphere());
  const floorHeight = box.min.z - 0.06 * bounds.radius;
  const camera = chooseCamera(request, points, width / height);
  const strip = layOut(request);
  surfaces.forEach((surface, i) => {
    const still = buildStill({ mesh: splitCreases(surface), bounds, floorHeight, blade, camera, environment });
    accumulate(renderer, still.scene, camera, passes, (pass) => {
      still.placeLamp(pass);
      still.sky.look(renderer, pass, passes);
    });
    still.sky.dispose();
    addPanel(strip, renderer.domElement, surfaces.length > 1 ? request.surfaces[i].caption : '');
  });
  renderer.dispose();
  renderer.forceContextLoss(); // a page may have few contexts at once
  return strip;
}

function bytesOf(base64: string): Uint8Array {
  return Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
}

function createRenderer(width: number, height: number): WebGLRenderer {
  const canvas = document.createElement('canvas');
  const context = canvas.getContext('webgl2', { preserveDrawingBuffer: true });
  if (!context) throw new Error('the browser gives no WebGL 2; use one that does, or update its graphics driver');
  const renderer = new WebGLRenderer({ canvas, context });
  renderer.setSize(width, height, false);
  renderer.toneMapping = ACESFilmicToneMapping;
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = PCFShadowMap;
  return renderer;
}

function gatherPoints(surfaces: Surface[], blade: { heel: Vector3; tip: Vector3 } | undefined): Float32Array {
  const ends = blade ? [...blade.heel, ...blade.tip] : [];
  const all = new Float32Array(surfaces.reduce((sum, surface) => sum + surface.points.length, ends.length));
  all.set(ends);
  surfaces.reduce((at, surface) => (all.set(surface.points, at), at + surface.points.length), ends.length);
  return all;
}

function chooseCamera(request: PictureRequest, points: Float32Array, aspect: number): PerspectiveCamera {
  const { camera, view } = request;
  return camera ? placeCamera(camera.eye, camera.target, camera.fov, aspect) : frameCamera(points, view ?? 'three_quarter', aspect);
}

function layOut(request: PictureRequest): HTMLElement {
  const page = document.createElement('main');
  if (request.title) {
    const title = document.createElement('h1');
    title.textContent = request.title;
    page.append(title);
  }
  return page;
}

/** One renderer serves all panels, so each still is copied out of it. */
function addPanel(page: HTMLElement, drawn: HTMLCanvasElement, caption: string): void {
  const panel = document.createElement('figure');
  const copy = document.createElement('canvas');
  copy.width = drawn.width;
  copy.height = drawn.height;
  copy.getContext('2d')!.drawImage(drawn, 0, 0);
  panel.append(copy);
  if (caption) {
    const text = document.createElement('figcaption');
    text.textContent = caption;
    panel.append(text);
  }
  page.append(panel);
}
