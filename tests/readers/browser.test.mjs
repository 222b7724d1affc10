// SPDX-License-Identifier: Apache-2.0
// three and CesiumJS in a real browser, drawing in software: what the real server sends is served to
// their pages from this process, with nothing from elsewhere.

import assert from 'node:assert/strict';
import {existsSync} from 'node:fs';
import {after, before, test} from 'node:test';
import puppeteer from 'puppeteer-core';
import {startServer} from '../support/program.mjs';
import {servePages} from './pages.mjs';
import {assertPositions, COMPRESSIONS, makeTerrain, sharesOf} from './terrain.mjs';

const chromium = process.env.CHROMIUM ?? ['/usr/bin/chromium', '/usr/bin/google-chrome'].find(existsSync);
let server, terrain, pages, browser;

before(async () => {
  server = await startServer();
  terrain = await makeTerrain(server);
  const files = {};
  for (const compression of COMPRESSIONS)
    files[`/${compression}.glb`] = await terrain.bytes(`/mesh.glb?compression=${compression}&regions=true`);
  files['/terrain.xml'] = await terrain.bytes('/mesh.xml');
  files['/draco.gltf'] = await terrain.bytes('/mesh.gltf?regions=true');
  pages = await servePages(files);
  browser = await puppeteer.launch({
    executablePath: chromium,
    headless: true,
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'],
  });
});
after(async () => {
  await browser?.close();
  await pages?.close();
  await server.stop();
});

/** What the page's function makes of the file; nothing may be asked of another host, nothing go wrong. */
async function ask(path, ...words) {
  const page = await browser.newPage();
  const complaints = [];
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('request', (request) => {
    const {protocol, origin} = new URL(request.url());
    if (protocol === 'http:' || protocol === 'https:') assert.equal(origin, pages.origin, request.url());
  });
  try {
    await page.goto(pages.origin + path);
    await page.waitForFunction('window.read', {timeout: 60_000});
    const answer = await page.evaluate((...given) => window.read(...given), ...words);
    assert.deepEqual(complaints, []);
    return answer;
  } finally {
    await page.close();
  }
}

for (const file of [...COMPRESSIONS.map((compression) => `/${compression}.glb`), '/draco.gltf']) {
  test(`three reads and draws ${file}`, {timeout: 90_000}, async () => {
    const {primitives, drawn} = await ask('/three.html', file);
    const meshes = primitives.filter(({isLines}) => !isLines);
    const shares = Object.fromEntries(meshes.map(({polygons, triangles}) => [polygons.join(' '), triangles]));
    assert.deepEqual(shares, sharesOf(terrain));
    const rows = {'': [3], p1: [0], p2: [1], 'p1 p2': [1], p3: [2]};
    for (const {polygons, features} of meshes) assert.deepEqual(features, rows[polygons.join(' ')]);
    assertPositions(meshes.flatMap(({places}) => places.map(([x, y, z]) => [x, -z, y])), terrain.mesh);
    assert.equal(primitives.length - meshes.length, 1, 'the lines');
    assert.ok(drawn > 0.5, `${drawn} of the picture is terrain`);
  });
}

for (const file of COMPRESSIONS.map((compression) => `/${compression}.glb`)) {
  test(`Cesium reads the features of ${file}`, {timeout: 120_000}, async () => {
    const [x0, y0] = terrain.mesh.vertices[0];
    const spots = {
      'in p1': [200, 200], 'in p1 and p2': [300, 316], 'in p2': [800, 316], 'in p3': [1100, 800],
      'on the ground': [800, 600],
    };
    const places = Object.values(spots).map(([x, y]) => [x0 + x, y0 + y, 411.3]);
    const centre = [x0 + 700, y0 + 600, 411.3];
    const {triangles, rows, picked} = await ask('/cesium.html', file, centre, places);
    assert.equal(triangles, terrain.mesh.triangles.length);
    const areas = terrain.regions.map(({plan_area}) => plan_area);
    assert.deepEqual(rows, [
      {id: 'p1', name: 'Meadow', plan_area: areas[0], floors: 0, owner: 'Ada'},
      {id: 'p2', name: 'Road', plan_area: areas[1], floors: 1.5, owner: '7'},
      {id: 'p3', name: 'p3', plan_area: areas[2], floors: -2, owner: undefined},
    ].map((row) => JSON.parse(JSON.stringify(row))));
    assert.deepEqual(Object.fromEntries(Object.keys(spots).map((spot, i) => [spot, picked[i]])), {
      'in p1': 'p1', 'in p1 and p2': 'p2', 'in p2': 'p2', 'in p3': 'p3', 'on the ground': null,
    });
  });
}

test("the browser's parser of XML reads the LandXML", {timeout: 60_000}, async () => {
  const {fault, top, epsg, unit, points, faces, breaklines} = await ask('/xml.html', '/terrain.xml');
  assert.equal(fault, null);
  assert.deepEqual(top, ['Units', 'CoordinateSystem', 'Project', 'Application', 'Surfaces']);
  assert.deepEqual({epsg, unit}, {epsg: '32616', unit: 'meter'});
  assert.deepEqual(points.map(([n, e, z]) => [e, n, z]), terrain.mesh.vertices);
  assert.deepEqual(faces.map((ids) => ids.map((id) => id - 1)), terrain.mesh.triangles);
  const {features} = await terrain.json('/constraints');
  const edges = features.reduce((sum, {geometry}) => sum + geometry.coordinates.length - 1, 0);
  assert.equal(breaklines.reduce((sum, points) => sum + points - 1, 0), edges);
});
