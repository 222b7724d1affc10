// SPDX-License-Identifier: Apache-2.0
// Terrains on their way to the server, and glTF taken apart and put together on the way.

import assert from 'node:assert/strict';
import {ask} from '../support/program.mjs';

/** {status, answer, mesh}: what became of the bytes, and of a session the mesh as it was read. */
export async function sent(server, body, type, query = '') {
  const made = await ask(`${server.origin}/v1/sessions${query}`, {method: 'POST', body, headers: {'Content-Type': type}});
  const answer = await made.json();
  if (made.status !== 201) return {status: made.status, answer};
  const session = `${server.origin}/v1/sessions/${answer.id}`;
  const mesh = await (await ask(`${session}/mesh.json`)).json();
  assert.equal((await ask(session, {method: 'DELETE'})).status, 200);
  return {status: made.status, answer, mesh};
}

const padded = (bytes, filling) => Buffer.concat([bytes, Buffer.alloc((4 - bytes.length % 4) % 4, filling)]);

/** A GLB of a document and the bytes of its only buffer. */
export function glbOf(document, bytes) {
  const chunk = (kind, content) => {
    const head = Buffer.alloc(8);
    head.writeUInt32LE(content.length, 0);
    head.write(kind, 4, 'latin1');
    return Buffer.concat([head, content]);
  };
  const chunks = Buffer.concat([
    chunk('JSON', padded(Buffer.from(JSON.stringify(document)), 32)), chunk('BIN\0', padded(bytes, 0)),
  ]);
  const head = Buffer.alloc(12);
  head.write('glTF', 'latin1');
  head.writeUInt32LE(2, 4);
  head.writeUInt32LE(12 + chunks.length, 8);
  return Buffer.concat([head, chunks]);
}

/** The document with the bytes of its buffers in data: URIs, since the server fetches nothing. */
export function inlined(document, bytesOf) {
  const buffers = document.buffers.map(({uri, ...rest}) =>
    ({...rest, uri: uri.startsWith('data:') ? uri : `data:application/octet-stream;base64,${bytesOf(uri).toString('base64')}`}));
  return {...document, buffers};
}

/**
 * The mesh has the same triangles as `wanted`, {vertices, triangles}, whatever the order of both:
 * each vertex lies within the tolerance of one of those, and no other does.
 */
export function assertSameMesh(mesh, wanted, tolerance) {
  assert.equal(mesh.vertices.length, wanted.vertices.length);
  const named = mesh.vertices.map((p) => {
    const near = wanted.vertices.flatMap((q, i) => q.every((value, axis) => Math.abs(value - p[axis]) <= tolerance) ? [i] : []);
    assert.equal(near.length, 1, `one vertex within ${tolerance} of ${p}, not ${near.length}`);
    return near[0];
  });
  assert.equal(new Set(named).size, named.length);
  const sorted = (triangles) => triangles.map(([a, b, c]) =>
    a < b && a < c ? `${a} ${b} ${c}` : b < c ? `${b} ${c} ${a}` : `${c} ${a} ${b}`).sort();
  assert.deepEqual(sorted(mesh.triangles.map((t) => t.map((v) => named[v]))), sorted(wanted.triangles));
}
