// SPDX-License-Identifier: Apache-2.0
import type {Report} from './api';
import type {Delta} from './delta';
import type {Mesh} from './mesh';

/** Degrees of a bar: the smallest angle of a triangle is 60 at most. */
export const BAR_DEGREES = 5;
const BARS = 60 / BAR_DEGREES;

/** Smallest angles of triangles: how many lie between i and i + 1 bars, and the least of all. */
export interface Angles { bars: number[]; count: number; least: number }

/** Of the triangles that an edit has changed, in space, in degrees: as they were, and as they are. */
export interface AngleChange { before: Angles; after: Angles }

const none = (): Angles => ({bars: new Array<number>(BARS).fill(0), count: 0, least: Infinity});

/** As a report has them that was asked for `angles`; null where it was not. */
export function anglesOf(report: Report): AngleChange | null {
  const counts = report.smallest_angles;
  if (!counts || counts.step_deg !== BAR_DEGREES) return null;
  const shapes = report.polygons.flatMap(({smallest_angle_deg: angle}) => (angle?.after ? [angle] : []));
  const of = (bars: number[], when: 'before' | 'after'): Angles => ({bars, count: bars.reduce((sum, n) => sum + n, 0), least: Math.min(...shapes.map((angle) => angle[when]))});
  return {before: of(counts.before, 'before'), after: of(counts.after, 'after')};
}

/** In space, in degrees. */
function smallestAngle({positions: p, corners: c}: Mesh, t: number): number {
  const at = [3 * c[3 * t], 3 * c[3 * t + 1], 3 * c[3 * t + 2]];
  const side = (i: number, j: number) => {
    const x = p[at[j]] - p[at[i]], y = p[at[j] + 1] - p[at[i] + 1], z = p[at[j] + 2] - p[at[i] + 2];
    return [x, y, z, x * x + y * y + z * z];
  };
  const [u, v, w] = [side(0, 1), side(1, 2), side(2, 0)].sort((a, b) => a[3] - b[3]);
  // Across from the shortest side. Twice the area over the product of the two others is its sine; of
  // the differences that of the short one with any other is the most exact.
  const [x, y, z] = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  const sine = Math.sqrt(x * x + y * y + z * z) / Math.sqrt(v[3] * w[3]);
  return (Math.asin(Math.min(1, sine)) * 180) / Math.PI;
}

function add(to: Angles, angle: number) {
  // What rounding leaves just below a step belongs to it, as for the server.
  ++to.bars[Math.min(BARS - 1, Math.floor(angle / BAR_DEGREES + 1e-9))];
  ++to.count;
  if (angle < to.least) to.least = angle;
}

/** The slots that the delta writes, and those of triangles around vertices that it moves; below `end`. */
function* touched(mesh: Mesh, delta: Delta, end: number): Generator<number> {
  const written = new Uint8Array(end);
  for (const {first, count} of delta.triangleRuns) written.fill(1, first, first + count);
  for (let t = 0; t < end; ++t) if (written[t]) yield t;
  if (!delta.vertexRuns.some(({first}) => first < delta.oldVertices)) return;
  const moved = new Uint8Array(Math.max(delta.oldVertices, delta.newVertices));
  for (const {first, count} of delta.vertexRuns) moved.fill(1, first, first + count);
  const {corners} = mesh;
  for (let t = 0; t < end; ++t)
    if (!written[t] && (moved[corners[3 * t]] || moved[corners[3 * t + 1]] || moved[corners[3 * t + 2]])) yield t;
}

/** To be asked before the delta is applied, and its answer after that; null where it names everything. */
export function watchAngles(mesh: Mesh, delta: Delta): (() => AngleChange) | null {
  if (delta.whole) return null;
  const before = none();
  for (const t of touched(mesh, delta, mesh.triangleCount)) add(before, smallestAngle(mesh, t));
  // Triangles that are gone stood in slots that nothing is written to.
  for (let t = delta.newTriangles; t < delta.oldTriangles; ++t) if (!delta.triangleRuns.some(({first, count}) => t >= first && t < first + count)) add(before, smallestAngle(mesh, t));
  return () => {
    const after = none();
    for (const t of touched(mesh, delta, mesh.triangleCount)) add(after, smallestAngle(mesh, t));
    return {before, after};
  };
}
