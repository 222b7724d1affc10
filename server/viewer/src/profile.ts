// SPDX-License-Identifier: Apache-2.0
// The section along a drawn line, now and as it was.
import {type Call, GEOJSON, json, type Profile as Answer} from './api';
import type {App} from './app';
import type {Compare} from './compare';
import type {Position} from './draft';

export class Profile {
  line: Position[] = [];
  now: Answer | null = null;
  /** [distance, elevation] of stretches. */
  before: {version: number; stretches: [number, number][][]} | null = null;

  constructor(private readonly app: App, private readonly compare: Compare) {
    app.on(['mesh'], () => { if (this.line.length > 1) void app.attempt(() => this.ask(this.line)); });
    app.on(['compare'], () => { if (this.line.length > 1) void app.attempt(() => this.askBefore()); });
  }

  clear() {
    [this.line, this.now, this.before] = [[], null, null];
    this.app.tell('profile');
  }

  async ask(line: Position[]) {
    this.line = line;
    const call: Call = {
      method: 'POST', path: this.app.path('/profile'), headers: {'Content-Type': GEOJSON},
      body: JSON.stringify({type: 'LineString', coordinates: line}),
    };
    this.app.note(call);
    this.now = await json<Answer>(call);
    this.app.tell('profile');
    await this.askBefore();
  }

  /** The same along the mesh of the version that is compared with, which this page holds. */
  private async askBefore() {
    const version = this.compare.version;
    this.before = null;
    if (version !== null && this.now && version !== this.now.version) {
      const ground = await this.compare.ground();
      if (ground) this.before = {version, stretches: alongGround(ground, this.line)};
    }
    this.app.tell('profile');
  }
}

const PARTS = 400;

function alongGround(ground: {at(x: number, y: number): {z: number} | null}, line: Position[]): [number, number][][] {
  const stretches: [number, number][][] = [[]];
  const length = line.slice(1).reduce((all, p, i) => all + Math.hypot(p[0] - line[i][0], p[1] - line[i][1]), 0);
  let travelled = 0;
  for (let i = 1; i < line.length; ++i) {
    const [a, b] = [line[i - 1], line[i]];
    const part = Math.hypot(b[0] - a[0], b[1] - a[1]);
    const steps = Math.max(2, Math.ceil((PARTS * part) / Math.max(length, 1e-9)));
    for (let k = 0; k <= steps; ++k) {
      const found = ground.at(a[0] + ((b[0] - a[0]) * k) / steps, a[1] + ((b[1] - a[1]) * k) / steps);
      if (found) stretches[stretches.length - 1].push([travelled + (part * k) / steps, found.z]);
      else if (stretches[stretches.length - 1].length) stretches.push([]);
    }
    travelled += part;
  }
  return stretches.filter((stretch) => stretch.length > 1);
}
