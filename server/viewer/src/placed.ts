// SPDX-License-Identifier: Apache-2.0
// Lines of GeoJSON in another system, on the ground: the server brings them over.
import {GEOJSON, json, type Profile} from './api';
import type {App} from './app';
import {linesOf} from './regions_view';

/** So many are shown; the dry run tells of all. */
const MOST_LINES = 30;

/** The system that GeoJSON names itself, as it was used before RFC 7946 and in JSON-FG; else what was chosen. */
export function systemOf(value: any, chosen: string): string {
  const named = value?.crs?.properties?.name ?? value?.coordRefSys ?? value?.tinsmith?.crs;
  return typeof named === 'string' ? named : chosen;
}

/** Whether two names are of one code, such as EPSG:32616 and urn:ogc:def:crs:EPSG::32616. */
export function isSameSystem(a: string, b: string): boolean {
  const code = (name: string) => name.toUpperCase().replace(/^.*DEF[:/]CRS[:/]/, '').replace(/[:/]+(0[:/]+)?/g, ':');
  return code(a) === code(b);
}

/** Positions in the terrain's system, with the ground's elevation; what is off the terrain is left out. */
export async function placedLines(app: App, value: any, crs: string): Promise<number[][][]> {
  const answers = await Promise.all(linesOf(value).slice(0, MOST_LINES).map((line) => json<Profile>({
    method: 'POST', path: app.path('/profile'), query: {crs}, headers: {'Content-Type': GEOJSON},
    body: JSON.stringify({type: 'LineString', coordinates: line}),
  }).catch(() => null)));
  return answers.flatMap((answer) => (answer?.stretches ?? []).map(({points}) => points.map(({position, elevation}) => [...position, elevation])));
}
