// SPDX-License-Identifier: Apache-2.0
import type {Mesh} from './mesh';

/** Cells along the longer side. */
const CELLS = 180;

/**
 * Triangles over the mesh's own vertices, fewer of them: vertices of a cell of a grid become the
 * first of them (Rossignac and Borrel, 1993), and what collapses is left out. For views that move.
 */
export function coarseIndex(mesh: Mesh): Uint32Array {
  const {local, corners, vertexCount, triangleCount} = mesh;
  let x0 = Infinity, y0 = Infinity, x1 = -Infinity, y1 = -Infinity;
  for (let i = 0; i < 3 * vertexCount; i += 3) {
    x0 = Math.min(x0, local[i]); x1 = Math.max(x1, local[i]);
    y0 = Math.min(y0, local[i + 1]); y1 = Math.max(y1, local[i + 1]);
  }
  const cell = Math.max(x1 - x0, y1 - y0, 1e-9) / CELLS;
  const columns = Math.floor((x1 - x0) / cell) + 1, rows = Math.floor((y1 - y0) / cell) + 1;
  const first = new Int32Array(columns * rows).fill(-1);
  const stands = new Uint32Array(vertexCount);
  for (let v = 0; v < vertexCount; ++v) {
    const at = Math.floor((local[3 * v + 1] - y0) / cell) * columns + Math.floor((local[3 * v] - x0) / cell);
    if (first[at] < 0) first[at] = v;
    stands[v] = first[at];
  }
  const out = new Uint32Array(3 * triangleCount);
  let used = 0;
  for (let i = 0; i < 3 * triangleCount; i += 3) {
    const a = stands[corners[i]], b = stands[corners[i + 1]], c = stands[corners[i + 2]];
    if (a === b || b === c || c === a) continue;
    out[used++] = a; out[used++] = b; out[used++] = c;
  }
  return out.slice(0, used);
}
