// SPDX-License-Identifier: Apache-2.0
// The interface as this page uses it. A call is data: the same data is sent, and shown as a curl line.

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
  get word() {
    return this.type.slice(this.type.lastIndexOf(':') + 1);
  }
}

export interface Session {
  id: string; name: string; crs: string; unit: string; version: number; vertices: number; triangles: number;
  bounds: [number, number, number, number, number, number]; polygons: number; memory_bytes: number;
  notes?: string[]; repairs?: {code: string; count: number}[];
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

async function problemOf(response: Response): Promise<Problem> {
  const said = await response.json().catch(() => ({}));
  return new Problem(response.status, said.type ?? 'about:blank', said.title ?? response.statusText,
    said.detail ?? `The server answered ${response.status}.`, said.errors ?? [], response.headers.get('ETag'));
}

/** Sends it; an answer that is an error comes as a Problem. */
export async function send(call: Call): Promise<Response> {
  let response: Response;
  try {
    response = await fetch(urlOf(call), {method: call.method, headers: call.headers, body: call.body});
  } catch {
    throw new Problem(0, 'about:blank', 'The server does not answer',
      'The request did not get through: see whether the server still runs, then try again.', [], null);
  }
  if (!response.ok) throw Object.assign(await problemOf(response), {call});
  return response;
}

export async function json<T>(call: Call): Promise<T> {
  return (await send(call)).json();
}

/** The members of a list that comes by pages. */
export async function pages<T>(path: string, member: string, headers?: Record<string, string>): Promise<T[]> {
  const all: T[] = [];
  for (let next: string | null = base + path; next;) {
    const response: Response = await fetch(next, {headers});
    if (!response.ok) throw await problemOf(response);
    all.push(...(await response.json())[member]);
    const link: RegExpExecArray | null = /<([^>]+)>;\s*rel="next"/.exec(response.headers.get('Link') ?? '');
    next = link ? base + link[1] : null;
  }
  return all;
}

/** Sends a file with progress from 0 to 1, which fetch does not tell. */
export function upload(call: Call, told: (part: number) => void, signal: AbortSignal): Promise<{status: number; location: string | null; body: any}> {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open(call.method, urlOf(call));
    for (const [name, value] of Object.entries(call.headers ?? {})) request.setRequestHeader(name, value);
    request.upload.onprogress = (event) => told(event.lengthComputable ? event.loaded / event.total : 0);
    request.onerror = () => reject(new Problem(0, 'about:blank', 'The upload broke off',
      'The connection ended before the file was through. A server that refuses a large file does this: see its limits.', [], null));
    request.onabort = () => reject(new Problem(499, '', 'Stopped', `${call.file ?? 'The file'} was not sent.`, [], null));
    signal.addEventListener('abort', () => { request.abort(); });
    request.onload = () => {
      let said: any = {};
      try { said = JSON.parse(request.responseText); } catch { /* told by the status */ }
      if (request.status >= 400) {
        reject(new Problem(request.status, said.type ?? '', said.title ?? 'The file was refused', said.detail ?? '', said.errors ?? [], null));
      } else {
        resolve({status: request.status, location: request.getResponseHeader('Location'), body: said});
      }
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
  for (const [name, value] of Object.entries(call.headers ?? {})) words.push('-H', quote(`${name}: ${value}`));
  if (typeof body === 'string') words.push('-d', quote(call.file || body.length > LONGEST ? `@${call.file ?? 'shape.geojson'}` : body));
  else if (body) words.push(call.method === 'PUT' ? '-T' : '--data-binary', quote((call.method === 'PUT' ? '' : '@') + (call.file ?? 'terrain.tif')));
  if (call.headers?.Accept === DELTA) words.push('-o', 'edit.delta');
  else if (call.out) words.push('-o', quote(call.out));
  return words.join(' ');
}
