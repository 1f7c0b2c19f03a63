// SPDX-License-Identifier: Apache-2.0
import {
  DepthTexture, DoubleSide, LessEqualCompare, LinearFilter, Matrix4, MeshBasicMaterial, OrthographicCamera, Scene, ShaderChunk,
  UnsignedIntType, Vector2, Vector3, Vector4, WebGLRenderTarget,
  type BufferGeometry, type Material, type WebGLRenderer, Mesh,
} from 'three';
import { radicalInverse } from './spread.ts';

/** How many directions of the sky are looked from, and how finely. */
export interface SkyLayout {
  /** The depth pictures lie in a square of so many by so many. */
  side: number;
  /** Pixels of one. */
  size: number;
}
const stillLayout: SkyLayout = { side: 2, size: 768 };

/** Light that comes up from the floor, as a part of what comes down. */
const floorBounce = 0.5;

/**
 * How much of the surrounding light reaches a place. Each pass of a picture looks from a few directions of the sky, with
 * a hard shadow each; over all passes the mean is true ambient occlusion, in the folds of the organ and on the floor.
 */
export interface SkyShadow {
  uniforms: Record<string, { value: unknown }>;
  /** Of the shader, in GLSL. */
  declarations: string;
  /** Looks from the directions of a pass, or from the one of `only`. */
  look(renderer: WebGLRenderer, pass: number, passes: number, only?: number): void;
  /** Takes another place in view. */
  surround(centre: Vector3, radius: number): void;
  dispose(): void;
}

export function createSkyShadow(
  casters: BufferGeometry[], centre: Vector3, radius: number, fromBelow: boolean, { side, size }: SkyLayout = stillLayout,
): SkyShadow {
  const tiles = side * side;
  const place = { centre, radius };
  const target = new WebGLRenderTarget(side * size, side * size);
  target.depthTexture = new DepthTexture(side * size, side * size, UnsignedIntType);
  target.depthTexture.compareFunction = LessEqualCompare;
  target.depthTexture.minFilter = target.depthTexture.magFilter = LinearFilter;
  target.scissorTest = true;
  const depthOnly = new MeshBasicMaterial({ side: DoubleSide, colorWrite: false });
  const scene = new Scene();
  for (const geometry of casters) scene.add(new Mesh(geometry, depthOnly));
  const camera = new OrthographicCamera(-radius, radius, radius, -radius, 0, 2 * radius);
  const matrices = Array.from({ length: tiles }, () => new Matrix4());
  const directions = Array.from({ length: tiles }, () => new Vector4());
  const uniforms = {
    skyDepth: { value: target.depthTexture },
    skyMatrix: { value: matrices },
    skyDirection: { value: directions },
    skyRadius: { value: radius },
    skySeed: { value: new Vector2() },
  };
  return {
    uniforms,
    declarations: declare(side),
    surround(aroundCentre, aroundRadius) {
      place.centre = aroundCentre;
      place.radius = aroundRadius;
      Object.assign(camera, { left: -aroundRadius, right: aroundRadius, top: aroundRadius, bottom: -aroundRadius, far: 2 * aroundRadius });
      camera.updateProjectionMatrix();
      uniforms.skyRadius.value = aroundRadius;
    },
    look(renderer, pass, passes, only) {
      uniforms.skySeed.value.set(radicalInverse(pass, 2), radicalInverse(pass, 3));
      const before = renderer.getRenderTarget();
      for (let tile = only ?? 0; tile < (only === undefined ? tiles : only + 1); ++tile) {
        const column = tile % side, line = Math.floor(tile / side);
        const direction = skyDirection(tile * passes + pass, tiles * passes);
        camera.up.set(Math.abs(direction.z) > 0.9 ? 1 : 0, 0, Math.abs(direction.z) > 0.9 ? 0 : 1);
        camera.position.copy(place.centre).addScaledVector(direction, place.radius);
        camera.lookAt(place.centre);
        camera.updateMatrixWorld();
        target.viewport.set(column * size, line * size, size, size);
        target.scissor.copy(target.viewport);
        renderer.setRenderTarget(target);
        renderer.render(scene, camera);
        const half = 0.5 / side;
        matrices[tile].set(half, 0, 0, half * (1 + 2 * column), 0, half, 0, half * (1 + 2 * line), 0, 0, 0.5, 0.5, 0, 0, 0, 1)
          .multiply(camera.projectionMatrix).multiply(camera.matrixWorldInverse);
        directions[tile].set(direction.x, direction.y, direction.z, direction.z > 0 !== fromBelow ? 1 : floorBounce);
      }
      renderer.setRenderTarget(before);
    },
    dispose() {
      target.dispose();
      depthOnly.dispose();
    },
  };
}

/** Evenly spread over the sphere (Fibonacci), so that few passes already give a smooth shade. */
function skyDirection(i: number, count: number): Vector3 {
  const z = 1 - (2 * i + 1) / count;
  const turn = i * Math.PI * (3 - Math.sqrt(5));
  return new Vector3(Math.cos(turn), Math.sin(turn), 0).multiplyScalar(Math.sqrt(1 - z * z)).setZ(z);
}

const declare = (side: number) => /* glsl */ `
varying vec3 skyPlace;
#ifdef NO_SKY
float openSky(vec3 normalInWorld) { return 0.72 + 0.28 * normalInWorld.z; }
#else
uniform highp sampler2DShadow skyDepth;
uniform mat4 skyMatrix[${side * side}];
uniform vec4 skyDirection[${side * side}];
uniform float skyRadius;
uniform vec2 skySeed;
float openSky(vec3 normalInWorld) {
  // Another offset in every pass turns the steps between hard shadows into an even blur. On the floor, where they
  // would show as rings, it also differs from pixel to pixel; on cut faces that grain would show.
#ifdef SKY_GRAIN
  vec2 cell = fract(52.9829189 * fract(gl_FragCoord.xy * 0.06711056 + gl_FragCoord.yx * vec2(0.00583715, 0.0123)));
#else
  const vec2 cell = vec2(0.0);
#endif
  float turn = 6.2831853 * fract(cell.x + skySeed.x);
  float spread = ${(0.028 / side).toFixed(4)} * sqrt(fract(cell.y + skySeed.y));
  float open = 0.0;
  for (int i = 0; i < ${side * side}; ++i) {
    float facing = dot(normalInWorld, skyDirection[i].xyz);
    if (facing <= 0.0) continue;
    vec4 place = skyMatrix[i] * vec4(skyPlace + (0.012 * skyRadius) * normalInWorld, 1.0);
    vec2 offset = spread * vec2(cos(turn), sin(turn));
    float slack = 0.003 + 0.02 * min(sqrt(1.0 - facing * facing) / facing, 2.5);
    open += facing * skyDirection[i].w * texture(skyDepth, vec3(place.xy + offset, place.z - slack));
    turn += 2.4;
  }
  return 4.0 * open / float(${side * side});
}
#endif
`;

/** The lamp's shadow filter draws the same grain in every pass; moved about, it averages out. */
const lampShadow = `#ifdef NO_SKY
const vec2 skySeed = vec2(0.0);
#endif
${ShaderChunk.shadowmap_pars_fragment.replaceAll('gl_FragCoord.xy', '(gl_FragCoord.xy + 131.0 * skySeed)')}`;

/** Changes a material's shader before it is compiled. */
export type ShaderChange = (shader: { vertexShader: string; fragmentShader: string; uniforms: Record<string, { value: unknown }> }) => void;

/** Lets a material see the sky shadow: `openSky` scales all light that comes from the environment. */
export function shadeBySky(material: Material, sky: SkyShadow, change?: ShaderChange): void {
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, sky.uniforms);
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', '#include <common>\nvarying vec3 skyPlace;')
      .replace('#include <project_vertex>', '#include <project_vertex>\nskyPlace = (modelMatrix * vec4(transformed, 1.0)).xyz;');
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', '#include <common>\n' + sky.declarations)
      .replace('#include <shadowmap_pars_fragment>', lampShadow)
      .replace('#include <lights_fragment_maps>', /* glsl */ `#include <lights_fragment_maps>
float open = openSky(inverseTransformDirection(normal, viewMatrix));
iblIrradiance *= open;
radiance *= open;
clearcoatRadiance *= open;`);
    change?.(shader);
  };
}

