// SPDX-License-Identifier: Apache-2.0
// Edits inside a polygon, and what they move.
import {type Call, type EditReport, json, send, type Volume} from './api';
import type {App, Cost} from './app';

/** The form: text as it was typed. */
export interface Wish {
  operation: 'set' | 'offset' | 'smooth' | 'remove' | 'keep';
  shape: 'elevation' | 'plane' | 'slope';
  elevation: string; by: string; passes: string;
  plane: string; slope: string; azimuth: string; point: string;
  border: 'old' | 'new' | 'taper';
  width: string;
}

export class RegionEdit {
  wish: Wish = {operation: 'set', shape: 'elevation', elevation: '', by: '1', passes: '2', plane: '', slope: '0.02',
    azimuth: '0', point: '', border: 'old', width: '5'};
  promised: EditReport | null = null;
  measured: {report: EditReport; cost: Cost} | null = null;
  volume: {question: string; answer: Volume} | null = null;

  constructor(private readonly app: App) {
    app.on(['selection'], () => { this.forget(); });
  }

  forget() {
    this.promised = this.measured = this.volume = null;
    this.app.tell('edit');
  }

  private body() {
    const w = this.wish;
    const numbers = (text: string) => text.split(/[\s,]+/).filter(Boolean).map(Number);
    const body: Record<string, unknown> = {operation: w.operation, polygon: this.app.selected};
    if (w.operation === 'set') {
      if (w.shape === 'elevation') body.elevation = Number(w.elevation);
      else if (w.shape === 'plane') body.plane = w.plane.split('\n').map(numbers).filter((p) => p.length > 0);
      else Object.assign(body, {slope: Number(w.slope), azimuth: Number(w.azimuth), point: numbers(w.point)});
    }
    if (w.operation === 'offset') body.by = Number(w.by);
    if (w.operation === 'smooth') {
      body.passes = Number(w.passes);
      if (w.border === 'new') body.border = 'new';
    }
    if (w.operation === 'set' || w.operation === 'offset') {
      if (w.border === 'old') body.rim = Number(w.width);
      else if (w.border === 'new') body.border = 'new';
      else body.taper = Number(w.width);
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
    this.promised = await json<EditReport>(call);
    this.measured = null;
    this.app.say('Dry run done: nothing was changed.');
    this.app.tell('edit');
  }

  async apply() {
    const {promised, app} = this;
    const done = await app.edit(this.call(false));
    this.measured = {report: await json<EditReport>({method: 'GET', path: done.history!}), cost: done.cost};
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
    this.volume = {question, answer: await (await send(call)).json()};
    this.app.tell('edit');
  }
}
