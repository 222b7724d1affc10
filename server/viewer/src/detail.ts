// SPDX-License-Identifier: Apache-2.0
import type {Matrix4} from 'three';

/**
 * Fewer triangles that look the same from one place, for machines that draw with the processor alone.
 * Vertices that fall into one cell of the screen become the first of them (Rossignac and Borrel, 1993,
 * on the screen instead of in space); triangles that collapse by that, and those beyond the view, are
 * left out. Nothing moves by more than a cell, and neighbours stay neighbours: no gap opens.
 */
export class Detail {
  /** Which vertex is drawn instead of each. */
  private stands = new Uint32Array(0);
  /** Where a vertex lies beyond the view: left, right, below, above, behind. */
  private codes = new Uint8Array(0);
  private cells = new Int32Array(0);
  /** For each vertex what its triangles add up to: 0 where they close around it. */
  private around = new Int32Array(0);

  /** Finds the border, which keeps its vertices: a jagged one is seen at once. To be called after each edit. */
  look(corners: Uint32Array, triangles: number, vertices: number) {
    if (this.around.length < vertices) this.around = new Int32Array(Math.ceil(vertices * 1.2));
    const around = this.around.fill(0);
    // The edges across from a vertex form a ring, along which numbers of vertices add up to nothing;
    // at the border they form a path.
    for (let i = 0; i < 3 * triangles; i += 3) {
      const a = corners[i], b = corners[i + 1], c = corners[i + 2];
      around[a] += c - b;
      around[b] += a - c;
      around[c] += b - a;
    }
  }

  /** `toClip` leads from `positions` to the clip space of a view of width x height; `cell` is in its pixels, `margin` a share of it. */
  measure(positions: Float32Array, count: number, toClip: Matrix4, width: number, height: number, cell: number, margin: number) {
    if (this.stands.length < count) {
      this.stands = new Uint32Array(Math.ceil(count * 1.2));
      this.codes = new Uint8Array(Math.ceil(count * 1.2));
    }
    const {stands, codes, around} = this;
    const m = toClip.elements;
    const columns = Math.ceil((width * margin) / cell), rows = Math.ceil((height * margin) / cell);
    if (this.cells.length < columns * rows) this.cells = new Int32Array(columns * rows);
    const cells = this.cells.fill(-1, 0, columns * rows);
    const across = columns / (2 * margin), upwards = rows / (2 * margin);
    for (let v = 0, i = 0; v < count; ++v, i += 3) {
      const px = positions[i], py = positions[i + 1], pz = positions[i + 2];
      const x = m[0] * px + m[4] * py + m[8] * pz + m[12], y = m[1] * px + m[5] * py + m[9] * pz + m[13];
      const z = m[2] * px + m[6] * py + m[10] * pz + m[14], w = m[3] * px + m[7] * py + m[11] * pz + m[15];
      const edge = w * margin;
      const code = (x < -edge ? 1 : 0) | (x > edge ? 2 : 0) | (y < -edge ? 4 : 0) | (y > edge ? 8 : 0) | (z < -w ? 16 : 0);
      codes[v] = code;
      stands[v] = v;
      if (code !== 0 || around[v] !== 0) continue;
      const column = Math.min(columns - 1, Math.floor((x / w + margin) * across)), row = Math.min(rows - 1, Math.floor((y / w + margin) * upwards));
      const at = row * columns + column;
      if (cells[at] < 0) cells[at] = v; else stands[v] = cells[at];
    }
  }

  /** Writes what is left of the triangles into `out`, which has room for all; how many numbers it wrote. */
  write(corners: Uint32Array, triangles: number, out: Uint32Array): number {
    const {stands, codes} = this;
    let used = 0;
    for (let i = 0; i < 3 * triangles; i += 3) {
      const u = corners[i], v = corners[i + 1], w = corners[i + 2];
      if ((codes[u] & codes[v] & codes[w]) !== 0) continue;
      const a = stands[u], b = stands[v], c = stands[w];
      if (a === b || b === c || c === a) continue;
      out[used++] = a; out[used++] = b; out[used++] = c;
    }
    return used;
  }
}
