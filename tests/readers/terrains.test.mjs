// SPDX-License-Identifier: Apache-2.0
// A real terrain that others made, a tile of the Himalaya of 1,175 triangles, written by programs of
// others: three's writer of OBJ, glTF-Transform (plain, Draco, meshoptimizer), gltfpack. The server
// reads each back to the same triangles.

import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {dirname, join} from 'node:path';
import {after, before, test} from 'node:test';
import {Document, NodeIO} from '@gltf-transform/core';
import {EXTMeshoptCompression, KHRDracoMeshCompression} from '@gltf-transform/extensions';
import tiles from '@here/quantized-mesh-decoder';
import draco3d from 'draco3d';
import * as gltfpack from 'gltfpack';
import {MeshoptDecoder, MeshoptEncoder} from 'meshoptimizer';
import {BufferAttribute, BufferGeometry, Mesh} from 'three';
import {OBJExporter} from 'three/addons/exporters/OBJExporter.js';
import {startServer} from '../support/program.mjs';
import {assertSameMesh, sent} from './sending.mjs';

const EXTENT = 9000;  // metres, as the tile's bounding sphere has it

let server, tile;

/** {vertices, triangles}, z up, every number one that a float holds. */
function himalaya() {
  const main = createRequire(import.meta.url).resolve('@here/quantized-mesh-decoder');
  const bytes = readFileSync(join(dirname(main), '../src/assets/tile-with-extensions.terrain'));
  const {header, vertexData, triangleIndices} =
    tiles.default(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
  const count = vertexData.length / 3, highest = 32767;
  const vertices = Array.from({length: count}, (_, i) => {
    const [u, v, h] = [0, 1, 2].map((axis) => vertexData[axis * count + i] / highest);
    return [EXTENT * u, EXTENT * v, header.minHeight + h * (header.maxHeight - header.minHeight)].map(Math.fround);
  });
  const triangles = Array.from({length: triangleIndices.length / 3}, (_, t) => [...triangleIndices.slice(3 * t, 3 * t + 3)]);
  return {vertices, triangles};
}

before(async () => {
  server = await startServer();
  tile = himalaya();
  await MeshoptDecoder.ready;
  await MeshoptEncoder.ready;
});
after(() => server.stop());

/** The tile as a GLB, y up, by glTF-Transform; `prepare` adds an extension to the document. */
async function writtenByTransform(prepare = () => {}) {
  const document = new Document();
  const buffer = document.createBuffer();
  const accessor = (type, array) => document.createAccessor().setType(type).setArray(array).setBuffer(buffer);
  const primitive = document.createPrimitive()
    .setAttribute('POSITION', accessor('VEC3', new Float32Array(tile.vertices.flatMap(([x, y, z]) => [x, z, -y]))))
    .setIndices(accessor('SCALAR', new Uint16Array(tile.triangles.flat())));
  document.createScene().addChild(document.createNode().setMesh(document.createMesh().addPrimitive(primitive)));
  prepare(document);
  const io = new NodeIO().registerExtensions([KHRDracoMeshCompression, EXTMeshoptCompression]).registerDependencies({
    'draco3d.encoder': await draco3d.createEncoderModule(),
    'meshopt.decoder': MeshoptDecoder,
    'meshopt.encoder': MeshoptEncoder,
  });
  return io.writeBinary(document);
}

async function assertRead(bytes, tolerance, type = 'model/gltf-binary') {
  const {status, answer, mesh} = await sent(server, bytes, type);
  assert.equal(status, 201, JSON.stringify(answer));
  assertSameMesh(mesh, tile, tolerance);
}

test('the tile is what it is', () => {
  assert.equal(tile.vertices.length, 627);
  assert.equal(tile.triangles.length, 1175);
});

test("OBJ by three's OBJExporter, to the last bit", async () => {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(tile.vertices.flat()), 3));
  geometry.setIndex(new BufferAttribute(new Uint16Array(tile.triangles.flat()), 1));
  const text = new OBJExporter().parse(new Mesh(geometry));
  const {status, mesh} = await sent(server, text, 'model/obj');
  assert.equal(status, 201);
  assert.deepEqual(mesh.vertices, tile.vertices);
  assert.deepEqual(mesh.triangles, tile.triangles);
});

test('GLB by glTF-Transform, to the last bit', async () => {
  await assertRead(await writtenByTransform(), 0);
});

for (const [method, bits] of [['EDGEBREAKER', 16], ['EDGEBREAKER', 24], ['SEQUENTIAL', 16]]) {
  test(`GLB by glTF-Transform with Draco, ${method}, ${bits} bits`, async () => {
    const bytes = await writtenByTransform((document) =>
      document.createExtension(KHRDracoMeshCompression).setRequired(true).setEncoderOptions({
        method: KHRDracoMeshCompression.EncoderMethod[method],
        quantizationBits: {POSITION: bits},
      }));
    assert.ok(Buffer.from(bytes).includes('DRACO'));
    // Half a step of the grid, and two roundings of floats of this size.
    await assertRead(bytes, EXTENT / (2 ** bits - 1) / 2 + 0.002);
  });
}

test('GLB by glTF-Transform with meshoptimizer', async () => {
  const bytes = await writtenByTransform((document) => document.createExtension(EXTMeshoptCompression).setRequired(true)
    .setEncoderOptions({method: EXTMeshoptCompression.EncoderMethod.QUANTIZE}));
  assert.ok(Buffer.from(bytes).includes('EXT_meshopt_compression'));
  await assertRead(bytes, 0);
});

// Steps of the grid that 16 bits leave; floats lose bits in the transform of the node.
for (const [options, tolerance] of [[['-vp', '16'], 0.1], [['-vp', '16', '-c'], 0.1], [['-vp', '16', '-cc'], 0.1],
  [['-noq'], 0.001], [['-noq', '-c'], 0.001], [['-vp', '16', '-vpf', '-cc'], 0.2]]) {
  test(`GLB by gltfpack ${options.join(' ')}`, async () => {
    const files = {'in.glb': await writtenByTransform()};
    await gltfpack.pack(['-i', 'in.glb', '-o', 'out.glb', ...options],
        {read: (path) => files[path], write: (path, data) => { files[path] = Uint8Array.from(data); }});
    await assertRead(files['out.glb'], tolerance);
  });
}
