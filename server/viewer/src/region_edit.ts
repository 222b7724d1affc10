// SPDX-License-Identifier: Apache-2.0
// Edits inside a polygon, and what they move.
import {type Call, type EditReport, json, type Volume} from './api';
import type {App, Cost} from './app';

/** The form: text as it was typed. */
export interface Wish {
  operation: 'set' | 'offset' | 'smooth' | 'remove' | 'keep';
  shape: 'elevation' | 'plane' | 'slope';
  elevation: string; by: string; passes: string;
  plane: string; slope: string; azimuth: string; point: string;
  border: 'old' | 'new' | 'taper';
  width: string;
  /** Of `smooth`. */
  edge: 'old' | 'new';
}

/** What is no number becomes null, which the server refuses by name; an empty field is no zero. */
const numberOf = (text: string) => (text.trim() === '' ? NaN : Number(text));

export class RegionEdit {
  wish: Wish = {operation: 'set', shape: 'elevation', elevation: '', by: '1', passes: '2', plane: '', slope: '0.02',
    azimuth: '0', point: '', border: 'old', width: '5', edge: 'old'};
  promised: EditReport | null = null;
  measured: {report: EditReport; cost: Cost} | null = null;
  volume: {question: string; answer: Volume} | null = null;

  constructor(private readonly app: App) {
    app.on(['selection'], () => { this.forget(); });
  }

  forget() {
    this.volume = null;
    this.change();
  }
  /** What was promised was promised for another wish. */
  change() {
    ++this.turn;
    this.promised = this.measured = null;
    this.app.tell('edit');
  }
  private turn = 0;

  private body() {
    const w = this.wish;
    const numbers = (text: string) => text.split(/[\s,]+/).filter(Boolean).map(Number);
    const body: Record<string, unknown> = {operation: w.operation, polygon: this.app.selected};
    if (w.operation === 'set') {
      if (w.shape === 'elevation') body.elevation = numberOf(w.elevation);
      else if (w.shape === 'plane') body.plane = w.plane.split('\n').map(numbers).filter((p) => p.length > 0);
      else Object.assign(body, {slope: numberOf(w.slope), azimuth: numberOf(w.azimuth), point: numbers(w.point)});
    }
    if (w.operation === 'offset') body.by = numberOf(w.by);
    if (w.operation === 'smooth') {
      body.passes = numberOf(w.passes);
      if (w.edge === 'new') body.border = 'new';
    }
    if (w.operation === 'set' || w.operation === 'offset') {
      if (w.border === 'old') body.rim = numberOf(w.width);
      else if (w.border === 'new') body.border = 'new';
      else body.taper = numberOf(w.width);
    }
    return body;
  }

  private call(dryRun: boolean): Call {
    return {
      method: 'POST', path: this.app.path('/edits'), ...(dryRun && {query: {dry_run: 'true'}}),
      headers: {'Content-Type': 'application/json'}, body: JSON.stringify(this.body()),
    };
  }

  async dryRun() {
    const call = this.call(true);
    this.app.note(call);
    const turn = ++this.turn;
    const promised = await json<EditReport>(call);
    if (turn !== this.turn) return;
    this.promised = promised;
    this.measured = null;
    this.app.say('Dry run done: nothing was changed.');
    this.app.tell('edit');
  }

  async apply() {
    const {promised, app} = this;
    const done = await app.edit(this.call(false));
    this.measured = {report: await app.reportOf<EditReport>(done), cost: done.cost};
    this.promised = promised;
    app.say(`Edited in ${Math.round(done.cost.ms)} milliseconds.`);
    app.tell('edit');
  }

  async takeOut() {
    const id = this.app.selected;
    await this.app.edit({method: 'DELETE', path: this.app.path(`/polygons/${id}`), query: {cascade: 'true'}});
    this.app.say(`Polygon ${id} is taken out.`);
  }

  async askVolume(against: Record<string, unknown>, question: string) {
    const call: Call = {
      method: 'POST', path: this.app.path('/volume'), headers: {'Content-Type': 'application/json'},
      body: JSON.stringify({polygon: this.app.selected, against}),
    };
    this.app.note(call);
    this.volume = {question, answer: await json<Volume>(call)};
    this.app.tell('edit');
  }
}
