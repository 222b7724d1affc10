// SPDX-License-Identifier: Apache-2.0
// Libraries for Node that are not ours read what the real server sends: glTF-Transform with the
// decoders of draco3d and meshoptimizer, loaders.gl, Khronos' validator; three's reader of OBJ.

import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {NodeIO} from '@gltf-transform/core';
import {EXTMeshoptCompression, KHRDracoMeshCompression} from '@gltf-transform/extensions';
import {parse} from '@loaders.gl/core';
import {DracoLoader} from '@loaders.gl/draco';
import {GLTFLoader, postProcessGLTF} from '@loaders.gl/gltf';
import draco3d from 'draco3d';
import validator from 'gltf-validator';
import {MeshoptDecoder} from 'meshoptimizer';
import {OBJLoader} from 'three/addons/loaders/OBJLoader.js';
import {startServer} from '../support/program.mjs';
import {assertPositions, COMPRESSIONS, makeTerrain, sharesOf} from './terrain.mjs';

let server, terrain, io;

before(async () => {
  server = await startServer();
  terrain = await makeTerrain(server);
  await MeshoptDecoder.ready;
  io = new NodeIO().registerExtensions([KHRDracoMeshCompression, EXTMeshoptCompression]).registerDependencies({
    'draco3d.decoder': await draco3d.createDecoderModule(),
    'meshopt.decoder': MeshoptDecoder,
  });
});
after(() => server.stop());

/** [x, y, z] in the session's axes of every vertex of the primitive. */
function placesOf(positions, translation) {
  const places = [];
  for (let i = 0; i < positions.length; i += 3) {
    const [x, y, z] = translation.map((metre, axis) => metre + positions[i + axis]);
    places.push([x, -z, y]);
  }
  return places;
}

/** {mode, polygons, positions, indices, feature, translation} of each primitive, by glTF-Transform. */
async function readByTransform(bytes) {
  const document = await io.readBinary(bytes);
  return document.getRoot().listNodes().flatMap((node) => node.getMesh().listPrimitives().map((primitive) => ({
    mode: primitive.getMode(),
    polygons: primitive.getExtras().polygons,
    positions: primitive.getAttribute('POSITION').getArray(),
    feature: primitive.getAttribute('_FEATURE_ID_0')?.getArray(),
    indices: primitive.getIndices().getArray(),
    translation: node.getTranslation(),
  })));
}

/** Plan orientation in whole steps of the grid, exact: flipped and collapsed triangles. */
function countFaults(primitives, step) {
  const faults = {flipped: 0, collapsed: 0};
  for (const {mode, positions, indices} of primitives) {
    for (let i = 0; mode === 4 && i < indices.length; i += 3) {
      const [a, b, c] = [0, 1, 2].map((k) => [0, 2].map((axis) => {
        const n = positions[3 * indices[i + k] + axis] / step;
        assert.ok(Number.isInteger(n), 'a position on the grid');
        return BigInt(axis === 0 ? n : -n);
      }));
      const area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
      if (area < 0n) ++faults.flipped;
      if (area === 0n) ++faults.collapsed;
    }
  }
  return faults;
}

for (const compression of COMPRESSIONS) {
  for (const regions of [false, true]) {
    const query = `compression=${compression}&regions=${regions}`;

    test(`glTF-Transform reads ${query}`, async () => {
      const bytes = await terrain.bytes(`/mesh.glb?${query}`);
      const triangles = (await readByTransform(bytes)).filter(({mode}) => mode === 4);
      const count = triangles.reduce((sum, {indices}) => sum + indices.length / 3, 0);
      assert.equal(count, terrain.mesh.triangles.length);
      assertPositions(triangles.flatMap(({positions, translation}) => placesOf(positions, translation)), terrain.mesh);
      if (!regions) return;
      const shares = Object.fromEntries(triangles.map(({polygons, indices}) => [polygons.join(' '), indices.length / 3]));
      assert.deepEqual(shares, sharesOf(terrain));
      const rows = {'': 3, p1: 0, p2: 1, 'p1 p2': 1, p3: 2};
      for (const {polygons, feature, positions} of triangles) {
        assert.equal(feature.length, positions.length / 3);
        assert.ok(feature.every((id) => id === rows[polygons.join(' ')]), polygons.join(' '));
      }
    });

    test(`loaders.gl reads ${query}`, async () => {
      const bytes = await terrain.bytes(`/mesh.glb?${query}`);
      const gltf = postProcessGLTF(await parse(bytes.buffer, [GLTFLoader, DracoLoader],
          {core: {worker: false}, modules: {draco3d}, gltf: {decompressMeshes: true, loadBuffers: true}}));
      const primitives = gltf.meshes.flatMap(({primitives}) => primitives).filter(({mode}) => (mode ?? 4) === 4);
      const count = primitives.reduce((sum, {indices}) => sum + indices.value.length / 3, 0);
      assert.equal(count, terrain.mesh.triangles.length);
      const {translation} = gltf.nodes[0];
      assertPositions(primitives.flatMap(({attributes}) => placesOf(attributes.POSITION.value, translation)), terrain.mesh);
    });

    test(`Khronos' validator finds no fault in ${query}`, async () => {
      for (const path of ['glb', 'gltf']) {
        const report = await validator.validateBytes(await terrain.bytes(`/mesh.${path}?${query}`), {
          ignoredIssues: ['UNSUPPORTED_EXTENSION', 'UNUSED_OBJECT'],
        });
        assert.deepEqual(report.issues.messages.filter(({severity}) => severity < 2), []);
      }
    });
  }
}

test('borders of regions decode to the same bits, and Draco and meshopt to the same grid', async () => {
  const seen = {};
  for (const compression of COMPRESSIONS) {
    const primitives = await readByTransform(await terrain.bytes(`/mesh.glb?compression=${compression}&regions=true`));
    const places = new Set();
    let vertices = 0;
    for (const {mode, positions} of primitives) {
      if (mode !== 4) continue;
      const bits = new Uint32Array(positions.buffer, positions.byteOffset, positions.length);
      for (let i = 0; i < bits.length; i += 3, ++vertices) places.add(`${bits[i]},${bits[i + 1]},${bits[i + 2]}`);
    }
    // More vertices than places: those on a border are in several primitives, with the same bits.
    assert.equal(places.size, terrain.mesh.vertices.length);
    assert.ok(vertices > places.size);
    seen[compression] = places;
  }
  assert.deepEqual(seen.draco, seen.meshopt);
});

test('flipped and collapsed triangles are as many as the file says', async () => {
  for (const compression of ['draco', 'meshopt']) {
    for (const tolerance of [0.005, 20]) {
      const bytes = await terrain.bytes(`/mesh.glb?compression=${compression}&tolerance=${tolerance}`);
      const {step, flipped, collapsed} = (await io.binaryToJSON(bytes)).json.scenes[0].extras;
      assert.deepEqual(countFaults(await readByTransform(bytes), step), {flipped, collapsed});
      assert.ok(step <= 2 * tolerance);
    }
  }
});

test('a box gives the triangles that meet it', async () => {
  const [x0, y0] = terrain.mesh.vertices[0];
  const box = [x0 + 100, y0 + 100, x0 + 160, y0 + 130];
  const met = terrain.mesh.triangles.filter((corners) => {
    const [a, b, c] = corners.map((slot) => terrain.mesh.vertices[slot]);
    const axes = [[1, 0], [0, 1], ...[[a, b], [b, c], [c, a]].map(([p, q]) => [p[1] - q[1], q[0] - p[0]])];
    const corners4 = [[box[0], box[1]], [box[2], box[1]], [box[2], box[3]], [box[0], box[3]]];
    return axes.every(([nx, ny]) => {
      const along = (points) => points.map(([x, y]) => nx * (x - x0) + ny * (y - y0));
      const t = along([a, b, c]), s = along(corners4);
      return Math.max(...t) >= Math.min(...s) && Math.max(...s) >= Math.min(...t);
    });
  });
  const part = await terrain.json(`/mesh.json?bbox=${box}`);
  assert.equal(part.triangles.length, met.length);
  assert.deepEqual(part.triangles.map((t) => t.map((slot) => part.vertices[slot])),
      met.map((t) => t.map((slot) => terrain.mesh.vertices[slot])));
});

test("three's OBJLoader reads the OBJ", async () => {
  const text = new TextDecoder().decode(await terrain.bytes('/mesh.obj?constraints=true'));
  const group = new OBJLoader().parse(text);
  const mesh = group.children.find(({isMesh, isLineSegments}) => isMesh && !isLineSegments);
  assert.ok(mesh);
  const positions = mesh.geometry.getAttribute('position');
  assert.equal(positions.count, 3 * terrain.mesh.triangles.length);
  // Floats of UTM: half a metre in northing.
  terrain.mesh.triangles.slice(0, 100).forEach((t, i) => t.forEach((slot, k) => {
    assert.ok(Math.abs(positions.getX(3 * i + k) - terrain.mesh.vertices[slot][0]) <= 0.25);
    assert.ok(Math.abs(positions.getY(3 * i + k) - terrain.mesh.vertices[slot][1]) <= 0.25);
  }));
});
