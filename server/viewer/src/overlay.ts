// SPDX-License-Identifier: Apache-2.0
// HTML that stands above the canvas at places of the terrain: labels, corners, marks of errors.
import {Vector3} from 'three';
import type {App, Mark} from './app';
import type {Draft} from './draft';
import {lookOf, titleOf} from './regions_view';
import type {Stage} from './stage';
import {byId, h} from './ui';

interface Pin { element: HTMLElement; at: Vector3 }

export class Overlay {
  private readonly layer = byId('overlay');
  private labels: Pin[] = [];
  private corners: Pin[] = [];
  private marks: Pin[] = [];
  showLabels = true;

  constructor(private readonly app: App, private readonly draft: Draft, private readonly stage: Stage) {
    app.on(['regions', 'selection', 'look'], () => { this.labels = this.replaced(this.labels, this.makeLabels()); });
    app.on(['draft'], () => { this.corners = this.replaced(this.corners, this.makeCorners()); });
    app.on(['problem'], () => { this.marks = this.replaced(this.marks, this.makeMarks()); });
    stage.onFrame.push(() => { this.place(); });
  }

  private replaced(old: Pin[], made: Pin[]) {
    for (const {element} of old) element.remove();
    this.layer.append(...made.map(({element}) => element));
    // At their places at once: the ground is not drawn again for them.
    this.put(made);
    return made;
  }

  private pin(element: HTMLElement, x: number, y: number): Pin {
    const {origin} = this.app.mesh;
    const z = this.app.ground.at(x, y)?.z ?? origin[2];
    return {element, at: new Vector3(x - origin[0], y - origin[1], z - origin[2])};
  }

  private makeLabels(): Pin[] {
    if (!this.showLabels) return [];
    const {mesh} = this.app;
    return this.app.regions.filter((region) => region.triangles.length > 0).slice(0, 60).map((region) => {
      // The middle of its largest triangle is certainly inside.
      let best = region.triangles[0], size = -1;
      for (const t of region.triangles) {
        const [a, b, c] = [0, 1, 2].map((k) => 3 * mesh.corners[3 * t + k]);
        const p = mesh.positions;
        const area = Math.abs((p[b] - p[a]) * (p[c + 1] - p[a + 1]) - (p[b + 1] - p[a + 1]) * (p[c] - p[a]));
        if (area > size) [best, size] = [t, area];
      }
      const corner = [0, 1, 2].map((k) => 3 * mesh.corners[3 * best + k]);
      const middle = (axis: number) => corner.reduce((sum, at) => sum + mesh.positions[at + axis], 0) / 3;
      const element = h('span', {class: `label${region.polygon === this.app.selected ? ' chosen' : ''}`}, titleOf(this.app, region.polygon));
      element.style.setProperty('--colour', lookOf(region.polygon).colour);
      return this.pin(element, middle(0), middle(1));
    });
  }

  private makeCorners(): Pin[] {
    return this.draft.points.slice(0, 400).map(([x, y], i) =>
      this.pin(h('span', {class: i === this.draft.points.length - 1 ? 'corner last' : 'corner'}), x, y));
  }

  private makeMarks(): Pin[] {
    const marks: Mark[] = (this.app.problem?.errors ?? []).filter((fault) => fault.coordinate)
      .map((fault) => ({x: fault.coordinate![0], y: fault.coordinate![1], text: fault.code}));
    return marks.slice(0, 100).map((mark) => this.pin(h('span', {class: 'mark'}, h('b', {}, mark.text)), mark.x, mark.y));
  }

  private place() {
    this.put(this.labels);
    this.put(this.corners);
    this.put(this.marks);
  }

  private put(pins: Pin[]) {
    for (const {element, at} of pins) {
      const spot = this.stage.project(at);
      element.hidden = spot === null;
      if (spot) element.style.transform = `translate(${spot.x.toFixed(1)}px, ${spot.y.toFixed(1)}px)`;
    }
  }
}
