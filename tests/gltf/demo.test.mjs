// SPDX-License-Identifier: Apache-2.0
// The demo as a client of the real server gets it: a bundled polygon cut into the demo session, and
// its GLB, with Draco and without, read by other people's code and held against the session's own
// mesh. Needs TINSMITH, the built program's path.

import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {once} from 'node:events';
import {existsSync, mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {dirname, join} from 'node:path';
import {after, before, test} from 'node:test';
import {setTimeout} from 'node:timers/promises';
import {fileURLToPath} from 'node:url';
import {checkGlb} from './check_glb.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const program = process.env.TINSMITH ?? join(here, '../../build/release/tinsmith');
const folder = mkdtempSync(join(tmpdir(), 'tinsmith-demo-'));
const session = (port) => `http://127.0.0.1:${port}/v1/sessions/demo`;
let server, url;

before(async () => {
  const portFile = join(folder, 'port');
  server = spawn(program, ['serve', '--demo', '--port', '0', '--port-file', portFile], {stdio: 'ignore'});
  // The file appears whole or not at all, and the server listens by then.
  for (let tries = 0; !existsSync(portFile); ++tries) {
    assert.ok(tries < 600 && server.exitCode === null, 'the server did not start');
    await setTimeout(50);
  }
  url = session(readFileSync(portFile, 'utf8').trim());
});

after(async () => {
  server.kill('SIGTERM');
  const [code] = server.exitCode === null ? await once(server, 'exit') : [server.exitCode];
  rmSync(folder, {recursive: true});
  assert.equal(code, 0);
});

async function ask(path, options) {
  const answer = await fetch(url + path, options);
  assert.equal(answer.status, 200, `${path}: ${answer.status}`);
  return answer;
}

for (const polygon of ['lake', 'road', 'contour_3500']) {
  test(`the demo with its ${polygon} is valid and holds the session's mesh`, async () => {
    const body = readFileSync(join(here, `../data/${polygon}.geojson`));
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
