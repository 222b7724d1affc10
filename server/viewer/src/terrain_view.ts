// SPDX-License-Identifier: Apache-2.0
import {BufferAttribute, BufferGeometry, type Camera, type CanvasTexture, DynamicDrawUsage, Mesh as Drawn, Sphere} from 'three';
import type {Delta} from './delta';
import type {Detail} from './detail';
import {disposeBorrower, Facets} from './facets';
import type {Mesh} from './mesh';
import {groundMaterial} from './shaders';

/** Of the upward part of a facet's normal where triangles are left out: 60 degrees. */
export const STEEPEST_DRAWN = 0.5;

/** The buffers of the mesh on the graphics card. An edit writes the slots that its delta names. */
export class TerrainView {
  readonly material;
  readonly ground: Drawn;
  readonly facets = new Facets();
  /** What is drawn instead where drawing all takes too long. */
  private readonly reduced: Drawn;
  wireframe = false;

  constructor(private readonly mesh: Mesh, ramp: CanvasTexture) {
    this.material = groundMaterial(ramp);
    this.ground = new Drawn(new BufferGeometry(), this.material);
    this.reduced = new Drawn(new BufferGeometry(), this.material);
    for (const object of this.objects) {
      object.frustumCulled = false;
      // Known, so that nobody goes over a million vertices to sort a handful of objects.
      object.geometry.boundingSphere = new Sphere();
    }
    this.reduced.visible = false;
  }

  get objects() {
    return [this.ground, this.reduced, this.facets];
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
  }

  /** Shows the facets as they are seen now, or none. */
  showFacets(camera: Camera) {
    if (this.wireframe) this.facets.update(this.ground.geometry, this.mesh.vertexCount, this.mesh.triangleCount, camera);
    else this.facets.visible = false;
  }

  /** Draws what is left of the triangles at a detail; null: all of them. */
  setDetail(detail: Detail | null) {
    this.ground.visible = detail === null;
    this.reduced.visible = detail !== null;
    this.material.uniforms.least_up.value = detail ? STEEPEST_DRAWN : 0;
    if (detail) writeIndex(this.reduced.geometry, this.mesh.corners, this.mesh.triangleCount, detail);
  }

  dispose() {
    for (const object of this.objects) object.removeFromParent();
    disposeBorrower(this.reduced.geometry);
    disposeBorrower(this.facets.geometry);
    this.ground.geometry.dispose();
    this.material.dispose();
  }
}

/** The index buffer of what is left of these triangles; one buffer for as long as they fit. */
export function writeIndex(geometry: BufferGeometry, corners: Uint32Array, triangles: number, detail: Detail | null) {
  let index = geometry.getIndex();
  if (!index || index.array.length < 3 * triangles) {
    index = new BufferAttribute(new Uint32Array(3 * Math.ceil(triangles * 1.1)), 1);
    index.setUsage(DynamicDrawUsage);
    geometry.setIndex(index);
  }
  const into = index.array as Uint32Array;
  let used = 3 * triangles;
  if (detail) used = detail.write(corners, triangles, into); else into.set(corners.subarray(0, used));
  index.clearUpdateRanges();
  index.addUpdateRange(0, used);
  index.needsUpdate = true;
  geometry.setDrawRange(0, used);
}
