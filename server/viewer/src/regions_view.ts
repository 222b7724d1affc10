// SPDX-License-Identifier: Apache-2.0
import {BufferGeometry, Group, Mesh as Drawn, type ShaderMaterial, Sphere} from 'three';
import type {App} from './app';
import type {Detail} from './detail';
import {disposeBorrower} from './facets';
import {Lines, segmentsOf} from './lines';
import {PATTERNS, regionMaterial} from './shaders';
import {type TerrainView, writeIndex} from './terrain_view';

/** Told apart with all kinds of sight (Okabe and Ito), and by pattern too. */
const COLOURS = ['#0072b2', '#d55e00', '#8b3f9e', '#00806a', '#c2185b', '#6b5b00'];

export function lookOf(id: string): {colour: string; pattern: number} {
  const n = Math.max(0, Number(/\d+$/.exec(id)?.[0] ?? 1) - 1);
  return {colour: COLOURS[n % COLOURS.length], pattern: (n + Math.floor(n / COLOURS.length)) % PATTERNS.length};
}

export function titleOf(app: App, id: string): string {
  const properties = app.features.find((feature) => feature.tinsmith.id === id)?.properties;
  const name = properties?.name ?? properties?.title;
  return typeof name === 'string' && name ? `${id} ${name}` : id;
}

/** The lines of a geometry, each a list of positions. */
export function linesOf(geometry: any): number[][][] {
  switch (geometry?.type) {
    case 'Polygon': case 'MultiLineString': return geometry.coordinates;
    case 'MultiPolygon': return geometry.coordinates.flat();
    case 'LineString': return [geometry.coordinates];
    case 'GeometryCollection': return geometry.geometries.flatMap(linesOf);
    case 'Feature': return linesOf(geometry.geometry);
    case 'FeatureCollection': return geometry.features.flatMap(linesOf);
    default: return [];
  }
}

const GLOW_MS = 2600;

interface Fill { drawn: Drawn<BufferGeometry, ShaderMaterial>; corners: Uint32Array }

/** Regions in their colours, the edges that they have made, and those that are new. */
export class RegionsView {
  readonly group = new Group();
  private readonly constraints = new Lines({colour: '#13251d', width: 1.6});
  private readonly chosen = new Lines({colour: '#0b1711', width: 3.2});
  private readonly glow = new Lines({colour: '#ffb02e', width: 7, above: true});
  private readonly fills = new Map<string, Fill>();
  private known = new Set<string>();
  private glowing = 0;
  private isReduced = false;
  showFills = true;
  showLines = true;

  constructor(private readonly app: App, private readonly draw: () => void, private readonly isSlow: () => boolean) {
    this.group.add(this.constraints, this.chosen, this.glow);
    app.on(['selection', 'look'], () => { this.select(); });
  }

  /** After another terrain was opened nothing is new. */
  reset() {
    this.known.clear();
    this.glow.set([]);
    this.dropFills();
    this.constraints.set([]);
    this.chosen.set([]);
  }

  /** The buffers of the ground may be others now. */
  share(terrain: TerrainView) {
    for (const {drawn} of this.fills.values()) drawn.geometry.setAttribute('position', terrain.position);
  }

  private dropFills() {
    for (const {drawn} of this.fills.values()) { drawn.removeFromParent(); disposeBorrower(drawn.geometry); drawn.material.dispose(); }
    this.fills.clear();
  }

  sync(terrain: TerrainView, exaggeration: number, pixel: number, isFirst: boolean) {
    const {app} = this;
    const {corners, origin} = app.mesh;
    this.dropFills();
    for (const region of app.regions) {
      const look = lookOf(region.polygon);
      const own = new Uint32Array(3 * region.triangles.length);
      region.triangles.forEach((t, i) => { own.set(corners.subarray(3 * t, 3 * t + 3), 3 * i); });
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', terrain.position);
      geometry.boundingSphere = new Sphere();
      writeIndex(geometry, own, region.triangles.length, null);
      const drawn = new Drawn(geometry, regionMaterial(look.colour, look.pattern));
      drawn.material.uniforms.exaggeration.value = exaggeration;
      drawn.material.uniforms.pixel.value = pixel;
      drawn.frustumCulled = false;
      drawn.renderOrder = 1;
      this.fills.set(region.polygon, {drawn, corners: own});
      this.group.add(drawn);
    }
    const ends: number[] = [];
    const fresh: number[] = [];
    for (const feature of app.features) {
      for (const line of linesOf(feature.geometry)) {
        const own = segmentsOf(line, origin);
        for (const value of own) ends.push(value);
        if (!isFirst && !this.known.has(feature.tinsmith.id)) for (const value of own) fresh.push(value);
      }
    }
    this.known = new Set(app.features.map((feature) => feature.tinsmith.id));
    this.constraints.set(ends);
    if (fresh.length > 0) this.startGlow(fresh);
    this.select();
  }

  get isGlowing() {
    return this.glow.visible;
  }

  private startGlow(ends: number[]) {
    this.glow.set(ends);
    const calm = this.isSlow() || matchMedia('(prefers-reduced-motion: reduce)').matches;
    const begin = performance.now();
    const token = ++this.glowing;
    const step = () => {
      if (token !== this.glowing) return;
      const part = (performance.now() - begin) / GLOW_MS;
      if (part >= 1) {
        this.glow.set([]);
      } else {
        this.glow.material.opacity = calm ? 0.9 : 1 - part * part;
        this.glow.material.linewidth = calm ? 4 : 9 - 6 * part;
        setTimeout(() => { requestAnimationFrame(step); }, calm ? GLOW_MS : 30);
      }
      this.draw();
    };
    step();
  }

  private select() {
    const {app} = this;
    const feature = app.features.find((one) => one.tinsmith.id === app.selected);
    this.chosen.set(feature ? linesOf(feature.geometry).flatMap((line) => segmentsOf(line, app.mesh.origin)) : []);
    for (const [id, {drawn}] of this.fills) {
      drawn.visible = this.showFills;
      drawn.material.uniforms.strength.value = id === app.selected ? 0.5 : 0.22;
    }
    this.chosen.visible = this.chosen.visible && this.showLines;
    if (feature) this.chosen.material.color.set(lookOf(feature.tinsmith.id).colour);
    this.constraints.visible = this.showLines && app.features.length > 0;
    this.draw();
  }

  /** With the same vertices as the ground below them, which would cover them else. */
  setDetail(detail: Detail | null) {
    if (!detail && !this.isReduced) return;
    this.isReduced = detail !== null;
    for (const {drawn, corners} of this.fills.values()) writeIndex(drawn.geometry, corners, corners.length / 3, detail);
  }

  /** Patterns are as wide on every screen. */
  setPixel(value: number) {
    for (const {drawn} of this.fills.values()) drawn.material.uniforms.pixel.value = value;
  }

  setExaggeration(value: number) {
    for (const {drawn} of this.fills.values()) drawn.material.uniforms.exaggeration.value = value;
  }
}
