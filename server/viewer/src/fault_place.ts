// SPDX-License-Identifier: Apache-2.0
// Where faults are on the terrain.
import {json, type Problem} from './api';
import type {App} from './app';
import {isSameSystem, systemOf} from './placed';

type Place = [number, number] | undefined;
interface Brought { points: {x: number; y: number}[] }

/** More are not marked on the terrain. */
const MOST = 100;

/** What the mesh refuses is told in its own system; all else as it was sent. */
const OF_THE_MESH = ['edit-refused', 'budget-exceeded'];

/** The system of the request that was refused, where that is another than the terrain's; else ''. */
function systemOfCall({call}: Problem, terrain: string): string {
  let body: unknown = null;
  try {
    body = typeof call?.body === 'string' ? JSON.parse(call.body) : null;
  } catch {
    // Then it is the fault that it is no JSON.
  }
  const system = systemOf(body, call?.query?.crs ?? '');
  return system && !isSameSystem(system, terrain) ? system : '';
}

/** The server brings them over. Those that cannot be are named by index: they have no place here. */
async function broughtOver(app: App, points: Place[], crs: string): Promise<Place[]> {
  const asked = points.flatMap((point, i) => (point && i < MOST ? [i] : []));
  const ask = async (indices: number[]): Promise<Place[]> => {
    const out: Place[] = points.map(() => undefined);
    if (indices.length === 0) return out;
    const answer = await json<Brought>({
      method: 'POST', path: app.path('/elevation'), query: {crs}, headers: {'Content-Type': 'application/json'},
      body: JSON.stringify({points: indices.map((i) => points[i])}),
    });
    answer.points.forEach(({x, y}, k) => { out[indices[k]] = [x, y]; });
    return out;
  };
  try {
    return await ask(asked);
  } catch (error) {
    const bad = new Set(((error as Problem).errors ?? []).map(({pointer}) => Number(/^\/points\/(\d+)/.exec(pointer ?? '')?.[1] ?? -1)));
    return ask(asked.filter((_, k) => !bad.has(k))).catch(() => points.map(() => undefined));
  }
}

/** One for each fault: its place in the terrain's system, if it has one there. */
export async function placesOf(app: App, problem: Problem): Promise<Place[]> {
  const sent = problem.errors.map(({coordinate}): Place => (coordinate ? [coordinate[0], coordinate[1]] : undefined));
  const crs = OF_THE_MESH.includes(problem.word) ? '' : systemOfCall(problem, app.session?.crs ?? '');
  return crs && app.session ? broughtOver(app, sent, crs) : sent;
}
