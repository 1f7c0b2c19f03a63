// SPDX-License-Identifier: Apache-2.0
import { Matrix4, PerspectiveCamera, Vector3 } from 'three';
import type { View } from './request.ts';

/** Where the eye sits, seen from the body. Front is -y: anterior of the built-in liver; z is up. */
const eyeDirection: Record<View, [number, number, number]> = {
  front: [0, -1, 0.12],
  back: [0, 1, 0.12],
  left: [1, 0, 0.12],
  right: [-1, 0, 0.12],
  above: [0, -0.02, 1],
  below: [0, -0.02, -1],
  three_quarter: [0.42, -1, 0.5],
};

const fieldOfView = 28;

export function placeCamera(eye: number[], target: number[], fov: number | undefined, aspect: number): PerspectiveCamera {
  const camera = new PerspectiveCamera(fov ?? fieldOfView, aspect);
  camera.up.set(0, 0, 1);
  camera.position.fromArray(eye);
  camera.lookAt(new Vector3().fromArray(target));
  camera.updateMatrixWorld();
  setDepthRange(camera, camera.position.distanceTo(new Vector3().fromArray(target)));
  return camera;
}

/** Bodies may be millimetres or metres across. */
function setDepthRange(camera: PerspectiveCamera, distance: number): void {
  camera.near = 0.02 * distance;
  camera.far = 100 * distance;
  camera.updateProjectionMatrix();
}

/** The nearest camera in the direction of the view that has all points in the picture, with air around them. */
export function frameCamera(points: Float32Array, view: View, aspect: number): PerspectiveCamera {
  const direction = new Vector3(...eyeDirection[view]).normalize();
  const camera = placeCamera(direction.toArray(), [0, 0, 0], undefined, aspect);
  const slopeY = Math.tan((camera.fov * Math.PI) / 360) * 0.8;
  fitCamera(camera, points, slopeY * aspect, slopeY);
  setDepthRange(camera, camera.position.distanceTo(new Vector3().fromArray(points)));
  return camera;
}

/** Moves a camera, turned as it is, to the nearest place from which all points lie within these slopes of its axis. */
export function fitCamera(camera: PerspectiveCamera, points: Float32Array, slopeX: number, slopeY: number): void {
  const toView = new Matrix4().extractRotation(camera.matrixWorld).invert();
  // The body fits between two slanted planes per axis; each pair meets in the eye.
  const reach = { left: -Infinity, right: -Infinity, up: -Infinity, down: -Infinity };
  const p = new Vector3();
  for (let i = 0; i < points.length; i += 3) {
    p.fromArray(points, i).applyMatrix4(toView);
    reach.right = Math.max(reach.right, p.x + slopeX * p.z);
    reach.left = Math.max(reach.left, -p.x + slopeX * p.z);
    reach.up = Math.max(reach.up, p.y + slopeY * p.z);
    reach.down = Math.max(reach.down, -p.y + slopeY * p.z);
  }
  const distance = Math.max((reach.right + reach.left) / (2 * slopeX), (reach.up + reach.down) / (2 * slopeY));
  const inView = new Vector3((reach.right - reach.left) / 2, (reach.up - reach.down) / 2, distance);
  camera.position.copy(inView.applyMatrix4(toView.invert()));
  camera.updateMatrixWorld();
}
