// SPDX-License-Identifier: Apache-2.0
import type { Piece } from './protocol.ts';
import { mixAt, pick } from './pick.ts';
import type { Room, Tool } from './tool.ts';

/** Says what the tissue under the pointer is and does. */
export class ProbeTool implements Tool {
  private readonly room: Room;
  private readonly pieces: () => Piece[];

  constructor(room: Room, pieces: () => Piece[]) {
    this.room = room;
    this.pieces = pieces;
  }

  wants(): boolean {
    return false;
  }

  hover(x: number, y: number): void {
    const { body, stage } = this.room;
    const hit = pick(body, stage.rayAt(x, y));
    if (!hit) {
      this.rest();
      return;
    }
    const moved = hit.point.clone().sub(mixAt(body, hit.triangle, hit.weights, body.rest.values, 3)).length();
    const stress = hit.weights.reduce((sum, weight, k) => sum + weight * body.stress.values[body.index.values[3 * hit.triangle + k]], 0);
    const side = body.face.values[hit.triangle];
    const piece = this.pieces().find((one) => one.id === body.piece.values[hit.triangle]);
    const lines = [
      side === 0 ? 'Skin' : `Cut face of stroke ${Math.abs(side)}`,
      `Moved by ${(1000 * moved).toFixed(1)} mm`,
      `Von Mises stress ${(stress / 1000).toFixed(2)} kPa`,
    ];
    if (piece) lines.push(`Piece ${piece.id}: ${(1e6 * piece.volume).toFixed(1)} cm³, ${(1000 * piece.mass).toFixed(0)} g${piece.held ? ', held' : ', free'}`);
    this.room.readout(lines.join('\n'), x, y);
  }

  press(): void {}
  drag(): void {}
  release(): void {}

  rest(): void {
    this.room.readout(undefined, 0, 0);
  }
}
