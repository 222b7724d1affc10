// SPDX-License-Identifier: Apache-2.0
// The interface as this page uses it. A call is data: the same data is sent, and shown as a curl line.
import {access} from './access';

export const DELTA = 'application/vnd.tinsmith.delta';
export const GEOJSON = 'application/geo+json';

export interface Call {
  method: string;
  path: string;
  query?: Record<string, string>;
  headers?: Record<string, string>;
  body?: string | Blob;
  /** What the body is called on the reader's disk; without a name it stands in the curl line. */
  file?: string;
  /** What the answer is called there, where it is no text to read. */
  out?: string;
}

export interface Fault {
  code: string;
  detail: string;
  pointer?: string;
  index?: number;
  parameter?: string;
  coordinate?: number[];
}

/** What application/problem+json says. */
export class Problem extends Error {
  constructor(readonly status: number, readonly type: string, readonly title: string, detail: string,
              readonly errors: Fault[], readonly etag: string | null) {
    super(detail);
  }
  /** What was asked. */
  call: Call | null = null;
  /** Seconds, where the server says so. */
  retryAfter: number | null = null;
  /** Whether the same may well be done a little later. */
  get isPassing() {
    return [0, 429, 503].includes(this.status) && this.word !== 'session-out-of-service';
  }
  get word() {
    return this.type.slice(this.type.lastIndexOf(':') + 1);
  }
}

export interface Session {
  id: string; name: string; crs: string; unit: string; version: number; vertices: number; triangles: number;
  bounds: [number, number, number, number, number, number]; polygons: number; memory_bytes: number;
  notes?: string[]; expires?: string; repairs?: {code: string; count: number}[];
}
export interface AngleReport { before: number; after: number; p1_before: number; p1_after: number }
export interface PolygonReport {
  id: string; segments: number; crossings: number; vertices_added: number; triangles_added: number;
  edges_swapped: number; outside: unknown[]; max_vertical_deviation: number; max_plan_deviation: number;
  max_elevation_change: number; smallest_angle_deg: AngleReport | null;
}
export interface Report {
  version: number; dry_run: boolean; polygons: PolygonReport[];
  totals: Record<string, number>; time_ms: Record<string, number>;
  /** Where it was asked for. */
  smallest_angles?: {step_deg: number; before: number[]; after: number[]};
}
export interface EditReport {
  version: number; dry_run: boolean; operation: string; polygon: string; vertices_moved: number;
  triangles_affected: number; vertices_added: number; triangles_added: number; vertices_removed: number;
  triangles_removed: number; cut?: number; fill?: number; area_affected: number; max_elevation_change: number;
  time_ms: Record<string, number>;
}
export interface Region {
  polygon: string; plan_area: number; surface_area: number; triangles: number[]; within: string[];
}
export interface Feature {
  id?: string | number; geometry: {type: string; coordinates: any} | null; properties: Record<string, unknown> | null;
  tinsmith: {id: string; plan_area?: number};
}
export interface Change {
  version: number; change: string; of?: number; polygons: string[]; vertices: number; triangles: number;
}
export interface History { version: number; oldest: number; undo: number | null; redo: number | null; changes: Change[] }
export interface ProfilePoint { distance: number; position: [number, number]; elevation: number; triangle: number; at: string }
export interface Profile { version: number; length: number; crossings: number; stretches: {points: ProfilePoint[]}[] }
export interface Volume { cut: number; fill: number; area: number; area_left_out: number }
export interface Job { id: string; state: string; progress: number; status: number | null }

/** The server's address, which may lie under a path of its own. */
export const base = new URL('.', document.baseURI).href.replace(/\/$/, '');

export function sessionPath(id: string, rest = '') {
  return `/v1/sessions/${encodeURIComponent(id)}${rest}`;
}

export function urlOf(call: Pick<Call, 'path' | 'query'>) {
  const query = new URLSearchParams(call.query ?? {}).toString();
  return base + call.path + (query && `?${query}`);
}

const UNREACHED = 'The request did not get through: see whether the server still runs, then try again.';
const lost = (detail: string) => new Problem(0, 'about:blank', 'The server does not answer', detail, [], null);

/** A proxy in between may answer with something else than a problem in JSON. */
function problemFrom(status: number, text: string, header: (name: string) => string | null): Problem {
  let said: any = {};
  try {
    said = JSON.parse(text) ?? {};
  } catch {
    // Told by the status.
  }
  const problem = new Problem(status, String(said.type ?? 'about:blank'), String(said.title ?? `The server answered ${status}`),
    String(said.detail ?? 'It gave no reason.'), Array.isArray(said.errors) ? said.errors : [], header('ETag'));
  const seconds = Number(header('Retry-After') || NaN);
  return Object.assign(problem, {retryAfter: Number.isFinite(seconds) ? seconds : null});
}

/** One request with the key, if there is one; where the server wants one, the reader is asked. */
async function fetched(url: string, init: RequestInit): Promise<Response> {
  for (;;) {
    const {key} = access;
    let response: Response;
    try {
      response = await fetch(url, {...init, headers: {...init.headers, ...access.headers()}});
    } catch {
      throw lost(UNREACHED);
    }
    if (response.ok) return response;
    if (response.status === 401 && await access.again(key)) continue;
    throw problemFrom(response.status, await response.text().catch(() => ''), (name) => response.headers.get(name));
  }
}

/** Sends it; an answer that is an error comes as a Problem. */
export async function send(call: Call): Promise<Response> {
  try {
    return await fetched(urlOf(call), {method: call.method, headers: call.headers, body: call.body});
  } catch (error) {
    throw Object.assign(error as Problem, {call});
  }
}

const BROKEN_OFF = 'The answer broke off on its way: try again.';

export async function json<T>(call: Call): Promise<T> {
  const response = await send(call);
  return response.json().catch(() => { throw lost(BROKEN_OFF); });
}

export async function bytesOf(response: Response): Promise<ArrayBuffer> {
  return response.arrayBuffer().catch(() => { throw lost(BROKEN_OFF); });
}

/** The members of a list that comes by pages. */
export async function pages<T>(path: string, member: string, headers?: Record<string, string>): Promise<T[]> {
  const all: T[] = [];
  for (let next: string | null = base + path; next;) {
    const response: Response = await fetched(next, {headers}).catch((error: Problem) => {
      throw Object.assign(error, {call: {method: 'GET', path, headers}});
    });
    const page: Record<string, T[]> = await response.json().catch(() => { throw lost(BROKEN_OFF); });
    for (const one of page[member]) all.push(one);
    const link: RegExpExecArray | null = /<([^>]+)>;\s*rel="next"/.exec(response.headers.get('Link') ?? '');
    next = link ? base + link[1] : null;
  }
  return all;
}

/** Sends a file with progress from 0 to 1, which fetch does not tell. */
export async function upload(call: Call, told: (part: number) => void, signal: AbortSignal): Promise<Uploaded> {
  for (;;) {
    const {key} = access;
    try {
      return await uploadOnce(call, told, signal);
    } catch (error) {
      if (!(error instanceof Problem && error.status === 401 && await access.again(key))) throw error;
    }
  }
}

interface Uploaded { status: number; location: string | null }

function uploadOnce(call: Call, told: (part: number) => void, signal: AbortSignal): Promise<Uploaded> {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open(call.method, urlOf(call));
    for (const [name, value] of Object.entries({...call.headers, ...access.headers()})) request.setRequestHeader(name, value);
    request.upload.onprogress = (event) => told(event.lengthComputable ? event.loaded / event.total : 0);
    request.onerror = () => reject(new Problem(0, 'about:blank', 'The upload broke off',
      'The connection ended before the file was through. A server that refuses a large file does this: see its limits.', [], null));
    request.onabort = () => reject(new Problem(499, '', 'Stopped', `${call.file ?? 'The file'} was not sent.`, [], null));
    signal.addEventListener('abort', () => { request.abort(); });
    request.onload = () => {
      if (request.status >= 400) reject(Object.assign(problemFrom(request.status, request.responseText, (name) => request.getResponseHeader(name)), {call}));
      else resolve({status: request.status, location: request.getResponseHeader('Location')});
    };
    request.send(call.body as Blob);
  });
}

const quote = (text: string) => (/^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replaceAll("'", `'\\''`)}'`);
const LONGEST = 100_000;

/** The line that does the same from a shell. */
export function curlLine(call: Call): string {
  const words = ['curl'];
  const {body} = call;
  if (call.method === 'DELETE' || (call.method === 'PUT' && typeof body === 'string')) words.push('-X', call.method);
  words.push(quote(urlOf(call)));
  if (body === undefined && call.method === 'POST') words.push('-d', "''");
  // Never the key itself: lines are copied, and shown to others.
  if (access.key) words.push('-H', '"Authorization: Bearer $TINSMITH_KEY"');
  for (const [name, value] of Object.entries(call.headers ?? {})) words.push('-H', quote(`${name}: ${value}`));
  if (typeof body === 'string') words.push('-d', quote(call.file || body.length > LONGEST ? `@${call.file ?? 'shape.geojson'}` : body));
  else if (body) words.push(call.method === 'PUT' ? '-T' : '--data-binary', quote((call.method === 'PUT' ? '' : '@') + (call.file ?? 'terrain.tif')));
  if (call.headers?.Accept === DELTA) words.push('-o', 'edit.delta');
  else if (call.out) words.push('-o', quote(call.out));
  return words.join(' ');
}
