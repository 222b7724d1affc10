// SPDX-License-Identifier: Apache-2.0
import {BufferAttribute, BufferGeometry, type CanvasTexture, LineBasicMaterial, LineSegments, Mesh as Drawn} from 'three';
import type {Delta} from './delta';
import {coarseIndex} from './coarse';
import type {Mesh} from './mesh';
import {groundMaterial} from './shaders';

/** The buffers of the mesh on the graphics card. An edit writes the slots that its delta names. */
export class TerrainView {
  readonly material;
  readonly ground: Drawn;
  readonly wires: LineSegments;
  /** What is drawn instead while the view moves and frames are slow. */
  private readonly coarse: Drawn;
  private coarseIsCurrent = false;
  private economy = false;
  wireframe = false;

  constructor(private readonly mesh: Mesh, ramp: CanvasTexture) {
    this.material = groundMaterial(ramp);
    this.ground = new Drawn(new BufferGeometry(), this.material);
    this.coarse = new Drawn(new BufferGeometry(), this.material);
    this.wires = new LineSegments(new BufferGeometry(), new LineBasicMaterial({color: '#22302a', transparent: true, opacity: 0.42}));
    for (const object of this.objects) object.frustumCulled = false;
    this.coarse.visible = this.wires.visible = false;
    this.wires.renderOrder = 1;
  }

  get objects() {
    return [this.ground, this.coarse, this.wires];
  }
  get position() {
    return this.ground.geometry.getAttribute('position') as BufferAttribute;
  }

  /** Takes over what an edit has written into the mesh; all of it where the buffers have grown. */
  sync(delta: Delta) {
    const {geometry} = this.ground;
    const position = geometry.getAttribute('position') as BufferAttribute | undefined;
    const index = geometry.getIndex();
    if (position?.array !== this.mesh.local) {
      const attribute = new BufferAttribute(this.mesh.local, 3);
      for (const object of this.objects) object.geometry.setAttribute('position', attribute);
    } else if (delta.whole) {
      position.needsUpdate = true;
    } else {
      for (const {first, count} of delta.vertexRuns) position.addUpdateRange(3 * first, 3 * count);
      position.needsUpdate = true;
    }
    if (index?.array !== this.mesh.corners) {
      geometry.setIndex(new BufferAttribute(this.mesh.corners, 1));
    } else {
      if (!delta.whole) for (const {first, count} of delta.triangleRuns) index.addUpdateRange(3 * first, 3 * count);
      index.needsUpdate = true;
    }
    geometry.setDrawRange(0, 3 * this.mesh.triangleCount);
    this.coarseIsCurrent = false;
    if (this.wires.geometry.getIndex()) this.writeWires(delta);
  }

  setWireframe(on: boolean) {
    this.wireframe = on;
    if (on && !this.wires.geometry.getIndex()) this.writeWires(null);
    this.show();
  }

  setEconomy(economy: boolean) {
    this.economy = economy && this.mesh.triangleCount > 200_000;
    if (this.economy && !this.coarseIsCurrent) {
      this.coarse.geometry.setIndex(new BufferAttribute(coarseIndex(this.mesh), 1));
      this.coarseIsCurrent = true;
    }
    this.show();
  }

  private show() {
    this.ground.visible = !this.economy;
    this.coarse.visible = this.economy;
    this.wires.visible = this.wireframe && !this.economy;
  }

  /** Three edges for each triangle slot, so that they are patched as the triangles are. */
  private writeWires(delta: Delta | null) {
    const {corners, triangleCount} = this.mesh;
    let index = this.wires.geometry.getIndex();
    const isNew = index?.array.length !== 2 * corners.length;
    if (!index || isNew) index = new BufferAttribute(new Uint32Array(2 * corners.length), 1);
    const out = index.array as Uint32Array;
    const runs = isNew || !delta || delta.whole ? [{first: 0, count: triangleCount}] : delta.triangleRuns;
    for (const {first, count} of runs) {
      for (let t = first; t < first + count; ++t) {
        const [a, b, c] = [corners[3 * t], corners[3 * t + 1], corners[3 * t + 2]];
        out.set([a, b, b, c, c, a], 6 * t);
      }
      if (!isNew) index.addUpdateRange(6 * first, 6 * count);
    }
    if (isNew) this.wires.geometry.setIndex(index); else index.needsUpdate = true;
    this.wires.geometry.setDrawRange(0, 6 * triangleCount);
  }

  dispose() {
    for (const object of this.objects) { object.removeFromParent(); object.geometry.dispose(); }
    this.material.dispose();
  }
}
