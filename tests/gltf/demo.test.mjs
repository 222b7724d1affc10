// SPDX-License-Identifier: Apache-2.0
// The demo as a client of the real server gets it: a bundled polygon cut into the demo session, and
// its GLB, with Draco and without, read by other people's code and held against the session's own
// mesh. Needs TINSMITH, the built program's path.

import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {ask as send, project, startServer} from '../support/program.mjs';
import {checkGlb} from './check_glb.mjs';

let server, url;

before(async () => {
  server = await startServer('--demo');
  url = `${server.origin}/v1/sessions/demo`;
});
after(() => server.stop());

async function ask(path, options) {
  const answer = await send(url + path, options);
  assert.equal(answer.status, 200, `${path}: ${answer.status}`);
  return answer;
}

for (const polygon of ['lake', 'road', 'contour_3500']) {
  test(`the demo with its ${polygon} is valid and holds the session's mesh`, async () => {
    const body = readFileSync(join(project, `tests/data/${polygon}.geojson`));
    const headers = {'Content-Type': 'application/geo+json', 'Accept': 'model/gltf-binary'};
    const first = await ask('/polygons', {method: 'POST', headers, body});
    const mesh = await (await ask('/mesh.json')).json();
    assert.equal(mesh.triangles.length, (await (await ask('')).json()).triangles);
    const direct = Buffer.from(await first.arrayBuffer());
    assert.match(await checkGlb(direct, {mesh, tolerance: 0.005}), / 1 with Draco, .* 0 validator warnings/);
    const again = Buffer.from(await (await ask('/mesh.glb')).arrayBuffer());
    assert.ok(direct.equals(again), 'the answer to the edit is the mesh as GET sends it');
  });
}

test('the plain file holds the same mesh', async () => {
  const mesh = await (await ask('/mesh.json')).json();
  const plain = Buffer.from(await (await ask('/mesh.glb?compression=none')).arrayBuffer());
  assert.match(await checkGlb(plain, {mesh, tolerance: 0.005}), / 0 with Draco, .* 0 validator warnings/);
});
