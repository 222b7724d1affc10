// SPDX-License-Identifier: Apache-2.0
import type {Run} from './delta';
import type {Mesh} from './mesh';

export interface Hit { x: number; y: number; z: number; triangle: number }

/**
 * Finds triangles by plan position and along rays: a grid of cells, each with the triangles whose
 * boxes touch it. After an edit the triangles that changed are added again; what an old entry names
 * is always measured where it is now, so that entries that are out of date do no harm.
 */
export class GroundIndex {
  private x0 = 0;
  private y0 = 0;
  private cell = 1;
  private columns = 1;
  private rows = 1;
  private starts = new Uint32Array(2);
  private entries = new Uint32Array(0);
  private later = new Map<number, number[]>();
  private laterCount = 0;

  constructor(private readonly mesh: Mesh) {
    this.build();
  }

  /** Takes in what an edit has written. */
  update(runs: Run[], whole: boolean) {
    const added = runs.reduce((all, run) => all + run.count, 0);
    this.laterCount += added;
    if (whole || this.laterCount > this.mesh.triangleCount / 4 + 1000) return this.build();
    for (const {first, count} of runs) {
      for (let t = first; t < first + count; ++t) {
        this.eachCell(t, (cell) => {
          const list = this.later.get(cell);
          if (list) list.push(t); else this.later.set(cell, [t]);
        });
      }
    }
  }

  private build() {
    const {positions, vertexCount, triangleCount} = this.mesh;
    let x1 = -Infinity, y1 = -Infinity;
    this.x0 = this.y0 = Infinity;
    for (let i = 0; i < 3 * vertexCount; i += 3) {
      if (positions[i] < this.x0) this.x0 = positions[i];
      if (positions[i] > x1) x1 = positions[i];
      if (positions[i + 1] < this.y0) this.y0 = positions[i + 1];
      if (positions[i + 1] > y1) y1 = positions[i + 1];
    }
    if (vertexCount === 0) this.x0 = this.y0 = x1 = y1 = 0;
    const [width, height] = [Math.max(x1 - this.x0, 1e-9), Math.max(y1 - this.y0, 1e-9)];
    this.later.clear();
    this.laterCount = 0;
    // Needles across everything would fill every cell: then the cells are made larger.
    for (let wanted = Math.min(triangleCount / 4 + 16, 1 << 20); ; wanted /= 4) {
      this.cell = Math.max(Math.sqrt((width * height) / wanted), Math.max(width, height) / 4096);
      this.columns = Math.floor(width / this.cell) + 1;
      this.rows = Math.floor(height / this.cell) + 1;
      const starts = new Uint32Array(this.columns * this.rows + 1);
      for (let t = 0; t < triangleCount; ++t) this.eachCell(t, (cell) => { ++starts[cell + 1]; });
      let total = 0;
      for (let i = 1; i < starts.length; ++i) starts[i] = total += starts[i];
      if (total > 12 * triangleCount + 1000 && wanted > 16) continue;
      const next = starts.slice();
      this.entries = new Uint32Array(total);
      for (let t = 0; t < triangleCount; ++t) this.eachCell(t, (cell) => { this.entries[next[cell]++] = t; });
      this.starts = starts;
      return;
    }
  }

  private column(x: number) {
    return Math.min(this.columns - 1, Math.max(0, Math.floor((x - this.x0) / this.cell)));
  }
  private row(y: number) {
    return Math.min(this.rows - 1, Math.max(0, Math.floor((y - this.y0) / this.cell)));
  }

  private eachCell(t: number, visit: (cell: number) => void) {
    const {positions: p, corners: c} = this.mesh;
    const [a, b, d] = [3 * c[3 * t], 3 * c[3 * t + 1], 3 * c[3 * t + 2]];
    const left = this.column(Math.min(p[a], p[b], p[d])), right = this.column(Math.max(p[a], p[b], p[d]));
    const low = this.row(Math.min(p[a + 1], p[b + 1], p[d + 1])), high = this.row(Math.max(p[a + 1], p[b + 1], p[d + 1]));
    for (let row = low; row <= high; ++row)
      for (let column = left; column <= right; ++column) visit(row * this.columns + column);
  }

  private someIn(cell: number, test: (triangle: number) => void) {
    for (let i = this.starts[cell]; i < this.starts[cell + 1]; ++i)
      if (this.entries[i] < this.mesh.triangleCount) test(this.entries[i]);
    for (const t of this.later.get(cell) ?? []) if (t < this.mesh.triangleCount) test(t);
  }

  /** The ground at a plan position; null: off the terrain. */
  at(x: number, y: number): Hit | null {
    const margin = this.cell * 1e-9;
    if (x < this.x0 - margin || y < this.y0 - margin || x > this.x0 + this.columns * this.cell || y > this.y0 + this.rows * this.cell) return null;
    const {positions: p, corners: c} = this.mesh;
    let found: Hit | null = null;
    this.someIn(this.row(y) * this.columns + this.column(x), (t) => {
      if (found) return;
      const [a, b, d] = [3 * c[3 * t], 3 * c[3 * t + 1], 3 * c[3 * t + 2]];
      const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], vx = p[d] - p[a], vy = p[d + 1] - p[a + 1];
      const area = ux * vy - uy * vx;
      const v = ((x - p[a]) * vy - (y - p[a + 1]) * vx) / area, w = (ux * (y - p[a + 1]) - uy * (x - p[a])) / area;
      if (!(v >= -1e-9 && w >= -1e-9 && v + w <= 1 + 1e-9)) return;
      found = {x, y, z: p[a + 2] + v * (p[b + 2] - p[a + 2]) + w * (p[d + 2] - p[a + 2]), triangle: t};
    });
    return found;
  }

  /** The first triangle that a ray meets, in session coordinates. */
  hit(o: [number, number, number], d: [number, number, number]): Hit | null {
    const x1 = this.x0 + this.columns * this.cell, y1 = this.y0 + this.rows * this.cell;
    let enter = 0, leave = Infinity;
    for (const [from, step, low, high] of [[o[0], d[0], this.x0, x1], [o[1], d[1], this.y0, y1]]) {
      if (Math.abs(step) < 1e-12) { if (from < low || from > high) return null; continue; }
      const [s, e] = [(low - from) / step, (high - from) / step];
      enter = Math.max(enter, Math.min(s, e));
      leave = Math.min(leave, Math.max(s, e));
    }
    if (enter > leave) return null;
    let column = this.column(o[0] + d[0] * enter), row = this.row(o[1] + d[1] * enter);
    const stepX = d[0] > 0 ? 1 : -1, stepY = d[1] > 0 ? 1 : -1;
    const borderX = (i: number) => (Math.abs(d[0]) < 1e-12 ? Infinity : (this.x0 + (i + (stepX > 0 ? 1 : 0)) * this.cell - o[0]) / d[0]);
    const borderY = (i: number) => (Math.abs(d[1]) < 1e-12 ? Infinity : (this.y0 + (i + (stepY > 0 ? 1 : 0)) * this.cell - o[1]) / d[1]);
    let best = Infinity, triangle = -1;
    for (let steps = this.columns + this.rows + 2; steps > 0; --steps) {
      this.someIn(row * this.columns + column, (t) => {
        const along = this.meet(o, d, t);
        if (along < best) { best = along; triangle = t; }
      });
      const [nextX, nextY] = [borderX(column), borderY(row)];
      const out = Math.min(nextX, nextY);
      if (best <= out || out > leave) break;
      if (nextX < nextY) column += stepX; else row += stepY;
      if (column < 0 || row < 0 || column >= this.columns || row >= this.rows) break;
    }
    if (triangle < 0) return null;
    return {x: o[0] + best * d[0], y: o[1] + best * d[1], z: o[2] + best * d[2], triangle};
  }

  /** How far along the ray a triangle is met (Möller and Trumbore, 1997); infinity: not. */
  private meet(o: [number, number, number], d: [number, number, number], t: number): number {
    const {positions: p, corners: c} = this.mesh;
    const [a, b, e] = [3 * c[3 * t], 3 * c[3 * t + 1], 3 * c[3 * t + 2]];
    const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
    const vx = p[e] - p[a], vy = p[e + 1] - p[a + 1], vz = p[e + 2] - p[a + 2];
    const px = d[1] * vz - d[2] * vy, py = d[2] * vx - d[0] * vz, pz = d[0] * vy - d[1] * vx;
    const det = ux * px + uy * py + uz * pz;
    if (det === 0) return Infinity;
    const sx = o[0] - p[a], sy = o[1] - p[a + 1], sz = o[2] - p[a + 2];
    const v = (sx * px + sy * py + sz * pz) / det;
    const qx = sy * uz - sz * uy, qy = sz * ux - sx * uz, qz = sx * uy - sy * ux;
    const w = (d[0] * qx + d[1] * qy + d[2] * qz) / det;
    if (!(v >= -1e-9 && w >= -1e-9 && v + w <= 1 + 1e-9)) return Infinity;
    const along = (vx * qx + vy * qy + vz * qz) / det;
    return along > 0 ? along : Infinity;
  }

  /** The ground between two plan positions, for lines that lie on it. Null where there is none. */
  drape(a: number[], b: number[], parts: number): (number[] | null)[] {
    return Array.from({length: parts + 1}, (_, i) => {
      const x = a[0] + ((b[0] - a[0]) * i) / parts, y = a[1] + ((b[1] - a[1]) * i) / parts;
      const ground = this.at(x, y);
      return ground ? [x, y, ground.z] : null;
    });
  }
}
