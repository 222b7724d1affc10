// SPDX-License-Identifier: Apache-2.0
import {BufferAttribute, BufferGeometry, type Camera, type CanvasTexture, Mesh as Drawn, Sphere} from 'three';
import type {Delta} from './delta';
import {coarseIndex} from './coarse';
import {Facets} from './facets';
import type {Mesh} from './mesh';
import {groundMaterial} from './shaders';

/** The buffers of the mesh on the graphics card. An edit writes the slots that its delta names. */
export class TerrainView {
  readonly material;
  readonly ground: Drawn;
  readonly facets = new Facets();
  /** What is drawn instead while the view moves and frames are slow. */
  private readonly coarse: Drawn;
  private coarseIsCurrent = false;
  private economy = false;
  wireframe = false;

  constructor(private readonly mesh: Mesh, ramp: CanvasTexture) {
    this.material = groundMaterial(ramp);
    this.ground = new Drawn(new BufferGeometry(), this.material);
    this.coarse = new Drawn(new BufferGeometry(), this.material);
    for (const object of this.objects) {
      object.frustumCulled = false;
      // Known, so that nobody goes over a million vertices to sort a handful of objects.
      object.geometry.boundingSphere = new Sphere();
    }
    this.coarse.visible = false;
  }

  get objects() {
    return [this.ground, this.coarse, this.facets];
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
  }

  /** Shows the facets as they are seen now, or none. */
  showFacets(camera: Camera) {
    if (this.wireframe) this.facets.update(this.ground.geometry, this.mesh.vertexCount, this.mesh.triangleCount, camera);
    else this.facets.visible = false;
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
    if (this.economy) this.facets.visible = false;
  }

  dispose() {
    for (const object of this.objects) { object.removeFromParent(); object.geometry.dispose(); }
    this.material.dispose();
  }
}
