// SPDX-License-Identifier: Apache-2.0
// What the page knows, and who wants to hear when it changes.
import {type Call, curlLine, DELTA, type Feature, type Fault, type History, json, pages, Problem, type Region, send,
  type Session, sessionPath} from './api';
import {type AngleChange, watchAngles} from './angles';
import {type Delta, readDelta} from './delta';
import {placeOf} from './fault_place';
import {GroundIndex} from './ground_index';
import {Mesh} from './mesh';

export type Topic = 'sessions' | 'session' | 'mesh' | 'regions' | 'history' | 'draft' | 'options' | 'report' | 'edit' |
  'profile' | 'problem' | 'calls' | 'selection' | 'hover' | 'compare' | 'look' | 'progress' | 'tab';

export interface Mark { x: number; y: number; text: string }
export interface Told { title: string; detail: string; errors: Fault[]; conflict: boolean; retry: (() => void) | null }
/** What an edit took, from the click to the pixels; `answer`: until the server's answer was there. */
export interface Cost { bytes: number; ms: number; answer: number }
export interface Edited { version: number; cost: Cost; angles: AngleChange | null; history: string | null }

export class App {
  sessions: Session[] = [];
  session: Session | null = null;
  mesh = new Mesh();
  ground = new GroundIndex(this.mesh);
  regions: Region[] = [];
  features: Feature[] = [];
  history: History | null = null;
  selected: string | null = null;
  problem: Told | null = null;
  calls: Call[] = [];
  busy = 0;
  tab = 'draw';
  /** Patches the buffers and draws; set by the view. */
  show: (delta: Delta, isNew: boolean) => Promise<void> = async () => {};
  /** For the live region. */
  say: (text: string) => void = () => {};
  private etag = '';
  private readonly listeners = new Map<Topic, (() => void)[]>();

  on(topics: Topic[], call: () => void) {
    for (const topic of topics) this.listeners.set(topic, [...(this.listeners.get(topic) ?? []), call]);
  }
  tell(...topics: Topic[]) {
    const all = new Set(topics.flatMap((topic) => this.listeners.get(topic) ?? []));
    for (const call of all) call();
  }

  /** Shows the curl line of a call. */
  note(call: Call) {
    this.calls = [call, ...this.calls.filter((old) => curlLine(old) !== curlLine(call))].slice(0, 30);
    this.tell('calls');
  }

  path(rest = '') {
    return sessionPath(this.session?.id ?? '', rest);
  }

  openTab(tab: string) {
    this.tab = tab;
    this.tell('tab');
  }

  /** Runs what nobody asked for: where it fails, nothing is told. */
  async quietly(what: () => Promise<void>) {
    ++this.busy;
    try {
      await what();
    } catch {
      // What it would have shown stays out of date, and says so.
    } finally {
      --this.busy;
      this.tell('progress');
    }
  }

  /** Runs what a button asks for; what goes wrong is told on the page. */
  async attempt<T>(what: () => Promise<T>, retry: (() => void) | null = null): Promise<T | undefined> {
    ++this.busy;
    this.problem = null;
    this.tell('problem', 'progress');
    try {
      return await what();
    } catch (error) {
      await this.refuse(error, retry);
      return undefined;
    } finally {
      --this.busy;
      this.tell('progress');
    }
  }

  private async refuse(error: unknown, retry: (() => void) | null) {
    if (!(error instanceof Problem)) {
      this.problem = {title: 'Something went wrong on this page', detail: String(error), errors: [], conflict: false, retry: null};
      console.warn(error);
    } else if (error.status === 412) {
      await this.catchUp().catch(() => {});
      this.problem = {
        title: 'Someone else changed this terrain',
        detail: `Your request was made for an older version and nothing of it was done. The changes have been fetched: you see version ${this.mesh.version} now.`,
        errors: [], conflict: true, retry};
    } else {
      const errors = error.errors.map((fault) => ({...fault, coordinate: placeOf(fault, error.call, this.session?.crs ?? '')}));
      this.problem = {title: error.title, detail: error.message, errors, conflict: false, retry: null};
    }
    this.say(`${this.problem.title}. ${this.problem.detail}`);
    this.tell('problem');
  }

  async listSessions() {
    this.sessions = await pages<Session>('/v1/sessions', 'sessions');
    this.tell('sessions');
  }

  async open(id: string) {
    const call: Call = {method: 'GET', path: sessionPath(id, '/mesh'), query: {since: '0'}, headers: {Accept: DELTA}};
    const session = await json<Session>({method: 'GET', path: sessionPath(id)});
    const response = await send(call);
    const delta = readDelta(await response.arrayBuffer());
    this.note(call);
    this.session = session;
    this.etag = tagOf(response);
    this.mesh = new Mesh();
    this.mesh.apply(delta);
    this.ground = new GroundIndex(this.mesh);
    this.selected = null;
    this.regions = [];
    this.features = [];
    location.replace(`#${encodeURIComponent(id)}`);
    await this.show(delta, true);
    await this.refresh();
    this.say(`Terrain ${session.name || id}: ${session.triangles} triangles.`);
  }

  /** The session gone or never there. */
  close() {
    this.session = null;
    this.history = null;
    this.regions = [];
    this.features = [];
    this.tell('session', 'regions', 'history');
  }

  /** Everything beside the mesh: figures, polygons, regions, history. */
  async refresh() {
    if (!this.session) return;
    const path = this.path();
    const [session, features, regions, history] = await Promise.all([
      json<Session>({method: 'GET', path}), pages<Feature>(`${path}/polygons`, 'features'),
      pages<Region>(`${path}/regions`, 'regions'), wholeHistory(path)]);
    if (session.id !== this.session.id) return;
    for (const region of regions) region.triangles.sort((a, b) => a - b);
    [this.session, this.features, this.regions, this.history] = [session, features, regions, history];
    if (!regions.some((region) => region.polygon === this.selected)) this.selected = null;
    const listed = this.sessions.findIndex((one) => one.id === session.id);
    if (listed >= 0) this.sessions[listed] = session;
    this.tell('session', 'sessions', 'regions', 'history', 'selection');
  }

  /** The polygons around a triangle, the smallest first. */
  around(triangle: number): Region[] {
    return this.regions.filter((region) => holds(region.triangles, triangle)).sort((a, b) => a.plan_area - b.plan_area);
  }

  /** Fetches what others have changed. */
  async catchUp() {
    const call: Call = {method: 'GET', path: this.path('/mesh'), query: {since: String(this.mesh.version)}, headers: {Accept: DELTA}};
    const response = await send(call);
    const delta = readDelta(await response.arrayBuffer());
    if (delta.to === this.mesh.version && !delta.whole) return;
    this.note(call);
    await this.take(delta, response);
    await this.refresh();
  }

  private async take(delta: Delta, response: Response): Promise<AngleChange | null> {
    const angles = watchAngles(this.mesh, delta);
    if (!this.mesh.apply(delta)) throw new Error(`A delta from version ${delta.from} came for version ${this.mesh.version}.`);
    this.etag = tagOf(response);
    this.ground.update(delta.triangleRuns, delta.whole);
    await this.show(delta, false);
    return angles?.() ?? null;
  }

  /** An edit of the version that is on the screen. Its answer is what changed. */
  async edit(call: Call): Promise<Edited> {
    const begin = performance.now();
    const full = {...call, headers: {...call.headers, Accept: DELTA, 'If-Match': this.etag}};
    this.note(full);
    const response = await send(full);
    const delta = readDelta(await response.arrayBuffer());
    const answer = performance.now() - begin;
    const angles = await this.take(delta, response);
    const cost = {bytes: delta.bytes, ms: performance.now() - begin, answer};
    await this.refresh();
    const link = /<([^>]+)>;\s*rel="describedby"/.exec(response.headers.get('Link') ?? '');
    return {version: delta.to, cost, angles, history: link ? link[1] : `${this.path('/history/')}${delta.to}`};
  }
}

/** Whether a list in ascending order has it. */
function holds(list: number[], value: number): boolean {
  let low = 0, high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle] < value) low = middle + 1; else high = middle;
  }
  return list[low] === value;
}

/** Of the session, without what the representation adds. */
function tagOf(response: Response) {
  const tag = response.headers.get('ETag') ?? '';
  return tag.replace(/^"([0-9a-f]+-\d+).*"$/, '"$1"');
}

async function wholeHistory(path: string): Promise<History> {
  const first = await json<History>({method: 'GET', path: `${path}/history`, query: {limit: '1'}});
  return {...first, changes: await pages<History['changes'][0]>(`${path}/history`, 'changes')};
}
