// SPDX-License-Identifier: Apache-2.0
// The mesh as it was: fetched as GLB with Draco, since it is only looked at.
import {BufferGeometry, type Camera, type CanvasTexture, Group, Mesh as Drawn, Sphere, Vector3} from 'three';
import {DRACOLoader} from 'three/examples/jsm/loaders/DRACOLoader.js';
import {GLTFLoader} from 'three/examples/jsm/loaders/GLTFLoader.js';
import {base, type Call, send} from './api';
import type {App} from './app';
import {Detail} from './detail';
import {Facets} from './facets';
import {GroundIndex} from './ground_index';
import {Mesh} from './mesh';
import {groundMaterial} from './shaders';
import {STEEPEST_DRAWN, writeIndex} from './terrain_view';

declare const DRACO_JS: string, DRACO_WASM: string;

/** A mesh that is fine over a wide ground comes in several of these. */
interface Part { full: Drawn; reduced: Drawn; facets: Facets; corners: Uint32Array; detail: Detail }

/** Measures a detail for an object of these positions, as the view is. */
export type Choice = (positions: Float32Array, count: number, object: Drawn, detail: Detail) => void;

export class Compare {
  /** Compared with this; null: nothing. */
  version: number | null = null;
  swipe = false;
  part = 0.5;
  group: Group | null = null;
  private parts: Part[] = [];
  readonly material;
  private readonly loader = new GLTFLoader();

  constructor(private readonly app: App, ramp: CanvasTexture) {
    this.material = groundMaterial(ramp);
    const draco = new DRACOLoader();
    draco.setDecoderPath({js: `${base}/${DRACO_JS}`, wasm: `${base}/${DRACO_WASM}`} as unknown as string);
    this.loader.setDRACOLoader(draco);
  }

  async load(version: number | null) {
    this.version = version;
    this.group = null;
    this.parts = [];
    if (version !== null) {
      const parts = await this.fetched(version);
      if (this.version !== version) return;
      this.parts = parts;
      this.group = new Group();
      for (const {full, reduced, facets} of parts) this.group.add(full, reduced, facets);
    } else {
      this.swipe = false;
    }
    this.app.tell('compare');
  }

  /** The mesh of a version, or its triangles that meet a box. */
  private async fetched(version: number, box?: number[]): Promise<Part[]> {
    const call: Call = {
      method: 'GET', path: this.app.path('/mesh.glb'), out: 'then.glb',
      query: {version: String(version), up: 'z', tolerance: '0.001', constraints: 'false', normals: 'false', ...(box && {bbox: box.join(',')})},
    };
    this.app.note(call);
    const answer = await send(call);
    return this.taken((await this.loader.parseAsync(await answer.arrayBuffer(), '')).scene);
  }

  /** In the axes of the session, relative to the origin of the mesh on the screen. */
  private taken(scene: Group): Part[] {
    const {origin} = this.app.mesh;
    // A glTF is in metres, whatever the session's unit.
    const scale = 1 / ((scene.userData.unit_to_metre as number | undefined) ?? 1);
    const parts: Part[] = [];
    scene.updateMatrixWorld(true);
    scene.traverse((object) => {
      if (!(object instanceof Drawn)) return;
      const shift = object.getWorldPosition(new Vector3());
      const geometry = object.geometry as BufferGeometry;
      const few = new BufferGeometry();
      few.setAttribute('position', geometry.getAttribute('position'));
      few.boundingSphere = new Sphere();
      const part = {full: new Drawn(geometry, this.material), reduced: new Drawn(few, this.material), facets: new Facets(),
        corners: new Uint32Array(geometry.getIndex()!.array), detail: new Detail()};
      part.detail.look(part.corners, part.corners.length / 3, geometry.getAttribute('position').count);
      part.reduced.visible = false;
      for (const each of [part.full, part.reduced, part.facets]) {
        each.position.set(shift.x * scale - origin[0], shift.y * scale - origin[1], shift.z * scale - origin[2]);
        each.scale.setScalar(scale);
        each.frustumCulled = false;
      }
      parts.push(part);
    });
    return parts;
  }

  /** Draws what is left of the triangles at a detail; null: all of them. */
  setDetail(choose: Choice | null) {
    this.material.uniforms.least_up.value = choose ? STEEPEST_DRAWN : 0;
    for (const {full, reduced, corners, detail} of this.swipe ? this.parts : []) {
      full.visible = choose === null;
      reduced.visible = choose !== null;
      if (!choose) continue;
      const position = full.geometry.getAttribute('position');
      choose(position.array as Float32Array, position.count, full, detail);
      writeIndex(reduced.geometry, corners, corners.length / 3, detail);
    }
  }

  showFacets(on: boolean, camera: Camera) {
    for (const {full: {geometry}, facets} of this.parts) {
      facets.visible = false;
      if (on) facets.update(geometry, geometry.getAttribute('position').count, geometry.getIndex()!.count / 3, camera);
    }
  }

  /** The ground of a version in a box, to ask it for elevations. */
  async groundOf(version: number, box: number[]): Promise<GroundIndex> {
    const found = this.version === version && this.group ? this.parts : await this.fetched(version, box);
    const {origin} = this.app.mesh;
    const parts = found.map(({full}) => full);
    const mesh = new Mesh();
    mesh.positions = new Float64Array(parts.reduce((sum, part) => sum + 3 * part.geometry.getAttribute('position').count, 0));
    mesh.corners = new Uint32Array(parts.reduce((sum, part) => sum + part.geometry.getIndex()!.count, 0));
    for (const {geometry, position, scale} of parts) {
      const from = geometry.getAttribute('position');
      const index = geometry.getIndex()!;
      for (let i = 0; i < index.count; ++i) mesh.corners[3 * mesh.triangleCount + i] = index.getX(i) + mesh.vertexCount;
      for (let i = 0, at = 3 * mesh.vertexCount; i < from.count; ++i) {
        mesh.positions[at++] = from.getX(i) * scale.x + position.x + origin[0];
        mesh.positions[at++] = from.getY(i) * scale.y + position.y + origin[1];
        mesh.positions[at++] = from.getZ(i) * scale.z + position.z + origin[2];
      }
      mesh.vertexCount += from.count;
      mesh.triangleCount += index.count / 3;
    }
    return new GroundIndex(mesh);
  }
}
