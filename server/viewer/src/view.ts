// SPDX-License-Identifier: Apache-2.0
// The terrain on the canvas, with all that lies on it.
import {Vector3} from 'three';
import type {App} from './app';
import type {Choice, Compare} from './compare';
import type {Draft} from './draft';
import {Detail} from './detail';
import {Lines, segmentsOf} from './lines';
import type {Mesh} from './mesh';
import type {Profile} from './profile';
import {linesOf, RegionsView} from './regions_view';
import {rampTexture} from './shaders';
import type {Stage} from './stage';
import {TerrainView} from './terrain_view';

const PARTS = 40;
/** Fewer triangles than these are always drawn all. */
const MANY = 150_000;
/** Cells, in pixels, and how much of what lies around the view is drawn along. */
const RESTING = [1.5, 1.02], MOVING = [5, 1.5];

export class View {
  readonly ramp = rampTexture();
  terrain: TerrainView | null = null;
  readonly regions: RegionsView;
  range: [number, number] = [0, 1];
  exaggeration = 1;
  contours = false;
  compare: Compare | null = null;
  /** Shows a line above the map; set by the page. */
  hint: (text: string) => void = () => {};
  private readonly sketch = new Lines({colour: '#c2410c', width: 2.6, above: true});
  private readonly section = new Lines({colour: '#5b21b6', width: 2.6, above: true});
  private isFresh = true;
  private readonly spare = new Detail();
  private looked = 0;
  private lookedAt: Mesh | null = null;
  /** In use where drawing all takes too long. */
  private detail: Detail | null = null;

  constructor(private readonly app: App, private readonly draft: Draft, readonly stage: Stage) {
    this.regions = new RegionsView(app, () => { stage.invalidate(); }, () => stage.wasSlow);
    stage.world.add(this.regions.group, this.sketch, this.section);
    stage.onView = () => { this.refine(); this.showFacets(); };
    app.show = async (delta, isNew) => {
      if (isNew) {
        const wireframe = this.terrain?.wireframe ?? false;
        this.terrain?.dispose();
        this.regions.reset();
        this.isFresh = true;
        stage.startAnew();
        this.terrain = new TerrainView(app.mesh, this.ramp);
        this.terrain.sync(delta);
        this.terrain.wireframe = wireframe;
        stage.world.add(...this.terrain.objects);
        this.range = app.mesh.range();
        this.look();
        this.fit();
      } else {
        this.terrain!.sync(delta);
        const range = app.mesh.range();
        this.range = [Math.min(this.range[0], range[0]), Math.max(this.range[1], range[1])];
        this.look();
        this.regions.share(this.terrain!);
      }
      this.drawSketch();
      await stage.drawn();
      app.tell('mesh');
    };
    app.clear = () => {
      this.terrain?.dispose();
      this.terrain = null;
      this.regions.reset();
      void this.compare?.load(null);
      stage.invalidate();
    };
    app.on(['regions'], () => {
      if (!this.terrain) return;
      this.regions.sync(this.terrain, this.exaggeration, stage.pixelRatio(), this.isFresh);
      this.isFresh = false;
      this.regions.setDetail(this.detail);
      stage.invalidate();
    });
    app.on(['draft'], () => { this.drawSketch(); });
  }

  /** Chooses how much is drawn for the view as it is. */
  private refine() {
    const {terrain, stage, app: {mesh}} = this;
    if (!terrain) return;
    this.detail = null;
    let choose: Choice | null = null;
    if (stage.wasSlow && mesh.triangleCount > MANY) {
      const {clientWidth, clientHeight} = stage.canvas;
      const [cell, margin] = stage.isEconomical ? MOVING : RESTING;
      if (this.looked !== mesh.version || this.lookedAt !== mesh) {
        [this.looked, this.lookedAt] = [mesh.version, mesh];
        this.spare.look(mesh.corners, mesh.triangleCount, mesh.vertexCount);
      }
      choose = (positions, count, object, detail) => {
        detail.measure(positions, count, stage.toClip(object), clientWidth, clientHeight, cell, margin);
      };
      choose(mesh.local, mesh.vertexCount, terrain.ground, this.spare);
      this.detail = this.spare;
    }
    this.compare?.setDetail(choose);
    terrain.setDetail(this.detail);
    this.regions.setDetail(this.detail);
    this.regions.setPixel(stage.pixelRatio());
  }

  /** What comes from a file; what is drawn by hand lies above the canvas. */
  private drawSketch() {
    const {draft, app} = this;
    const lines = draft.imported && !draft.placed ? linesOf(draft.imported.value) : [];
    if (lines.length === 0 && !draft.placed && !this.sketch.visible) return;
    const total = lines.reduce((all, line) => all + line.length, 0);
    const parts = total > 2000 ? 2 : total > 200 ? 8 : PARTS;
    const ends: number[] = [];
    const add = (line: (number[] | null)[]) => { for (const value of segmentsOf(line, app.mesh.origin)) ends.push(value); };
    for (const line of draft.placed ?? []) add(line);
    for (const line of lines) for (let i = 1; i < line.length; ++i) add(app.ground.drape(line[i - 1], line[i], parts));
    this.sketch.set(ends);
    this.stage.invalidate();
  }

  showProfile(profile: Profile) {
    const {ground, mesh} = this.app;
    this.section.set(profile.line.flatMap((point, i) => (i ? segmentsOf(ground.drape(profile.line[i - 1], point, PARTS), mesh.origin) : [])));
    this.stage.invalidate();
  }

  /** Uniforms and visibility by what is wanted. */
  look() {
    if (!this.terrain) return;
    const step = contourStep(this.range[1] - this.range[0]);
    const {origin} = this.app.mesh;
    for (const {uniforms} of [this.terrain.material, ...(this.compare ? [this.compare.material] : [])]) {
      uniforms.range.value.set(this.range[0] - origin[2], Math.max(this.range[1], this.range[0] + 1e-3) - origin[2]);
      uniforms.exaggeration.value = this.exaggeration;
      uniforms.contour.value = this.contours ? step : 0;
    }
    this.stage.world.scale.z = this.exaggeration;
    this.regions.setExaggeration(this.exaggeration);
    this.showCompare();
    this.refine();
    this.showFacets();
    this.app.tell('look');
  }

  showCompare() {
    const {compare, stage, terrain} = this;
    if (!compare || !terrain) return;
    if (stage.compare && stage.compare.before !== compare.group) stage.compare.before.removeFromParent();
    if (compare.swipe && compare.group) {
      stage.world.add(compare.group);
      stage.compare = {before: compare.group, now: [...terrain.objects, this.regions.group], part: compare.part};
    } else {
      stage.compare = null;
    }
    stage.invalidate();
  }

  /** The edges of what is in view. */
  showFacets() {
    const {terrain, compare, stage} = this;
    if (!terrain) return;
    if (stage.isEconomical) { terrain.facets.visible = false; return; }
    terrain.showFacets(stage.camera);
    compare?.showFacets(terrain.wireframe && compare.swipe, stage.camera);
    this.hint(terrain.wireframe && terrain.facets.inView > 0 && !terrain.facets.visible
      ? `Zoom in to see the facets: ${terrain.facets.inView.toLocaleString('en')} are in view` : '');
    stage.invalidate();
  }

  fit(steep = false) {
    const b = this.app.session?.bounds;
    if (!b) return;
    const {origin} = this.app.mesh;
    const middle = new Vector3((b[0] + b[3]) / 2 - origin[0], (b[1] + b[4]) / 2 - origin[1], ((b[2] + b[5]) / 2 - origin[2]) * this.exaggeration);
    this.stage.fit(middle, [b[3] - b[0], b[4] - b[1], (b[5] - b[2]) * this.exaggeration], steep);
  }

  /** Brings a plan position into the middle, near enough to see `size` around it. */
  goTo(x: number, y: number, size: number) {
    const {origin} = this.app.mesh;
    const z = this.app.ground.at(x, y)?.z ?? origin[2];
    this.stage.fit(new Vector3(x - origin[0], y - origin[1], (z - origin[2]) * this.exaggeration), [size, size, 0]);
  }
}

/** Twelve or so lines. */
export function contourStep(span: number): number {
  const raw = Math.max(span, 1e-6) / 14;
  const power = 10 ** Math.floor(Math.log10(raw));
  return power * ([1, 2, 5, 10].find((n) => n * power >= raw) ?? 10);
}
