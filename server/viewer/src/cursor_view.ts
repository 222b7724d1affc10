// SPDX-License-Identifier: Apache-2.0
// What is being drawn, and what follows the cursor: the next line of it, or the triangle under it. All
// of it lies above the canvas, so that the ground is not drawn again for it.
import {Vector3} from 'three';
import type {App} from './app';
import type {Draft} from './draft';
import type {Pointer} from './pointer';
import type {Stage} from './stage';
import {byId, svg} from './ui';

const PARTS = 40;

export class CursorView {
  private readonly triangle = svg('path', {class: 'under'});
  private readonly sketch = svg('path', {class: 'sketch'});
  private readonly band = svg('path', {class: 'band'});
  /** The drawn lines on the ground. */
  private draped: (number[] | null)[] = [];

  constructor(private readonly app: App, private readonly draft: Draft, private readonly pointer: Pointer, private readonly stage: Stage) {
    byId('cursor').append(this.triangle, this.sketch, this.band);
    app.on(['draft', 'mesh'], () => { this.drape(); this.placeSketch(); this.place(); });
    app.on(['hover'], () => { this.place(); });
    stage.onFrame.push(() => { this.placeSketch(); this.place(); });
  }

  private drape() {
    const {draft, app: {ground}} = this;
    // The line of a section that is there is drawn with it.
    if (draft.kind === 'Profile' && !draft.drawing) { this.draped = []; return; }
    const line = draft.kind === 'Polygon' && !draft.drawing && draft.points.length > 2 ? [...draft.points, draft.points[0]] : draft.points;
    this.draped = line.slice(1).flatMap((point, i) => ground.drape(line[i], point, line.length > 200 ? 8 : PARTS));
  }

  private placeSketch() {
    this.sketch.setAttribute('d', this.path(this.draped));
  }

  private place() {
    const {pointer: {hover}, draft, app: {mesh, ground}} = this;
    const last = draft.points[draft.points.length - 1];
    const around = hover && !draft.drawing && hover.triangle < mesh.triangleCount
      ? [0, 1, 2].map((k) => { const at = 3 * mesh.corners[3 * hover.triangle + k]; return [...mesh.positions.subarray(at, at + 3)]; }) : [];
    this.triangle.setAttribute('d', around.length ? `${this.path(around)}Z` : '');
    this.band.setAttribute('d', hover && draft.drawing && last ? this.path(ground.drape(last, [hover.x, hover.y], PARTS)) : '');
  }

  /** Begins anew where there is no ground, or it lies behind the eye. */
  private path(points: (number[] | null)[]) {
    const {origin} = this.app.mesh;
    let pen = 'M', text = '';
    for (const point of points) {
      const at = point && this.stage.project(new Vector3(point[0] - origin[0], point[1] - origin[1], point[2] - origin[2]));
      if (at) text += `${pen}${at.x.toFixed(1)} ${at.y.toFixed(1)}`;
      pen = at ? 'L' : 'M';
    }
    return text;
  }
}
