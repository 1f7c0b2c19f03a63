// SPDX-License-Identifier: Apache-2.0
import {
  ACESFilmicToneMapping, CircleGeometry, Color, DirectionalLight, MOUSE, Mesh, MeshStandardMaterial, PCFShadowMap, PerspectiveCamera, Ray, Raycaster, Scene,
  Sphere, Vector2, Vector3, WebGLRenderer, type BufferGeometry, type Plane,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { fitCamera } from '../camera.ts';
import { createEnvironment } from '../environment.ts';
import { createSkyShadow, shadeBySky, type SkyShadow } from '../sky_shadow.ts';
import { createLiveMaterial, type LiveMaterial } from './live_material.ts';

const background = new Color(0x22323b);
const drape = new Color(0x22535a);
const skyLayout = { side: 4, size: 320 };
/** From the body towards the lamp. */
const lampDirection = new Vector3(-0.55, -0.75, 1.25).normalize();
/** Pixels of the canvas that panels cover. */
const panelsWide = 480, panelsHigh = 170;
const eyeDirection = new Vector3(0.3, -1, 0.42).normalize();

/** Draws well, or fast: where a processor draws in place of a graphics card. */
export type Quality = 'high' | 'low';

/** The room: body, lights, drape, camera. */
export class Stage {
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(32, 1, 0.001, 100);
  readonly renderer: WebGLRenderer;
  readonly controls: OrbitControls;
  readonly tissue: LiveMaterial;
  readonly bounds = new Sphere(new Vector3(), 0.15);
  readonly body: Mesh;
  private readonly sky: SkyShadow;
  private readonly lamp = new DirectionalLight(0xfff1e2, 2.6);
  private readonly floor: Mesh<CircleGeometry, MeshStandardMaterial>;
  private readonly raycaster = new Raycaster();
  private tile = 0;
  private quality: Quality = 'high';
  private scale = 1;
  /** Pixels from the canvas's middle to that of the room that panels leave. */
  private readonly aside: [number, number];

  constructor(canvas: HTMLCanvasElement, geometry: BufferGeometry, aside: [number, number]) {
    this.aside = aside;
    this.renderer = createRenderer(canvas);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.mouseButtons = { LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.PAN, RIGHT: MOUSE.ROTATE };
    this.controls.enableDamping = false;
    this.controls.zoomToCursor = true;
    this.camera.up.set(0, 0, 1);
    this.scene.background = background;
    this.scene.environment = createEnvironment(this.renderer);
    this.sky = createSkyShadow([geometry], this.bounds.center, 1.6 * this.bounds.radius, false, skyLayout);
    this.tissue = createLiveMaterial(this.sky);
    this.body = new Mesh(geometry, this.tissue.material);
    this.body.castShadow = this.body.receiveShadow = true;
    this.body.frustumCulled = false;
    this.body.visible = false; // until there is one
    this.floor = createFloor(this.sky);
    this.lamp.castShadow = true;
    this.lamp.shadow.mapSize.set(1024, 1024);
    this.lamp.shadow.radius = 3;
    this.lamp.shadow.bias = -0.0015;
    this.scene.add(this.body, this.floor, this.lamp, this.lamp.target);
  }

  /** Without a graphics card, where good looks cost seconds. */
  get isDrawnByProcessor(): boolean {
    const context = this.renderer.getContext();
    const names = context.getExtension('WEBGL_debug_renderer_info');
    return names !== null && /swiftshader|llvmpipe|software/i.test(String(context.getParameter(names.UNMASKED_RENDERER_WEBGL)));
  }

  /** Takes another body in view. */
  surround(lo: Vector3, hi: Vector3): void {
    this.bounds.center.copy(lo).add(hi).multiplyScalar(0.5);
    this.bounds.radius = 0.5 * lo.distanceTo(hi);
    const { center, radius } = this.bounds;
    this.sky.surround(center, 1.6 * radius);
    this.tissue.setSize(2 * radius);
    this.lamp.position.copy(center).addScaledVector(lampDirection, 3 * radius);
    this.lamp.target.position.copy(center);
    Object.assign(this.lamp.shadow.camera, { left: -1.6 * radius, right: 1.6 * radius, top: 1.6 * radius, bottom: -1.6 * radius, near: 0.5 * radius, far: 8 * radius });
    this.lamp.shadow.camera.updateProjectionMatrix();
    this.lamp.shadow.normalBias = 0.02 * radius;
    this.floor.position.set(center.x, center.y, lo.z - 0.35 * radius);
    this.floor.scale.setScalar(30 * radius);
    this.camera.near = 0.02 * radius;
    this.camera.far = 60 * radius;
    this.camera.updateProjectionMatrix();
  }

  /** Looks at the whole body, in the room that the panels leave. */
  frame(points: Float32Array): void {
    const { clientWidth: width, clientHeight: height } = this.renderer.domElement;
    const slope = Math.tan((this.camera.fov * Math.PI) / 360);
    this.camera.position.copy(eyeDirection);
    this.camera.lookAt(0, 0, 0);
    this.camera.updateMatrixWorld();
    const free = Math.max(width - panelsWide, 0.5 * width) / height;
    fitCamera(this.camera, points, 0.9 * slope * free, slope * (1 - panelsHigh / height));
    const away = this.camera.position.distanceTo(this.bounds.center);
    this.controls.target.copy(this.camera.getWorldDirection(new Vector3())).multiplyScalar(away).add(this.camera.position);
    this.controls.update();
  }

  resize(width: number, height: number): void {
    this.renderer.setPixelRatio(this.scale * (this.quality === 'high' ? Math.min(window.devicePixelRatio, 2) : 1));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / Math.max(height, 1);
    this.camera.setViewOffset(width, height, this.aside[0], this.aside[1], width, height);
  }

  /** `scale` of the pixels, for slow machines. */
  setQuality(quality: Quality, scale: number): void {
    if (quality !== this.quality) {
      this.renderer.shadowMap.enabled = quality === 'high';
      this.tissue.setSky(quality === 'high');
      if (quality === 'high') delete this.floor.material.defines!.NO_SKY;
      else this.floor.material.defines!.NO_SKY = '';
      this.floor.material.needsUpdate = true;
    }
    this.quality = quality;
    this.scale = scale;
    const canvas = this.renderer.domElement;
    this.resize(canvas.clientWidth, canvas.clientHeight);
  }

  setClip(plane: Plane | undefined): void {
    this.tissue.setClip(plane);
  }

  /** One of the sky's pictures is looked at anew each time: it follows within a third of a second. */
  draw(): void {
    if (this.quality === 'high') {
      this.tile = (this.tile + 1) % (skyLayout.side * skyLayout.side);
      this.sky.look(this.renderer, 0, 1, this.tile);
    }
    this.renderer.render(this.scene, this.camera);
  }

  /** All of the sky's pictures, for a body that has not been seen. */
  lookAround(): void {
    if (this.quality === 'high') this.sky.look(this.renderer, 0, 1);
  }

  /** Through a place of the canvas, CSS pixels. */
  rayAt(x: number, y: number): Ray {
    const canvas = this.renderer.domElement;
    const at = new Vector2((2 * x) / canvas.clientWidth - 1, 1 - (2 * y) / canvas.clientHeight);
    this.raycaster.setFromCamera(at, this.camera);
    return this.raycaster.ray.clone();
  }

  /** CSS pixels of a point. */
  screenOf(point: Vector3): [number, number] {
    const canvas = this.renderer.domElement;
    const at = point.clone().project(this.camera);
    return [((at.x + 1) / 2) * canvas.clientWidth, ((1 - at.y) / 2) * canvas.clientHeight];
  }
}

function createRenderer(canvas: HTMLCanvasElement): WebGLRenderer {
  const context = canvas.getContext('webgl2', { antialias: true, preserveDrawingBuffer: true, powerPreference: 'high-performance' });
  if (!context) throw new Error('This browser gives no WebGL 2. Use one that does, or update its graphics driver.');
  const renderer = new WebGLRenderer({ canvas, context });
  renderer.toneMapping = ACESFilmicToneMapping;
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = PCFShadowMap;
  renderer.localClippingEnabled = true;
  return renderer;
}

/** A drape that runs out into the dark; its circle has radius 1 and is scaled to the body. */
function createFloor(sky: SkyShadow): Mesh<CircleGeometry, MeshStandardMaterial> {
  const material = new MeshStandardMaterial({ color: drape, roughness: 0.9 });
  material.defines = { ...material.defines, SKY_GRAIN: '' };
  shadeBySky(material, sky, (shader) => {
    shader.uniforms.floorEnd = { value: background };
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', '#include <common>\nvarying vec2 floorPlace;')
      .replace('#include <begin_vertex>', '#include <begin_vertex>\nfloorPlace = position.xy;');
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', '#include <common>\nvarying vec2 floorPlace;\nuniform vec3 floorEnd;')
      .replace('#include <opaque_fragment>', /* glsl */ `
outgoingLight = mix(outgoingLight, floorEnd, smoothstep(0.02, 0.2, length(floorPlace)));
#include <opaque_fragment>`);
  });
  const floor = new Mesh(new CircleGeometry(1, 96), material);
  floor.receiveShadow = true;
  return floor;
}
