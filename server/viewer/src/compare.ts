// SPDX-License-Identifier: Apache-2.0
// The mesh as it was: fetched as GLB with Draco, since it is only looked at.
import {type BufferGeometry, type Camera, type CanvasTexture, Group, Mesh as Drawn, Vector3} from 'three';
import {DRACOLoader} from 'three/examples/jsm/loaders/DRACOLoader.js';
import {GLTFLoader} from 'three/examples/jsm/loaders/GLTFLoader.js';
import {base, type Call, send} from './api';
import type {App} from './app';
import {Facets} from './facets';
import {GroundIndex} from './ground_index';
import {Mesh} from './mesh';
import {groundMaterial} from './shaders';

declare const DRACO_JS: string, DRACO_WASM: string;

export class Compare {
  /** Compared with this; null: nothing. */
  version: number | null = null;
  swipe = false;
  part = 0.5;
  group: Group | null = null;
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
    if (version !== null) {
      const group = await this.fetched(version);
      if (this.version !== version) return;
      this.group = group;
    } else {
      this.swipe = false;
    }
    this.app.tell('compare');
  }

  /** The mesh of a version, or its triangles that meet a box. */
  private async fetched(version: number, box?: number[]): Promise<Group> {
    const call: Call = {
      method: 'GET', path: this.app.path('/mesh.glb'), out: 'then.glb',
      query: {version: String(version), up: 'z', tolerance: '0.001', constraints: 'false', normals: 'false', ...(box && {bbox: box.join(',')})},
    };
    this.app.note(call);
    const answer = await send(call);
    return this.taken((await this.loader.parseAsync(await answer.arrayBuffer(), '')).scene);
  }

  /** In the axes of the session, relative to the origin of the mesh on the screen. */
  private taken(scene: Group): Group {
    const {origin} = this.app.mesh;
    // A glTF is in metres, whatever the session's unit.
    const scale = 1 / ((scene.userData.unit_to_metre as number | undefined) ?? 1);
    const group = new Group();
    scene.updateMatrixWorld(true);
    scene.traverse((object) => {
      if (!(object instanceof Drawn)) return;
      const shift = object.getWorldPosition(new Vector3());
      const geometry = object.geometry as BufferGeometry;
      const mesh = new Drawn(geometry, this.material);
      mesh.position.set(shift.x * scale - origin[0], shift.y * scale - origin[1], shift.z * scale - origin[2]);
      mesh.scale.setScalar(scale);
      mesh.frustumCulled = false;
      const facets = new Facets();
      facets.position.copy(mesh.position);
      facets.scale.copy(mesh.scale);
      group.add(mesh, facets);
    });
    return group;
  }

  showFacets(on: boolean, camera: Camera) {
    const children = this.group?.children ?? [];
    for (let i = 0; i + 1 < children.length; i += 2) {
      const {geometry} = children[i] as Drawn;
      const facets = children[i + 1] as Facets;
      facets.visible = false;
      if (on) facets.update(geometry, geometry.getAttribute('position').count, geometry.getIndex()!.count / 3, camera);
    }
  }

  /** The ground of a version in a box, to ask it for elevations. */
  async groundOf(version: number, box: number[]): Promise<GroundIndex> {
    const group = this.version === version && this.group ? this.group : await this.fetched(version, box);
    const {origin} = this.app.mesh;
    // A mesh that is fine over a wide ground comes in several parts.
    const parts = group.children.filter((child): child is Drawn => child instanceof Drawn);
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
