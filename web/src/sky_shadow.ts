// SPDX-License-Identifier: Apache-2.0
import {
  DepthTexture, DoubleSide, LessEqualCompare, LinearFilter, Matrix4, MeshBasicMaterial, OrthographicCamera, Scene, ShaderChunk,
  UnsignedIntType, Vector2, Vector3, Vector4, WebGLRenderTarget,
  type BufferGeometry, type Material, type WebGLRenderer, Mesh,
} from 'three';
import { radicalInverse } from './spread.ts';

/**
 * How much of the surrounding light reaches a place. Each pass of a picture looks from a few directions of the sky, with
 * a hard shadow each; over all passes the mean is true ambient occlusion, in the folds of the organ and on the floor.
 */
const tiles = 4;
const tileSize = 768;
/** Light that comes up from the floor, as a part of what comes down. */
const floorBounce = 0.5;

export interface SkyShadow {
  uniforms: Record<string, { value: unknown }>;
  look(renderer: WebGLRenderer, pass: number, passes: number): void;
  dispose(): void;
}

export function createSkyShadow(casters: BufferGeometry[], centre: Vector3, radius: number, fromBelow: boolean): SkyShadow {
  const target = new WebGLRenderTarget(2 * tileSize, 2 * tileSize);
  target.depthTexture = new DepthTexture(2 * tileSize, 2 * tileSize, UnsignedIntType);
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
    look(renderer, pass, passes) {
      uniforms.skySeed.value.set(radicalInverse(pass, 2), radicalInverse(pass, 3));
      const before = renderer.getRenderTarget();
      for (let tile = 0; tile < tiles; ++tile) {
        const direction = skyDirection(tile * passes + pass, tiles * passes);
        camera.up.set(Math.abs(direction.z) > 0.9 ? 1 : 0, 0, Math.abs(direction.z) > 0.9 ? 0 : 1);
        camera.position.copy(centre).addScaledVector(direction, radius);
        camera.lookAt(centre);
        camera.updateMatrixWorld();
        const corner = new Vector2(tile % 2, Math.floor(tile / 2)).multiplyScalar(tileSize);
        target.viewport.set(corner.x, corner.y, tileSize, tileSize);
        target.scissor.copy(target.viewport);
        renderer.setRenderTarget(target);
        renderer.render(scene, camera);
        matrices[tile].set(0.25, 0, 0, 0.25 + 0.5 * (tile % 2), 0, 0.25, 0, 0.25 + 0.5 * Math.floor(tile / 2), 0, 0, 0.5, 0.5, 0, 0, 0, 1)
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

const declarations = /* glsl */ `
varying vec3 skyPlace;
uniform highp sampler2DShadow skyDepth;
uniform mat4 skyMatrix[${tiles}];
uniform vec4 skyDirection[${tiles}];
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
  float spread = 0.014 * sqrt(fract(cell.y + skySeed.y));
  float open = 0.0;
  for (int i = 0; i < ${tiles}; ++i) {
    float facing = dot(normalInWorld, skyDirection[i].xyz);
    if (facing <= 0.0) continue;
    vec4 place = skyMatrix[i] * vec4(skyPlace + (0.012 * skyRadius) * normalInWorld, 1.0);
    vec2 offset = spread * vec2(cos(turn), sin(turn));
    float slack = 0.003 + 0.02 * min(sqrt(1.0 - facing * facing) / facing, 2.5);
    open += facing * skyDirection[i].w * texture(skyDepth, vec3(place.xy + offset, place.z - slack));
    turn += 2.4;
  }
  return 4.0 * open / float(${tiles});
}
`;

/** The lamp's shadow filter draws the same grain in every pass; moved about, it averages out. */
const lampShadow = ShaderChunk.shadowmap_pars_fragment.replaceAll('gl_FragCoord.xy', '(gl_FragCoord.xy + 131.0 * skySeed)');

/** Lets a material see the sky shadow: `openSky` scales all light that comes from the environment. */
export function shadeBySky(material: Material, sky: SkyShadow, change?: (shader: { vertexShader: string; fragmentShader: string; uniforms: Record<string, { value: unknown }> }) => void): void {
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, sky.uniforms);
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', '#include <common>\nvarying vec3 skyPlace;')
      .replace('#include <project_vertex>', '#include <project_vertex>\nskyPlace = (modelMatrix * vec4(transformed, 1.0)).xyz;');
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', '#include <common>\n' + declarations)
      .replace('#include <shadowmap_pars_fragment>', lampShadow)
      .replace('#include <lights_fragment_maps>', /* glsl */ `#include <lights_fragment_maps>
float open = openSky(inverseTransformDirection(normal, viewMatrix));
iblIrradiance *= open;
radiance *= open;
clearcoatRadiance *= open;`);
    change?.(shader);
  };
}

