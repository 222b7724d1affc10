// SPDX-License-Identifier: Apache-2.0
// Models that others made, as Debian ships them for the tests of Assimp (see fetch_models.sh), and
// the rabbit of Draco: what is a surface is read as other readers read it, what is none or is broken
// is refused by code and place.

import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {after, before, test} from 'node:test';
import {NodeIO} from '@gltf-transform/core';
import {KHRDracoMeshCompression} from '@gltf-transform/extensions';
import draco3d from 'draco3d';
import {startServer} from '../support/program.mjs';
import {assertSameMesh, glbOf, inlined, sent} from './sending.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const models = join(tmpdir(), 'tinsmith-models');
const GLB = 'model/gltf-binary', GLTF = 'model/gltf+json', OBJ = 'model/obj';

let server, io;

before(async () => {
  execFileSync('bash', [join(here, 'fetch_models.sh'), models], {stdio: ['ignore', 'ignore', 'inherit']});
  server = await startServer();
  io = new NodeIO().registerExtensions([KHRDracoMeshCompression])
    .registerDependencies({'draco3d.decoder': await draco3d.createDecoderModule()});
});
after(() => server.stop());

const bytesOf = (path) => readFileSync(join(models, path));
const documentOf = (path) => JSON.parse(bytesOf(path));

/** The engine of two cylinders that Khronos ships, 34 primitives by COLLADA2GLTF, as one GLB. */
function packedEngine() {
  const document = documentOf('glTF2/draco/2CylinderEngine.gltf');
  delete document.buffers[0].uri;
  return {document, bytes: bytesOf('glTF2/draco/2CylinderEngine.bin')};
}

/** Indices by draco3d of each primitive, in the order of the file. */
async function decodedBy(glb) {
  const meshes = (await io.readBinary(new Uint8Array(glb))).getRoot().listMeshes();
  return meshes.flatMap((mesh) => mesh.listPrimitives()).map((primitive) => ({
    positions: primitive.getAttribute('POSITION').getArray(),
    indices: primitive.getIndices().getArray(),
  }));
}

test('a real GLB with Draco: its one primitive that is a surface is as draco3d decodes it', async () => {
  const {document, bytes} = packedEngine();
  const {positions, indices} = (await decodedBy(glbOf(document, bytes))).at(-1);
  assert.equal(indices.length / 3, 721);
  // It looks along z, so it is laid on its back: a quarter turn about x.
  const {attributes, indices: accessor, extensions} = document.meshes.at(-1).primitives.at(-1);
  const one = {
    ...document, scene: 0, scenes: [{nodes: [0]}], nodes: [{mesh: 0, rotation: [Math.SQRT1_2, 0, 0, Math.SQRT1_2]}],
    meshes: [{primitives: [{attributes, indices: accessor, extensions, mode: 4}]}],
  };
  const {status, answer, mesh} = await sent(server, glbOf(one, bytes), GLB);
  assert.equal(status, 201, JSON.stringify(answer));
  // What draco3d has: vertices at one place are one, as they are for a terrain.
  const wanted = {vertices: [], triangles: []}, numbers = new Map();
  const corners = Array.from(indices, (i) => {
    const [x, y, z] = positions.slice(3 * i, 3 * i + 3);
    const key = `${x} ${y} ${z}`;
    // The turn makes (x, -z, y) of it, and z up makes (x, -y, -z) of that.
    if (!numbers.has(key)) numbers.set(key, wanted.vertices.push([x, -y, -z]) - 1);
    return numbers.get(key);
  });
  for (let i = 0; i < corners.length; i += 3) wanted.triangles.push(corners.slice(i, i + 3));
  assertSameMesh(mesh, wanted, 1e-4);
});

test('all of it is no surface, and is refused so, decoded to the last triangle', async () => {
  const {document, bytes} = packedEngine();
  const glb = glbOf(document, bytes);
  const {status, answer} = await sent(server, glb, GLB);
  assert.equal(status, 422);
  assert.equal(answer.errors.length, 100);
  for (const {code, detail} of answer.errors) {
    assert.match(code, /^TRIANGLE_(CLOCKWISE|FLAT)$/);
    assert.match(detail, /\(triangle \d+ of \/meshes\/\d+\/primitives\/0\)$/);
  }
  // As many triangles as the file's nodes show by draco3d: one fewer than that is allowed is too few.
  const each = (await decodedBy(glb)).map(({indices}) => indices.length / 3);
  const first = document.meshes.map((_, i) =>
    document.meshes.slice(0, i).reduce((sum, {primitives}) => sum + primitives.length, 0));
  const total = document.nodes.filter(({mesh}) => mesh !== undefined).reduce((sum, {mesh}) =>
    sum + document.meshes[mesh].primitives.reduce((inner, _, i) => inner + each[first[mesh] + i], 0), 0);
  for (const [limit, wanted] of [[total, 422], [total - 1, 413]]) {
    const strict = await startServer('--max-triangles', `${limit}`);
    const told = await sent(strict, glb, GLB);
    await strict.stop();
    assert.equal(told.status, wanted, `${limit} triangles: ${JSON.stringify(told.answer).slice(0, 300)}`);
  }
});

test('the rabbit is of an old bitstream, which glTF does not have', async () => {
  const rabbit = readFileSync(join(dirname(createRequire(import.meta.url).resolve('draco3d')), 'bunny.drc'));
  const packing = {KHR_draco_mesh_compression: {bufferView: 0, attributes: {POSITION: 0}}};
  const document = {
    asset: {version: '2.0'}, scene: 0, scenes: [{nodes: [0]}], nodes: [{mesh: 0}],
    extensionsUsed: Object.keys(packing), extensionsRequired: Object.keys(packing),
    meshes: [{primitives: [{attributes: {POSITION: 0}, indices: 1, extensions: packing}]}],
    accessors: [{componentType: 5126, count: 34834, type: 'VEC3'}, {componentType: 5125, count: 208353, type: 'SCALAR'}],
    bufferViews: [{buffer: 0, byteLength: rabbit.length}], buffers: [{byteLength: rabbit.length}],
  };
  const {status, answer} = await sent(server, glbOf(document, rabbit), GLB);
  assert.equal(status, 422);
  assert.deepEqual(answer.errors, [{
    code: 'GLTF_DRACO', detail: 'It is of bitstream 1.1; glTF has 2.2.', pointer: '/meshes/0/primitives/0',
  }]);
});

// Khronos' generator: one square as a list, a strip and a fan, with and without indices of each size.
for (const number of ['04', '05', '06', '11', '12', '13', '14', '15']) {
  test(`a square of triangles, Mesh_PrimitiveMode_${number}`, async () => {
    const folder = 'glTF2/glTF-Asset-Generator/Mesh_PrimitiveMode/';
    const document = inlined(documentOf(`${folder}Mesh_PrimitiveMode_${number}.gltf`), (uri) => bytesOf(folder + uri));
    document.nodes[0].rotation = [-Math.SQRT1_2, 0, 0, Math.SQRT1_2];  // it stands upright
    const {status, answer, mesh} = await sent(server, JSON.stringify(document), GLTF);
    assert.equal(status, 201, JSON.stringify(answer));
    assert.equal(mesh.vertices.length, 4);
    assert.equal(mesh.triangles.length, 2);
  });
}

/** What each file is answered: the status, the codes that occur, and the first fault's place. */
const REFUSED = [
  ['OBJ/box.obj', OBJ, 422, 'TRIANGLE_FLAT TRIANGLE_CLOCKWISE', /\(line 23\)/],
  ['OBJ/box_UTF16BE.obj', OBJ, 400, 'OBJ_KEYWORD', /^Line 1:/],
  ['OBJ/concave_polygon.obj', OBJ, 422, 'TRIANGLE_FLAT', /\(line 77\)/],
  ['OBJ/number_formats.obj', OBJ, 422, 'OBJ_VERTEX COORDINATE_OUT_OF_RANGE', /^Line 11: "3.1\+e2" is no number/],
  ['OBJ/point_cloud.obj', OBJ, 422, 'OBJ_EMPTY', /no face/],
  ['OBJ/spider.obj', OBJ, 422, 'TRIANGLE_FLAT TRIANGLE_CLOCKWISE', /\(line 1833\)/],
  ['OBJ/testline.obj', OBJ, 422, 'OBJ_EMPTY', /no face/],
  ['invalid/empty.obj', OBJ, 422, 'OBJ_EMPTY', /no face/],
  ['invalid/malformed.obj', OBJ, 422, 'OBJ_INDEX OBJ_POLYGON', /^Line 23: "12" names a vertex that is not there: 8/],
  ['invalid/malformed2.obj', OBJ, 422, 'OBJ_FACE', /^Line 23:/],
  ['glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb', GLB, 422, 'TRIANGLE_CLOCKWISE TRIANGLE_FLAT', /\/meshes\/23\/primitives\/0/],
  ['glTF2/BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb', GLB, 422, 'COORDINATE_OUT_OF_RANGE', /^Vertex 0 .*not finite/],
  ['glTF2/MissingBin/BoxTextured.gltf', GLTF, 422, 'GLTF_URI', /"BoxTextured0.bin": nothing is fetched/],
  ['glTF2/RecursiveNodes/RecursiveNodes.gltf', GLTF, 422, 'GLTF_INVALID', /^Nodes are no tree/],
  ['glTF2/BoxTextured-glTF-techniqueWebGL/BoxTextured.gltf', GLTF, 422, 'GLTF_EXTENSION GLTF_URI', /"KHR_technique_webgl"/],
  ['glTF2/TestNoRootNode/NoScene.gltf', GLTF, 422, 'GLTF_INVALID', /no triangle/],
];
for (const [path, type, status, codes, place] of REFUSED) {
  test(`${path} is refused`, async () => {
    const {status: got, answer} = await sent(server, bytesOf(path), type);
    assert.equal(got, status);
    assert.equal([...new Set(answer.errors.map(({code}) => code))].join(' '), codes);
    assert.match(answer.errors[0].detail, place);
  });
}

// Those with their bytes beside them, put into one file.
const INLINED = [
  ['glTF2/IndexOutOfRange/', 'IndexOutOfRange.gltf', '/meshes/0/primitives/0/indices', /Index 0 names vertex 255; there are 24/],
  ['glTF2/IndexOutOfRange/', 'AllIndicesOutOfRange.gltf', '/meshes/0/primitives/0/indices', /Index 0 names vertex 65535; there are 24/],
  ['glTF2/IncorrectVertexArrays/', 'Cube.gltf', '/meshes/1/primitives/0/indices', /35 indices are no multiple of 3/],
  ['glTF2/wrongTypes/', 'badArray.gltf', '/meshes/0/primitives', /A list belongs here/],
];
for (const [folder, name, pointer, place] of INLINED) {
  test(`${folder}${name} is refused`, async () => {
    const document = inlined(documentOf(folder + name), (uri) => bytesOf(folder + uri));
    const {status, answer} = await sent(server, JSON.stringify(document), GLTF);
    assert.equal(status, 422);
    assert.equal(answer.errors[0].code, 'GLTF_INVALID');
    assert.equal(answer.errors[0].pointer, pointer);
    assert.match(answer.errors[0].detail, place);
  });
}
