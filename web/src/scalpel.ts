// SPDX-License-Identifier: Apache-2.0
import { BufferAttribute, BufferGeometry, CapsuleGeometry, Matrix4, Quaternion, Vector3 } from 'three';

export interface Scalpel {
  blade: BufferGeometry;
  handle: BufferGeometry;
}

/**
 * A scalpel whose cutting edge runs exactly from heel to tip, as the engine sweeps it; the handle lies beyond the heel.
 * The engine's blade has no spine; here it points up, or, for an upright blade, so that the eye sees its flat side.
 */
export function createScalpel(heel: Vector3, tip: Vector3, eye: Vector3): Scalpel {
  const length = heel.distanceTo(tip);
  const place = placeScalpel(heel, tip, eye);
  return { blade: bladeShape(length).applyMatrix4(place), handle: handleShape(length).applyMatrix4(place) };
}

/** Where a scalpel of the shapes below, which lie along x from the heel at 0, stands for these ends of its edge. */
export function placeScalpel(heel: Vector3, tip: Vector3, eye: Vector3): Matrix4 {
  const along = tip.clone().sub(heel);
  along.normalize();
  const spine = new Vector3(0, 0, 1).addScaledVector(along, -along.z);
  if (spine.length() < 0.35) spine.copy(eye).sub(heel).cross(along);
  spine.normalize();
  return new Matrix4().makeBasis(along, spine, along.clone().cross(spine)).setPosition(heel);
}

/** Width of the blade at a part s of its length: full at the heel, curved down to the tip. */
function bladeWidth(s: number, length: number): number {
  return 0.085 * length * Math.sqrt(1 - Math.max(0, (s - 0.45) / 0.55) ** 2.4);
}

/** Rows of cross-sections: the edge, two grind lines, two corners of the spine; flat facets as ground steel has them. */
export function bladeShape(length: number): BufferGeometry {
  const rows = 40;
  const half = 0.0045 * length;
  const corners: number[] = [];
  const section = (i: number) => {
    const s = i / rows, w = bladeWidth(s, length), x = s * length, t = half * Math.min(1, w / (0.03 * length));
    return [[x, 0, 0], [x, 0.4 * w, t], [x, w, 0.8 * t], [x, w, -0.8 * t], [x, 0.4 * w, -t]];
  };
  for (let i = 0; i < rows; ++i) {
    const a = section(i), b = section(i + 1);
    for (let k = 0; k < 5; ++k) {
      const m = (k + 1) % 5;
      corners.push(...a[k], ...a[m], ...b[m], ...a[k], ...b[m], ...b[k]);
    }
  }
  const shape = new BufferGeometry();
  shape.setAttribute('position', new BufferAttribute(Float32Array.from(corners), 3));
  shape.computeVertexNormals();
  return shape;
}

export function handleShape(length: number): BufferGeometry {
  const long = 1.05 * length, wide = 0.034 * length;
  const shape = new CapsuleGeometry(wide, long - 2 * wide, 12, 32);
  shape.applyMatrix4(new Matrix4().makeRotationFromQuaternion(new Quaternion().setFromAxisAngle(new Vector3(0, 0, 1), Math.PI / 2)));
  shape.scale(1, 1, 0.5);
  shape.translate(-long / 2 + 0.5 * wide, wide * 1.15, 0);
  return shape;
}
