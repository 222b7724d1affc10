// SPDX-License-Identifier: Apache-2.0
// GDAL reads the GeoJSON of regions and constraints: system, geometry types, fields, sound polygons.

import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {startServer} from '../support/program.mjs';
import {makeTerrain} from './terrain.mjs';

let server, terrain, folder;

before(async () => {
  server = await startServer();
  terrain = await makeTerrain(server);
  folder = mkdtempSync(join(tmpdir(), 'tinsmith-gis-'));
});
after(async () => {
  rmSync(folder, {recursive: true});
  await server.stop();
});

async function fetched(path) {
  const file = join(folder, `${path.replaceAll('/', '')}.geojson`);
  writeFileSync(file, await terrain.bytes(path, {headers: {Accept: 'application/geo+json'}}));
  return file;
}
const ogrinfo = (...words) => execFileSync('ogrinfo', ['-ro', ...words], {encoding: 'utf8'});

test('ogrinfo reads the regions', async () => {
  const file = await fetched('/regions');
  const said = ogrinfo('-al', file);
  assert.match(said, /Geometry: 3D Multi Polygon/);
  assert.match(said, /Feature Count: 3/);
  assert.match(said, /ID\["EPSG",32616\]/);
  assert.match(said, /plan_area: Real/);
  assert.match(said, /triangles: Integer/);
  assert.match(said, /name \(String\) = Meadow/);
  assert.match(said, /floors: Real/);
  const asked = ogrinfo('-dialect', 'SQLite', '-sql',
      `SELECT id, name, plan_area, ST_Area(geometry) AS area, ST_IsValid(geometry) AS sound FROM regions`, file);
  for (const {polygon, plan_area} of terrain.regions) {
    const [, area] = asked.match(new RegExp(`id \\(String\\) = ${polygon}\\n[^]*?area \\(Real\\) = [^\\n]*\\n *area \\(Real\\) = (\\S+)`));
    assert.ok(Math.abs(Number(area) - plan_area) < 1e-6 * plan_area, `${polygon}: ${area}`);
  }
  assert.equal(asked.match(/sound \(Integer\) = 1/g).length, 3);
});

test('ogrinfo reads the constraints', async () => {
  const file = await fetched('/constraints');
  const said = ogrinfo('-al', file);
  assert.match(said, /Geometry: 3D Line String/);
  assert.match(said, /ID\["EPSG",32616\]/);
  assert.match(said, /polygons: StringList/);
  // Every constrained edge is in one line, once: as many as the mesh has as LINES.
  const {features} = await terrain.json('/constraints');
  const edges = features.reduce((sum, {geometry}) => sum + geometry.coordinates.length - 1, 0);
  const gltf = await terrain.json('/mesh.gltf?compression=none');
  const lines = gltf.meshes[0].primitives.find(({mode}) => mode === 1);
  assert.equal(edges, gltf.accessors[lines.indices].count / 2);
  assert.deepEqual([...new Set(features.flatMap(({properties}) => properties.polygons))].sort(), ['p1', 'p2', 'p3']);
  const total = Number(ogrinfo('-dialect', 'SQLite', '-sql', 'SELECT SUM(ST_Length(geometry)) AS total FROM constraints', file)
      .match(/total \(Real\) = (\S+)/)[1]);
  const length = features.reduce((sum, {properties}) => sum + properties.length, 0);
  assert.ok(Math.abs(total - length) < 1e-6 * length);
});
