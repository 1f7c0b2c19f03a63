// SPDX-License-Identifier: Apache-2.0
import { BackSide, Color, DoubleSide, Mesh, MeshBasicMaterial, PMREMGenerator, PlaneGeometry, CircleGeometry, Scene, SphereGeometry, Vector3, type BufferGeometry, type Texture, type WebGLRenderer } from 'three';

/** A dim theatre with a surgical lamp and two soft windows: what wet tissue mirrors. */
export function createEnvironment(renderer: WebGLRenderer): Texture {
  const scene = new Scene();
  scene.add(new Mesh(new SphereGeometry(20, 32, 16), new MeshBasicMaterial({ color: new Color(0.20, 0.23, 0.25), side: BackSide })));
  addLamp(scene, new PlaneGeometry(6, 4), new Vector3(2, 5, 10), new Color(12, 11.4, 10.6));
  addLamp(scene, new PlaneGeometry(3, 9), new Vector3(-13, 3, 4), new Color(3.2, 3.7, 4.3));
  addLamp(scene, new PlaneGeometry(3, 9), new Vector3(12, -6, 4), new Color(2.6, 2.9, 3.3));
  addLamp(scene, new PlaneGeometry(12, 3), new Vector3(-2, -12, 6), new Color(0.7, 0.74, 0.78));
  addLamp(scene, new CircleGeometry(14, 24), new Vector3(0, 0, -12), new Color(0.16, 0.22, 0.22));
  const generator = new PMREMGenerator(renderer);
  const texture = generator.fromScene(scene, 0.03).texture;
  generator.dispose();
  return texture;
}

function addLamp(scene: Scene, shape: BufferGeometry, place: Vector3, colour: Color): void {
  const lamp = new Mesh(shape, new MeshBasicMaterial({ color: colour, side: DoubleSide }));
  lamp.position.copy(place);
  lamp.lookAt(0, 0, 0);
  scene.add(lamp);
}
