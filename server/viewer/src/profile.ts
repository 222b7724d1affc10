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

  /** The version shown beside; 'last': the one before the newest, where there is one. */
  against: number | 'last' | 'none' = 'last';
  private turn = 0;

  constructor(private readonly app: App, private readonly compare: Compare) {
    app.on(['mesh'], () => {
      if (app.session?.id !== this.terrain) this.clear();
    });
    app.on(['history'], () => { if (this.now && this.now.version !== app.session?.version) void app.quietly(() => this.ask(this.line)); });
    app.on(['compare'], () => {
      if (compare.version === null) return;
      this.against = compare.version;
      if (this.now) void app.quietly(() => this.askBefore());
    });
  }
  private terrain = '';

  /** What can be shown beside. */
  get versions(): number[] {
    return (this.app.history?.changes ?? []).map((change) => change.version).filter((version) => version < (this.app.session?.version ?? 0));
  }
  get version(): number | null {
    const {versions, against} = this;
    if (against === 'none') return null;
    return against !== 'last' && versions.includes(against) ? against : versions[versions.length - 1] ?? null;
  }

  clear() {
    ++this.turn;
    [this.line, this.now, this.before, this.against] = [[], null, null, 'last'];
    this.app.tell('profile');
  }

  async ask(line: Position[]) {
    this.line = line;
    this.terrain = this.app.session?.id ?? '';
    const turn = ++this.turn;
    const call: Call = {
      method: 'POST', path: this.app.path('/profile'), headers: {'Content-Type': GEOJSON},
      body: JSON.stringify({type: 'LineString', coordinates: line}),
    };
    this.app.note(call);
    const now = await json<Answer>(call);
    if (turn !== this.turn) return;
    this.now = now;
    await this.askBefore();
  }

  /** The same along the mesh of an earlier version, of which the triangles around the line are fetched. */
  async askBefore() {
    const turn = ++this.turn;
    const {version, line} = this;
    this.before = null;
    this.app.tell('profile');
    if (version === null) return;
    const [xs, ys] = [line.map(([x]) => x), line.map(([, y]) => y)];
    const box = [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
    // A line along an axis has a box without a width.
    const room = Math.max(box[2] - box[0], box[3] - box[1]) * 1e-3;
    const ground = await this.compare.groundOf(version, box.map((v, k) => (k < 2 ? v - room : v + room)));
    if (turn !== this.turn) return;
    this.before = {version, stretches: alongGround(ground, line)};
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
