// SPDX-License-Identifier: Apache-2.0
// What is about to be cut into the mesh: drawn, typed, or taken from GeoJSON.
import {type Call, GEOJSON, json, type Report} from './api';
import type {AngleChange} from './angles';
import type {App, Cost, Edited} from './app';
import {isSameSystem, placedLines, systemOf} from './placed';
import {millimetre} from './ui';

export type Kind = 'Polygon' | 'LineString' | 'Profile';
export type Position = [number, number];

export const DEFAULTS: Record<string, string> = {
  elevation: 'drape', on_crossing: 'new', improve: 'strict', max_deviation: '0.1', snap: '0.001', outside: 'skip',
  winding: 'evenodd', lock: 'false', crs: '',
};
/** What the server takes when a parameter is not there. */
const OF_SERVER: Record<string, string> = {...DEFAULTS, snap: '0', max_deviation: ''};

export class Draft {
  kind: Kind = 'Polygon';
  drawing = false;
  points: Position[] = [];
  /** GeoJSON from a file, or pasted and then without a name. */
  imported: {name: string; text: string; value: any} | null = null;
  /** Its lines on the ground, where it is in another system than the terrain. */
  placed: number[][][] | null = null;
  options = {...DEFAULTS};
  promised: Report | null = null;
  measured: {report: Report; cost: Cost; angles: AngleChange | null} | null = null;
  /** The promise is not of this shape, on this version, with these options. */
  stale = true;
  private turn = 0;
  private integrating = false;
  private terrain = '';

  constructor(private readonly app: App) {
    app.on(['session'], () => {
      const id = app.session?.id ?? '';
      if (id !== this.terrain) { this.terrain = id; this.cancel(); }
      this.useUnit();
    });
    // Somebody has changed the terrain: what was promised is asked for again.
    app.on(['mesh'], () => {
      this.stale = true;
      if (this.promised && !this.measured && !this.integrating && this.isComplete && this.kind !== 'Profile') void app.quietly(() => this.dryRun());
    });
  }

  /** What this page begins with: the server's values, but for a snap of a millimetre. */
  get defaults(): Record<string, string> {
    return {...DEFAULTS, snap: millimetre(this.app.session?.unit ?? 'metre')};
  }
  private shownSnap = DEFAULTS.snap;
  private useUnit() {
    const {snap} = this.defaults;
    if (snap === this.shownSnap) return;
    if (this.options.snap === this.shownSnap) this.options.snap = snap;
    this.shownSnap = snap;
    this.app.tell('options');
  }

  /** For those who show it. */
  onChange(call: () => void) {
    this.app.on(['draft'], call);
    call();
  }
  changed() {
    this.app.tell('draft');
  }

  get isComplete() {
    return this.imported !== null || this.points.length >= (this.kind === 'Polygon' ? 3 : 2);
  }

  begin(kind: Kind) {
    this.kind = kind;
    this.drawing = true;
    this.points = [];
    this.imported = this.placed = null;
    this.forget();
    this.app.say(`Drawing a ${kind === 'Polygon' ? 'polygon' : kind === 'Profile' ? 'profile line' : 'line'}: click to add corners, Enter to finish, Escape to cancel.`);
    this.app.tell('draft');
  }

  add(x: number, y: number) {
    const round = (v: number) => Math.round(v * 1000) / 1000;
    this.points.push([round(x), round(y)]);
    this.forget();
    this.app.tell('draft');
  }
  takeBack() {
    this.points.pop();
    this.forget();
    this.app.tell('draft');
  }
  /** A double click has set its corner twice. */
  finish() {
    const last = this.points.length - 1;
    if (last > 0 && this.points[last][0] === this.points[last - 1][0] && this.points[last][1] === this.points[last - 1][1]) this.points.pop();
    this.drawing = false;
    this.app.tell('draft');
    return this.isComplete;
  }
  cancel() {
    this.drawing = false;
    this.points = [];
    this.imported = this.placed = null;
    this.forget();
    this.app.tell('draft');
  }
  take(name: string, text: string) {
    const value = JSON.parse(text);
    this.cancel();
    this.placed = null;
    this.imported = {name, text: JSON.stringify(value), value};
    this.kind = 'Polygon';
    this.app.tell('draft');
  }
  forget() {
    ++this.turn;
    this.promised = null;
    this.measured = null;
    this.stale = true;
    this.app.tell('report');
  }

  get geometry(): any {
    if (this.kind === 'Polygon') return {type: 'Polygon', coordinates: [[...this.points, this.points[0]]]};
    return {type: 'LineString', coordinates: this.points};
  }

  private call(dryRun: boolean): Call {
    const query: Record<string, string> = {};
    for (const [name, value] of Object.entries(this.options)) {
      if (name === 'max_deviation' && this.options.improve !== 'bounded') continue;
      if (name === 'on_crossing' && this.options.elevation !== 'own') continue;
      // What is drawn here is in the terrain's own system.
      if (name === 'crs' && !this.imported) continue;
      if (value !== '' && value !== OF_SERVER[name]) query[name] = value;
    }
    if (dryRun) Object.assign(query, {dry_run: 'true', angles: 'true'});
    return {
      method: 'POST', path: this.app.path('/polygons'), query, headers: {'Content-Type': GEOJSON},
      body: this.imported ? this.imported.text : JSON.stringify(this.geometry), file: this.imported?.name || undefined,
    };
  }

  /** Asks what would come of it; changes nothing. */
  async dryRun() {
    const call = this.call(true);
    const turn = ++this.turn;
    this.app.note(call);
    const promised = await json<Report>(call);
    if (turn !== this.turn) return;
    const crs = this.imported ? systemOf(this.imported.value, this.options.crs) : '';
    this.placed = crs && !isSameSystem(crs, this.app.session?.crs ?? '') ? await placedLines(this.app, this.imported!.value, crs) : null;
    if (turn !== this.turn) return;
    this.promised = promised;
    this.measured = null;
    this.stale = false;
    this.app.say(`Dry run: ${this.promised.totals.vertices_added} vertices and ${this.promised.totals.triangles_added} triangles would be added.`);
    this.app.tell('draft', 'report');
  }

  /** Never without a report before it. */
  async integrate() {
    if (this.stale) await this.dryRun();
    this.integrating = true;
    let done: Edited;
    try {
      done = await this.app.edit(this.call(false));
    } finally {
      this.integrating = false;
    }
    const report = await this.app.reportOf<Report>(done);
    this.measured = {report, cost: done.cost, angles: done.angles};
    this.stale = true;
    this.points = [];
    this.imported = this.placed = null;
    this.app.selected = report.polygons[0]?.id ?? null;
    this.app.say(`Integrated: ${report.totals.vertices_added} vertices and ${report.totals.triangles_added} triangles added, in ${Math.round(done.cost.ms)} milliseconds.`);
    this.app.tell('draft', 'report', 'selection');
    return report;
  }
}
