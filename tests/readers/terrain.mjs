// SPDX-License-Identifier: Apache-2.0
// The terrain that other people's programs are given: hills with parcels, two of which overlap.

import assert from 'node:assert/strict';
import {ask} from '../support/program.mjs';

export const COLUMNS = 60, ROWS = 50, CELL = 25;
const origin = [702113.25, 4029551.5];
const height = (i, j) => 411.3 + 30 * Math.sin(i / 9) * Math.cos(j / 7);

const rectangle = (x0, y0, x1, y1) =>
    [[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]].map(([x, y]) => [origin[0] + x, origin[1] + y]);
const feature = (properties, ...ring) =>
    ({type: 'Feature', properties, geometry: {type: 'Polygon', coordinates: [rectangle(...ring)]}});

/** In the order of their ids, p1 first; p2 lies across p1, p3 by itself. */
export const PARCELS = {
  type: 'FeatureCollection',
  features: [
    feature({name: 'Meadow', floors: 0, owner: 'Ada'}, 110, 120, 610, 530),
    feature({name: 'Road', floors: 1.5, owner: 7}, 50, 300, 900, 333),
    feature({floors: -2}, 1000, 700, 1200, 900),
  ],
};

async function asked(url, options) {
  const answer = await ask(url, options);
  assert.ok(answer.ok, `${url}: ${answer.status} ${answer.ok ? '' : await answer.text()}`);
  return answer;
}

/** A session of the server: {url, mesh, regions, bytes(path), json(path)}. */
export async function makeTerrain(server) {
  const elevations = [];
  for (let j = 0; j < ROWS; ++j) for (let i = 0; i < COLUMNS; ++i) elevations.push(height(i, j));
  const url = `${server.origin}/v1/sessions/hills`;
  const body = (value) => ({body: JSON.stringify(value), headers: {'Content-Type': 'application/json'}});
  const grid = {origin, cell: [CELL, CELL], columns: COLUMNS, rows: ROWS, elevations};
  await asked(url, {method: 'PUT', ...body({name: 'Hills', crs: 'EPSG:32616', grid})});
  await asked(`${url}/polygons`, {method: 'POST', ...body(PARCELS)});
  const json = async (path) => (await asked(url + path)).json();
  return {
    url,
    json,
    bytes: async (path, options) => new Uint8Array(await (await asked(url + path, options)).arrayBuffer()),
    mesh: await json('/mesh.json'),
    regions: (await json('/regions')).regions,
  };
}

/** How many triangles each set of polygons contains: {'': n, 'p1': n, 'p1 p2': n}. */
export function sharesOf({mesh, regions}) {
  const around = mesh.triangles.map(() => []);
  for (const {polygon, triangles} of regions) for (const slot of triangles) around[slot].push(polygon);
  const shares = {};
  for (const ids of around) shares[ids.join(' ')] = (shares[ids.join(' ')] ?? 0) + 1;
  return shares;
}

/** Every corner of the triangles is a vertex of the mesh, within the tolerance, and each is met. */
export function assertPositions(places, {vertices}, tolerance = 0.005) {
  const cell = 0.05, cells = new Map();
  const key = (x, y) => `${Math.floor(x / cell)},${Math.floor(y / cell)}`;
  vertices.forEach(([x, y], i) => {
    // In each cell that a place within the tolerance can lie in.
    for (const dx of [-2 * tolerance, 2 * tolerance]) {
      for (const dy of [-2 * tolerance, 2 * tolerance]) {
        const at = key(x + dx, y + dy);
        if (!cells.has(at)) cells.set(at, new Set());
        cells.get(at).add(i);
      }
    }
  });
  const met = new Set();
  for (const [x, y, z] of places) {
    const found = [...cells.get(key(x, y)) ?? []].filter((i) =>
      Math.abs(vertices[i][0] - x) <= tolerance && Math.abs(vertices[i][1] - y) <= tolerance &&
      Math.abs(vertices[i][2] - z) <= tolerance);
    assert.ok(found.length > 0, `no vertex of the mesh at ${x}, ${y}, ${z}`);
    found.forEach((i) => met.add(i));
  }
  assert.equal(met.size, vertices.length, 'every vertex of the mesh is there');
}

export const COMPRESSIONS = ['draco', 'meshopt', 'none'];
