// SPDX-License-Identifier: Apache-2.0
import {BufferAttribute, BufferGeometry, type Camera, LineBasicMaterial, LineSegments, Matrix4, Sphere} from 'three';

/** More than these in view are a grey carpet, and slow. */
const MOST = 60_000;
/** Below this, edges are drawn from both sides, so that the border of the terrain is whole. */
const BOTH_SIDES = 20_000;

/** Where a vertex lies beyond the view: left, right, below, above, behind. */
function outcodes(positions: ArrayLike<number>, count: number, m: number[]): Uint8Array {
  const codes = new Uint8Array(count);
  for (let v = 0, i = 0; v < count; ++v, i += 3) {
    const px = positions[i], py = positions[i + 1], pz = positions[i + 2];
    const x = m[0] * px + m[4] * py + m[8] * pz + m[12], y = m[1] * px + m[5] * py + m[9] * pz + m[13];
    const z = m[2] * px + m[6] * py + m[10] * pz + m[14], w = m[3] * px + m[7] * py + m[11] * pz + m[15];
    codes[v] = (x < -w ? 1 : 0) | (x > w ? 2 : 0) | (y < -w ? 4 : 0) | (y > w ? 8 : 0) | (z < -w ? 16 : 0);
  }
  return codes;
}

/**
 * Frees a geometry that draws from the ground's positions, and not these: they are the ground's, which
 * would go on drawing from a buffer that edits do not reach any more.
 */
export function disposeBorrower(geometry: BufferGeometry) {
  geometry.deleteAttribute('position');
  geometry.dispose();
}

/** The edges of the triangles that are in view, unless these are too many. */
export class Facets extends LineSegments {
  inView = 0;

  constructor() {
    super(new BufferGeometry(), new LineBasicMaterial({color: '#22302a', transparent: true, opacity: 0.5}));
    this.frustumCulled = false;
    this.renderOrder = 1;
    this.visible = false;
  }

  /** Takes over the ground's positions; `count` and `triangles` say how much of the buffers is in use. */
  update(ground: BufferGeometry, count: number, triangles: number, camera: Camera) {
    const corners = ground.getIndex()!.array;
    const position = ground.getAttribute('position');
    this.updateWorldMatrix(true, false);
    const toClip = new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).multiply(this.matrixWorld);
    const codes = outcodes(position.array, count, toClip.elements);
    const found: number[] = [];
    for (let t = 0; t < triangles; ++t)
      if ((codes[corners[3 * t]] & codes[corners[3 * t + 1]] & codes[corners[3 * t + 2]]) === 0) found.push(t);
    this.inView = found.length;
    this.visible = found.length > 0 && found.length <= MOST;
    disposeBorrower(this.geometry);
    this.geometry = new BufferGeometry();
    this.geometry.setAttribute('position', position);
    this.geometry.boundingSphere = new Sphere();
    if (!this.visible) return;
    const both = found.length < BOTH_SIDES;
    const ends = new Uint32Array(6 * found.length);
    let used = 0;
    for (const t of found) {
      for (let k = 0; k < 3; ++k) {
        const a = corners[3 * t + k], b = corners[3 * t + ((k + 1) % 3)];
        if (both || a < b) { ends[used++] = a; ends[used++] = b; }
      }
    }
    this.geometry.setIndex(new BufferAttribute(ends.slice(0, used), 1));
  }
}
