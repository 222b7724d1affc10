// SPDX-License-Identifier: Apache-2.0
import type {Delta} from './delta';

/** Room to grow, so that most edits fit into the buffers that are there. */
const SPARE = 1.2;

function withRoom<T extends Float64Array | Float32Array | Uint32Array>(old: T, used: number, needed: number): T {
  if (needed <= old.length) return old;
  const grown = new (old.constructor as new (length: number) => T)(3 * Math.ceil((needed * SPARE) / 3));
  grown.set(old.subarray(0, used));
  return grown;
}

/**
 * The session's mesh in slot order, in its own doubles, and beside them the floats for the screen:
 * relative to `origin`, so that a millimetre is still there at coordinates of millions.
 */
export class Mesh {
  version = 0;
  vertexCount = 0;
  triangleCount = 0;
  origin: [number, number, number] = [0, 0, 0];
  positions = new Float64Array(0);
  local = new Float32Array(0);
  corners = new Uint32Array(0);

  /** Writes what the delta names. False: it leads from another version than this one. */
  apply(delta: Delta): boolean {
    if (!delta.whole && delta.from !== this.version) return false;
    if (!delta.whole && (delta.oldVertices !== this.vertexCount || delta.oldTriangles !== this.triangleCount)) return false;
    this.positions = withRoom(this.positions, 3 * this.vertexCount, 3 * delta.newVertices);
    this.local = withRoom(this.local, 3 * this.vertexCount, 3 * delta.newVertices);
    this.corners = withRoom(this.corners, 3 * this.triangleCount, 3 * delta.newTriangles);
    if (this.version === 0) this.placeOrigin(delta.positions);
    let read = 0;
    for (const {first, count} of delta.vertexRuns) {
      this.positions.set(delta.positions.subarray(read, read + 3 * count), 3 * first);
      this.writeLocal(first, count);
      read += 3 * count;
    }
    read = 0;
    for (const {first, count} of delta.triangleRuns) {
      this.corners.set(delta.corners.subarray(read, read + 3 * count), 3 * first);
      read += 3 * count;
    }
    this.vertexCount = delta.newVertices;
    this.triangleCount = delta.newTriangles;
    this.version = delta.to;
    return true;
  }

  private placeOrigin(positions: Float64Array) {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < positions.length; ++i) {
      const k = i % 3;
      if (positions[i] < low[k]) low[k] = positions[i];
      if (positions[i] > high[k]) high[k] = positions[i];
    }
    this.origin = low.map((l, k) => (positions.length ? Math.round((l + high[k]) / 2) : 0)) as Mesh['origin'];
  }

  private writeLocal(first: number, count: number) {
    for (let i = 3 * first; i < 3 * (first + count); i += 3) {
      this.local[i] = this.positions[i] - this.origin[0];
      this.local[i + 1] = this.positions[i + 1] - this.origin[1];
      this.local[i + 2] = this.positions[i + 2] - this.origin[2];
    }
  }

  /** Low and high elevation. */
  range(): [number, number] {
    let low = Infinity, high = -Infinity;
    for (let i = 2; i < 3 * this.vertexCount; i += 3) {
      const z = this.positions[i];
      if (z < low) low = z;
      if (z > high) high = z;
    }
    return this.vertexCount ? [low, high] : [0, 0];
  }
}
