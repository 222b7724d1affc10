// SPDX-License-Identifier: Apache-2.0
// What the page knows, and who wants to hear when it changes.
import {bytesOf, type Call, curlLine, DELTA, type Feature, type Fault, type History, json, pages, Problem, type Region, send,
  type Session, sessionPath} from './api';
import {type AngleChange, watchAngles} from './angles';
import {type Delta, readDelta} from './delta';
import {placesOf} from './fault_place';
import {GroundIndex} from './ground_index';
import {Mesh} from './mesh';
import {Once} from './once';

export type Topic = 'sessions' | 'session' | 'mesh' | 'regions' | 'history' | 'draft' | 'options' | 'report' | 'edit' |
  'profile' | 'problem' | 'calls' | 'selection' | 'hover' | 'compare' | 'look' | 'progress' | 'tab';

export interface Mark { x: number; y: number; text: string }
export interface Told { title: string; detail: string; errors: Fault[]; conflict: boolean; retry: (() => void) | null; retryText: string }
/** What an edit took, from the click to the pixels; `answer`: until the server's answer was there. */
export interface Cost { bytes: number; ms: number; answer: number }
export interface Edited { version: number; cost: Cost; angles: AngleChange | null; history: string | null }

/** What is wrong, in words for the reader. */
export class Said extends Error {}

/** What was asked for is about a terrain that is not on the screen any more, or is done already. */
class Superseded extends Error {}

/** The server did it; what the page shows of it is behind. */
class DoneButBehind extends Error {}

const notThere = (id: string) => `There is no terrain "${id}" any more: somebody has deleted it, or its time has run out.`;

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
  /** An edit is under way: another would be of a version that is about to go. */
  editing = false;
  tab = 'draw';
  /** Patches the buffers and draws; set by the view. */
  show: (delta: Delta, isNew: boolean) => Promise<void> = async () => {};
  /** Takes the terrain off the screen; set by the view. */
  clear: () => void = () => {};
  /** For the live region. */
  say: (text: string) => void = () => {};
  private etag = '';
  private opening = 0;
  private readonly once = new Once();
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

  /** Its last changes were made by another version of the server: it can be read and copied. */
  get isReadOnly() {
    return (this.session?.notes ?? []).some((note) => note.startsWith('This session is read-only'));
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

  /** Looks after the terrain and the list when the reader comes back. What is told stays told; that the
      terrain is gone is told. */
  async lookAgain() {
    await this.quietly(async () => {
      try {
        await this.catchUp();
      } catch (error) {
        if (error instanceof Problem && error.word === 'no-such-session') await this.refuse(error, null, () => {});
      }
      await this.listSessions();
    });
  }

  /** Runs what a button asks for; what goes wrong is told on the page. `retry` is for a conflict; what
      a server could not do just now can be tried again as it was. */
  async attempt<T>(what: () => Promise<T>, retry: (() => void) | null = null): Promise<T | undefined> {
    ++this.busy;
    this.problem = null;
    this.tell('problem', 'progress');
    try {
      return await what();
    } catch (error) {
      if (!(error instanceof Superseded)) await this.refuse(error, retry, () => { void this.attempt(what, retry); });
      return undefined;
    } finally {
      --this.busy;
      this.tell('progress');
    }
  }

  private async refuse(error: unknown, retry: (() => void) | null, again: () => void) {
    const told: Told = {title: '', detail: '', errors: [], conflict: false, retry: null, retryText: 'Try again'};
    if (error instanceof DoneButBehind) {
      Object.assign(told, {title: 'It is done, but not all of it could be fetched', detail: error.message,
        retry: () => { void this.attempt(() => this.refresh()); }, retryText: 'Fetch it'});
    } else if (error instanceof Said) {
      Object.assign(told, {title: 'That cannot be done', detail: error.message});
    } else if (!(error instanceof Problem)) {
      Object.assign(told, {title: 'Something went wrong on this page', detail: String(error)});
      console.warn(error);
    } else if (error.status === 412) {
      const isFetched = await this.catchUp().then(() => true, () => false);
      Object.assign(told, {
        title: 'Someone else changed this terrain', conflict: true,
        detail: `Your request was made for an older version and nothing of it was done. ${isFetched
          ? `The changes have been fetched: you see version ${this.mesh.version} now.` : 'The changes could not be fetched.'}`,
        ...(isFetched && retry && {retry, retryText: 'Do it on this version'})});
    } else if (error.word === 'no-such-session' && this.session && error.call?.path.startsWith(this.path())) {
      const {id} = this.session;
      this.close();
      await this.listSessions().catch(() => {});
      Object.assign(told, {title: 'This terrain is gone', detail: notThere(id)});
    } else {
      const wait = error.retryAfter ? ` Try again in ${error.retryAfter} s.` : '';
      Object.assign(told, {title: error.title, detail: error.message + wait, errors: error.errors.map((fault) => ({...fault, coordinate: undefined})),
        ...((error.isPassing || error.status === 401) && {retry: again})});
    }
    this.problem = told;
    this.say(`${told.title}. ${told.detail}`);
    this.tell('problem');
    if (error instanceof Problem && told.errors.length > 0) await this.place(told, error);
  }

  /** Marks faults on the terrain, once it is known where they are there. */
  private async place(told: Told, problem: Problem) {
    const places = await placesOf(this, problem);
    if (this.problem !== told || places.every((place) => !place)) return;
    told.errors = told.errors.map((fault, i) => ({...fault, coordinate: places[i]}));
    this.tell('problem');
  }

  async listSessions() {
    this.sessions = await pages<Session>('/v1/sessions', 'sessions');
    this.tell('sessions');
  }

  async open(id: string) {
    const turn = ++this.opening;
    const call: Call = {method: 'GET', path: sessionPath(id, '/mesh'), query: {since: '0'}, headers: {Accept: DELTA}};
    const session = await json<Session>({method: 'GET', path: sessionPath(id)});
    const response = await send(call);
    const delta = readDelta(await bytesOf(response));
    if (turn !== this.opening) throw new Superseded();
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
    ++this.opening;
    this.session = null;
    this.history = null;
    this.regions = [];
    this.features = [];
    this.selected = null;
    this.mesh = new Mesh();
    this.ground = new GroundIndex(this.mesh);
    location.replace('#');
    this.clear();
    this.tell('session', 'regions', 'history', 'selection', 'mesh');
  }

  /** Everything beside the mesh: figures, polygons, regions, history. */
  async refresh() {
    if (!this.session) return;
    const path = this.path();
    const [session, features, regions, history] = await Promise.all([
      json<Session>({method: 'GET', path}), pages<Feature>(`${path}/polygons`, 'features'),
      pages<Region>(`${path}/regions`, 'regions'), wholeHistory(path)]);
    if (session.id !== this.session?.id) return;
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
    const {mesh, session} = this;
    if (!session) return;
    const call: Call = {method: 'GET', path: this.path('/mesh'), query: {since: String(mesh.version)}, headers: {Accept: DELTA}};
    let response: Response;
    try {
      response = await send(call);
    } catch (error) {
      // So much has happened that the version on the screen is not kept any more.
      if (error instanceof Problem && error.status === 410) return this.open(session.id);
      throw error;
    }
    const delta = readDelta(await bytesOf(response));
    if (mesh !== this.mesh) throw new Superseded();
    // Deleted, and made anew under its name.
    if (birthOf(tagOf(response)) !== birthOf(this.etag)) return this.open(session.id);
    if (delta.to === mesh.version && !delta.whole) return;
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
    if (this.editing) throw new Superseded();
    this.editing = true;
    this.tell('progress');
    try {
      return await this.editAlone(call);
    } finally {
      this.editing = false;
      this.tell('progress');
    }
  }

  private async editAlone(call: Call): Promise<Edited> {
    const begin = performance.now();
    const {mesh} = this;
    const full = {...call, headers: {...call.headers, Accept: DELTA, 'If-Match': this.etag}};
    this.note(full);
    const response = await this.once.send(full);
    if (!response.headers.get('Content-Type')?.startsWith(DELTA)) {
      // Done before, and of its answer only the report is left.
      await this.catchUp();
      throw new Superseded();
    }
    const delta = readDelta(await bytesOf(response));
    this.once.isAnswered();
    const answer = performance.now() - begin;
    // Another terrain was opened meanwhile: this one has its edit.
    if (mesh !== this.mesh) throw new Superseded();
    const angles = await this.take(delta, response);
    const cost = {bytes: delta.bytes, ms: performance.now() - begin, answer};
    await this.fetchOf(delta.to, () => this.refresh());
    const link = /<([^>]+)>;\s*rel="describedby"/.exec(response.headers.get('Link') ?? '');
    return {version: delta.to, cost, angles, history: link ? link[1] : `${this.path('/history/')}${delta.to}`};
  }

  /** Fetches what goes with an edit that is made. Where that fails, nobody shall make it once more. */
  async fetchOf<T>(version: number, what: () => Promise<T>): Promise<T> {
    try {
      return await what();
    } catch (error) {
      throw new DoneButBehind(`The edit was made: this terrain has version ${version}. ${error instanceof Error ? error.message : error}`);
    }
  }

  /** The report of an edit that is made. */
  reportOf<T>({version, history}: Edited): Promise<T> {
    return this.fetchOf(version, () => json<T>({method: 'GET', path: history!}));
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

/** Sets a session apart from another that had its name before. */
const birthOf = (tag: string) => tag.slice(0, tag.lastIndexOf('-'));

/** Of the session, without what the representation adds. */
function tagOf(response: Response) {
  const tag = response.headers.get('ETag') ?? '';
  return tag.replace(/^"([0-9a-f]+-\d+).*"$/, '"$1"');
}

async function wholeHistory(path: string): Promise<History> {
  const first = await json<History>({method: 'GET', path: `${path}/history`, query: {limit: '1'}});
  return {...first, changes: await pages<History['changes'][0]>(`${path}/history`, 'changes')};
}
