// SPDX-License-Identifier: Apache-2.0
// application/vnd.tinsmith.delta, as api/README.md of the project describes it.

export interface Run { first: number; count: number }

export interface Delta {
  whole: boolean;
  from: number;
  to: number;
  oldVertices: number;
  oldTriangles: number;
  newVertices: number;
  newTriangles: number;
  vertexRuns: Run[];
  triangleRuns: Run[];
  /** x, y, z of the vertices named, in the order of the runs. */
  positions: Float64Array;
  /** The three corners of the triangles named, likewise. */
  corners: Uint32Array;
  bytes: number;
}

const HEAD = 48;
const MAGIC = 0x4c444e54; // "TNDL"
const sum = (runs: Run[]) => runs.reduce((all, run) => all + run.count, 0);

export function readDelta(buffer: ArrayBuffer): Delta {
  if (buffer.byteLength < HEAD) throw new Error('The delta ends within its head.');
  const view = new DataView(buffer);
  if (view.getUint32(0, true) !== MAGIC || view.getUint16(4, true) !== 1) throw new Error('This is no delta of format 1.');
  const word = (at: number) => view.getUint32(at, true);
  const [vertexRunCount, triangleRunCount] = [word(40), word(44)];
  const bodyAt = HEAD + 8 * (vertexRunCount + triangleRunCount);
  if (bodyAt > buffer.byteLength) throw new Error('The delta ends within its runs.');
  const runs = (at: number, count: number): Run[] =>
    Array.from({length: count}, (_, i) => ({first: word(at + 8 * i), count: word(at + 8 * i + 4)}));
  const vertexRuns = runs(HEAD, vertexRunCount);
  const triangleRuns = runs(HEAD + 8 * vertexRunCount, triangleRunCount);
  const [vertices, triangles] = [sum(vertexRuns), sum(triangleRuns)];
  if (bodyAt + 24 * vertices + 12 * triangles !== buffer.byteLength) throw new Error('The delta has another length than its runs say.');
  return {
    whole: (view.getUint16(6, true) & 1) === 1,
    from: Number(view.getBigUint64(8, true)),
    to: Number(view.getBigUint64(16, true)),
    oldVertices: word(24), oldTriangles: word(28), newVertices: word(32), newTriangles: word(36),
    vertexRuns, triangleRuns,
    positions: new Float64Array(buffer, bodyAt, 3 * vertices),
    corners: new Uint32Array(buffer, bodyAt + 24 * vertices, 3 * triangles),
    bytes: buffer.byteLength,
  };
}
