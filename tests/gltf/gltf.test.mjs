// SPDX-License-Identifier: Apache-2.0
// Every kind of file that the writer makes, read by other people's code; and the checks themselves
// against planted faults. Needs TINSMITH, the built program's path: the sample writer is beside it.

import assert from 'node:assert/strict';
import {execFileSync, spawnSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {dirname, join} from 'node:path';
import {after, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {checkGlb} from './check_glb.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const build = dirname(process.env.TINSMITH ?? join(here, '../../build/release/tinsmith'));
const folder = mkdtempSync(join(tmpdir(), 'tinsmith-gltf-'));
after(() => rmSync(folder, {recursive: true}));

const samples = execFileSync(join(build, 'tests/gltf/gltf_samples'), [folder], {encoding: 'utf8'})
    .trim().split('\n').map((line) => line.split(' '));
const glb = (name) => readFileSync(join(folder, `${name}.glb`));
const mesh = (name) => JSON.parse(readFileSync(join(folder, `${name}.json`), 'utf8'));

for (const [name, tolerance, unit] of samples) {
  test(`${name} is valid and holds its mesh`, async () => {
    const found = await checkGlb(glb(name), {mesh: mesh(name), tolerance: Number(tolerance), unit: Number(unit)});
    assert.match(found, /0 validator warnings/);
  });
}

test('a vertex off by more than the tolerance is found', async () => {
  const moved = mesh('draco');
  moved.vertices[1234][2] += 0.01;
  await assert.rejects(checkGlb(glb('draco'), {mesh: moved}), /no vertex of the mesh within/);
});

test('a triangle turned over is found', async () => {
  const turned = mesh('plain');
  turned.triangles[77].reverse();
  await assert.rejects(checkGlb(glb('plain'), {mesh: turned}), /turns the other way/);
});

test('a missing triangle is found', async () => {
  const more = mesh('draco');
  more.triangles.push(more.triangles[0]);
  await assert.rejects(checkGlb(glb('draco'), {mesh: more}), /7200 triangles, the mesh has 7201/);
});

test('a file cut short is found', async () => {
  await assert.rejects(checkGlb(glb('draco').subarray(0, -4)), /validator errors/);
});

test('the command says so and exits 1', () => {
  const run = (...words) => spawnSync(process.execPath, [join(here, 'check_glb.mjs'), ...words], {encoding: 'utf8'});
  const good = run(join(folder, 'draco.glb'), join(folder, 'draco.json'), '--tolerance', '0.005');
  assert.equal(good.status, 0);
  assert.match(good.stdout, /^ok .*: 7200 triangles in 1 primitives, 1 with Draco, 60 lines, .*largest error 0\.0039\d* m\n$/);
  const bad = run(join(folder, 'draco.glb'), join(folder, 'draco.json'), '--tolerance', '0.003');
  assert.equal(bad.status, 1);
  assert.match(bad.stdout, /^FAILED /);
});

test('Draco keeps as many position bits as the writer counts on', () => {
  const bits = spawnSync(process.execPath, [join(here, 'decoder_bits.mjs')], {encoding: 'utf8'});
  assert.equal(bits.status, 0, bits.stdout);
});
