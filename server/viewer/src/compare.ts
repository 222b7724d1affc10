// SPDX-License-Identifier: Apache-2.0
// The mesh as it was: fetched as GLB with Draco, since it is only looked at.
import {BufferGeometry, type CanvasTexture, Group, LineSegments, LineBasicMaterial, Mesh as Drawn, Vector3} from 'three';
import {DRACOLoader} from 'three/examples/jsm/loaders/DRACOLoader.js';
import {GLTFLoader} from 'three/examples/jsm/loaders/GLTFLoader.js';
import {base, type Call, send} from './api';
import type {App} from './app';
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
  private readonly wires = new LineBasicMaterial({color: '#22302a', transparent: true, opacity: 0.42});
  private readonly loader = new GLTFLoader();
  private index: GroundIndex | null = null;

  constructor(private readonly app: App, ramp: CanvasTexture) {
    this.material = groundMaterial(ramp);
    const draco = new DRACOLoader();
    draco.setDecoderPath({js: `${base}/${DRACO_JS}`, wasm: `${base}/${DRACO_WASM}`} as unknown as string);
    this.loader.setDRACOLoader(draco);
  }

  async load(version: number | null) {
    this.version = version;
    this.group = null;
    this.index = null;
    if (version !== null) {
      const call: Call = {method: 'GET', path: this.app.path('/mesh.glb'), query: {version: String(version), up: 'z', tolerance: '0.001', constraints: 'false', normals: 'false'}};
      this.app.note(call);
      const answer = await send(call);
      const gltf = await this.loader.parseAsync(await answer.arrayBuffer(), '');
      if (this.version !== version) return;
      this.group = this.taken(gltf.scene);
    } else {
      this.swipe = false;
    }
    this.app.tell('compare');
  }

  /** In the axes of the session, relative to the origin of the mesh on the screen. */
  private taken(scene: Group): Group {
    const {origin} = this.app.mesh;
    const group = new Group();
    scene.updateMatrixWorld(true);
    scene.traverse((object) => {
      if (!(object instanceof Drawn)) return;
      const shift = object.getWorldPosition(new Vector3());
      const geometry = object.geometry as BufferGeometry;
      const mesh = new Drawn(geometry, this.material);
      mesh.position.set(shift.x - origin[0], shift.y - origin[1], shift.z - origin[2]);
      mesh.frustumCulled = false;
      const wires = new LineSegments(wireGeometry(geometry), this.wires);
      wires.position.copy(mesh.position);
      wires.frustumCulled = false;
      wires.name = 'wires';
      group.add(mesh, wires);
    });
    return group;
  }

  /** To ask it for elevations. */
  async ground(): Promise<GroundIndex | null> {
    if (this.index || !this.group) return this.index;
    const drawn = this.group.children[0] as Drawn;
    const {origin} = this.app.mesh;
    const from = drawn.geometry.getAttribute('position');
    const mesh = new Mesh();
    mesh.positions = new Float64Array(3 * from.count);
    for (let i = 0; i < from.count; ++i) {
      mesh.positions[3 * i] = from.getX(i) + drawn.position.x + origin[0];
      mesh.positions[3 * i + 1] = from.getY(i) + drawn.position.y + origin[1];
      mesh.positions[3 * i + 2] = from.getZ(i) + drawn.position.z + origin[2];
    }
    mesh.corners = new Uint32Array(drawn.geometry.getIndex()!.array);
    [mesh.vertexCount, mesh.triangleCount] = [from.count, mesh.corners.length / 3];
    this.index = new GroundIndex(mesh);
    return this.index;
  }
}

function wireGeometry(geometry: BufferGeometry): BufferGeometry {
  const corners = geometry.getIndex()!.array;
  const out = new Uint32Array(2 * corners.length);
  for (let i = 0; i < corners.length; i += 3) out.set([corners[i], corners[i + 1], corners[i + 1], corners[i + 2], corners[i + 2], corners[i]], 2 * i);
  const wires = new BufferGeometry();
  wires.setAttribute('position', geometry.getAttribute('position'));
  wires.setIndex(Array.from([0, 0]));
  wires.setIndex(new (geometry.getIndex()!.constructor as any)(out, 1));
  return wires;
}
