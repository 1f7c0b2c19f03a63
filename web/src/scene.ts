// SPDX-License-Identifier: Apache-2.0
import {
  BufferAttribute, BufferGeometry, CircleGeometry, Color, DirectionalLight, Euler, Mesh, MeshStandardMaterial, PerspectiveCamera, Scene, Sphere, Vector3,
  type Texture,
} from 'three';
import { createScalpel } from './scalpel.ts';
import { createSkyShadow, shadeBySky, type SkyShadow } from './sky_shadow.ts';
import type { Mesh as TissueMesh } from './split_creases.ts';
import { radicalInverse } from './spread.ts';
import { createTissueMaterial } from './tissue_material.ts';

const background = new Color(0x1c2a32);
const floorColour = new Color(0x1d464b);

export interface Still {
  scene: Scene;
  sky: SkyShadow;
  /** Moves the lamp to one of many places on its disc, for a soft shadow. */
  placeLamp(pass: number): void;
}

export interface StillOptions {
  mesh: TissueMesh;
  /** Around all bodies of the strip, so that its stills share lights and floor. */
  bounds: Sphere;
  floorHeight: number;
  blade: { heel: Vector3; tip: Vector3 } | undefined;
  camera: PerspectiveCamera;
  environment: Texture;
}

export function buildStill({ mesh, bounds, floorHeight, blade, camera, environment }: StillOptions): Still {
  const scene = new Scene();
  scene.background = background;
  scene.environment = environment;
  const tissue = tissueGeometry(mesh);
  const scalpel = blade && createScalpel(blade.heel, blade.tip, camera.position);
  const casters = scalpel ? [tissue, scalpel.blade, scalpel.handle] : [tissue];
  const rig = turnLights(camera, bounds, floorHeight);
  scene.environmentRotation.copy(rig.rotation);
  const sky = createSkyShadow(casters, bounds.center, 1.6 * bounds.radius, rig.fromBelow);
  addBody(scene, tissue, createTissueMaterial(sky, 2 * bounds.radius));
  if (scalpel) {
    const steel = new MeshStandardMaterial({ color: 0xe2e6e8, metalness: 1, roughness: 0.3, envMapIntensity: 2.4 });
    const grip = new MeshStandardMaterial({ color: 0xb9c0c4, metalness: 1, roughness: 0.42, envMapIntensity: 2.4 });
    shadeBySky(steel, sky);
    shadeBySky(grip, sky);
    // The blade is thinner than a texel of the lamp's shadow, so that it would only speckle itself.
    addBody(scene, scalpel.blade, steel).receiveShadow = false;
    addBody(scene, scalpel.handle, grip);
  }
  if (!rig.fromBelow) scene.add(createFloor(sky, bounds, floorHeight));
  return { scene, sky, placeLamp: addLamp(scene, bounds, rig.rotation) };
}

/**
 * The lights go round the body with the eye, so that every view is lit alike. From under the floor they are turned
 * upside down and the floor, which would hide the body, is left out.
 */
function turnLights(camera: PerspectiveCamera, bounds: Sphere, floorHeight: number): { rotation: Euler; fromBelow: boolean } {
  const eye = camera.position.clone().sub(bounds.center);
  const overhead = Math.hypot(eye.x, eye.y) < 0.2 * eye.length();
  const turn = overhead ? 0 : Math.atan2(eye.y, eye.x) - Math.atan2(1, 0.42);
  const fromBelow = camera.position.z < floorHeight;
  return { rotation: new Euler(0, fromBelow ? Math.PI : 0, turn), fromBelow };
}

function tissueGeometry(mesh: TissueMesh): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(mesh.position, 3));
  geometry.setAttribute('normal', new BufferAttribute(mesh.normal, 3));
  geometry.setAttribute('rest', new BufferAttribute(mesh.rest, 3));
  geometry.setAttribute('inside', new BufferAttribute(mesh.inside, 1));
  geometry.setIndex(new BufferAttribute(mesh.index, 1));
  return geometry;
}

function addBody(scene: Scene, geometry: BufferGeometry, material: MeshStandardMaterial): Mesh {
  const body = new Mesh(geometry, material);
  body.castShadow = body.receiveShadow = true;
  scene.add(body);
  return body;
}

/** A teal drape that runs out into the dark, so that no horizon cuts through the picture. */
function createFloor(sky: SkyShadow, bounds: Sphere, height: number): Mesh {
  const material = new MeshStandardMaterial({ color: floorColour, roughness: 0.9 });
  material.defines = { ...material.defines, SKY_GRAIN: '' };
  const uniforms = { floorCentre: { value: bounds.center }, floorReach: { value: bounds.radius }, floorEnd: { value: background } };
  shadeBySky(material, sky, (shader) => {
    Object.assign(shader.uniforms, uniforms);
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', '#include <common>\nuniform vec3 floorCentre, floorEnd;\nuniform float floorReach;')
      .replace('#include <opaque_fragment>', /* glsl */ `
float away = distance(skyPlace.xy, floorCentre.xy) / floorReach;
outgoingLight = mix(outgoingLight, floorEnd, smoothstep(0.8, 6.0, away));
#include <opaque_fragment>`);
  });
  const floor = new Mesh(new CircleGeometry(40 * bounds.radius, 96), material);
  floor.position.set(bounds.center.x, bounds.center.y, height);
  floor.receiveShadow = true;
  return floor;
}

function addLamp(scene: Scene, bounds: Sphere, rotation: Euler): (pass: number) => void {
  const lamp = new DirectionalLight(0xfff1e2, 2.6);
  const reach = 1.7 * bounds.radius;
  lamp.castShadow = true;
  lamp.shadow.mapSize.set(1024, 1024);
  Object.assign(lamp.shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: 0.1 * reach, far: 8 * reach });
  lamp.shadow.normalBias = 0.03 * bounds.radius;
  lamp.shadow.bias = -0.0015;
  lamp.shadow.radius = 2.5;
  lamp.target.position.copy(bounds.center);
  scene.add(lamp, lamp.target);
  return (pass) => {
    const turn = 2 * Math.PI * radicalInverse(pass, 2), away = 0.16 * Math.sqrt(radicalInverse(pass, 3));
    lamp.position.set(0.8 + away * Math.cos(turn), 0.8 + away * Math.sin(turn), 1.1).applyEuler(rotation).multiplyScalar(2.6 * bounds.radius).add(bounds.center);
  };
}
