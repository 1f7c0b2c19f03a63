// SPDX-License-Identifier: Apache-2.0
import type { Vector3 } from 'three';
import type { Body } from './body.ts';
import type { Connection } from './connection.ts';
import type { Stage } from './stage.ts';

/** What tools work with. */
export interface Room {
  stage: Stage;
  body: Body;
  connection: Connection;
  settings: ToolSettings;
  readout(text: string | undefined, x: number, y: number): void;
}

export interface ToolSettings {
  /** Of the tip below the skin, m. */
  depth: number;
  /** Of the blade about its way, radians. */
  lean: number;
  /** Along the view rather than the skin's normal. */
  alongView: boolean;
  /** Of a grasp, m. */
  radius: number;
  /** A grasp stays when it is let go. */
  pin: boolean;
}

/** Something in the hand. Places are CSS pixels of the canvas. */
export interface Tool {
  /** Whether a press here is the tool's; else it turns the view. */
  wants(x: number, y: number): boolean;
  hover(x: number, y: number): void;
  press(x: number, y: number): void;
  drag(x: number, y: number): void;
  release(x: number, y: number): void;
  /** Each frame, for what goes on by itself. */
  tick?(): void;
  /** Hides what it shows: the pointer has left, or another tool is taken. */
  rest(): void;
  /** A new scene, or an undo: the engine has forgotten. */
  forget?(): void;
}

export function arrayOf(point: Vector3): number[] {
  return [point.x, point.y, point.z];
}
