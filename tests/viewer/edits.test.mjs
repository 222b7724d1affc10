// SPDX-License-Identifier: Apache-2.0
// Edits of the ground inside a region, one of each kind that the form offers: what is there by the
// interface, what is on the canvas, and what the report says of it.

import assert from 'node:assert/strict';
import {ask} from '../support/program.mjs';
import {assertSameMesh, button, REFUSED, SQUARE, stand, viewTest} from './stand.mjs';

// Well inside of the square, close to its border, and outside of it.
const INSIDE = [[190, 180], [150, 210], [225, 150]];
const OUTSIDE = [[60, 60], [190, 300], [340, 180], [190, 75]];

async function elevations(id, points) {
  const answer = await stand.client.json(`/v1/sessions/${id}/elevation`, {method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify({points})});
  return answer.points.map(({elevation}) => elevation);
}
const near = (got, wanted, within, what) => got.forEach((z, i) => assert.ok(Math.abs(z - wanted[i]) <= within, `${what} ${i}: ${z}, not ${wanted[i]}`));

/** Opens the form on the only region; `fill` sets its fields. */
async function openForm(view, fill) {
  await view.page.locator('#tab-regions').click();
  await view.page.locator('.regions button').first().click();
  await fill(view.page.locator('#body-regions'));
}

/** Dry run, then the edit: the same figures, the next version, another canvas. */
async function dryThenApply(view, id) {
  const before = await view.pixels();
  await view.page.locator('#edit-dry').click();
  const form = view.page.locator('#body-regions');
  await form.getByText('Dry run: nothing is changed yet').waitFor();
  await view.rest();
  assert.equal((await stand.client.session(id)).version, 2);
  assert.equal(await view.pixels(), before, 'a dry run leaves the canvas alone');
  const promised = await view.state(() => window.tinsmith.edit.promised);
  await view.page.locator('#edit-apply').click();
  await form.getByText('Done: version 3').waitFor();
  await view.rest();
  assert.equal((await stand.client.session(id)).version, 3);
  const report = await stand.client.json(`/v1/sessions/${id}/history/3`);
  for (const name of ['operation', 'cut', 'fill', 'vertices_moved', 'vertices_added', 'triangles_added', 'max_elevation_change']) {
    assert.equal(report[name], promised[name], name);
  }
  assert.notEqual(await view.pixels(), before, 'the canvas shows it');
  await assertSameMesh(view, id);
  const table = await form.locator('.figures', {hasText: 'Done: version 3'}).textContent();
  assert.match(table, new RegExp(`Vertices moved${report.vertices_moved.toLocaleString('en')}${report.vertices_moved.toLocaleString('en')}`));
  return report;
}

viewTest('sets a plane of three points', {polygon: SQUARE}, async (view, id) => {
  const outside = await elevations(id, OUTSIDE);
  await openForm(view, async (form) => {
    await form.locator('.field', {hasText: 'a plane of three points'}).locator('select').selectOption('plane');
    await form.getByRole('textbox', {name: 'Points'}).fill('120, 120, 130\n260 120 133\n120,250,126');
    await form.getByLabel('Width').fill('4');
  });
  const report = await dryThenApply(view, id);
  assert.deepEqual([report.operation, report.rim], ['set', 4]);
  assert.ok(report.fill > 0);
  near(await elevations(id, INSIDE), INSIDE.map(([x, y]) => 130 + ((x - 120) * 3) / 140 - ((y - 120) * 4) / 130), 1e-9, 'on the plane');
  assert.deepEqual(await elevations(id, OUTSIDE), outside);
  assert.match(await view.page.locator('#calls code').first().textContent(), /"plane":\[\[120,120,130\],\[260,120,133\],\[120,250,126\]\],"rim":4/);
});

viewTest('sets a slope', {polygon: SQUARE}, async (view, id) => {
  const outside = await elevations(id, OUTSIDE);
  await openForm(view, async (form) => {
    await form.locator('.field', {hasText: 'a plane of three points'}).locator('select').selectOption('slope');
    await form.getByRole('textbox', {name: 'Slope'}).fill('0.05');
    await form.getByLabel('Azimuth').fill('90');
    await form.getByLabel('Through').fill('190, 180, 125');
    await form.getByLabel('Border').first().selectOption('new');
    assert.equal(await form.getByLabel('Width').isVisible(), false, 'a border that moves has no strip');
  });
  await dryThenApply(view, id);
  near(await elevations(id, INSIDE), INSIDE.map(([x]) => 125 + 0.05 * (x - 190)), 1e-9, 'rises to the east');
  // The border's corners move along: to the last of them.
  near(await elevations(id, SQUARE.coordinates[0]), SQUARE.coordinates[0].map(([x]) => 125 + 0.05 * (x - 190)), 1e-9, 'corner');
  assert.deepEqual(await elevations(id, OUTSIDE), outside);
});

viewTest('raises with a taper', {polygon: SQUARE}, async (view, id) => {
  const away = [[60, 60], [190, 300], [340, 180], [190, 60]];
  const [was, far] = [await elevations(id, INSIDE), await elevations(id, away)];
  const between = [[190, 105], [275, 180]];
  const climbing = await elevations(id, between);
  await openForm(view, async (form) => {
    await form.locator('#operation').selectOption('offset');
    await form.locator('.field', {hasText: 'below 0 lowers'}).locator('input').fill('6');
    await form.getByLabel('Border').first().selectOption('taper');
    await form.getByLabel('Width').fill('30');
  });
  const report = await dryThenApply(view, id);
  assert.equal(report.taper, 30);
  assert.equal(report.max_elevation_change, 6);
  assert.ok(report.vertices_added > 0, 'the ring of the taper');
  near(await elevations(id, INSIDE), was.map((z) => z + 6), 1e-9, 'raised');
  (await elevations(id, between)).forEach((z, i) => assert.ok(z > climbing[i] + 0.5 && z < climbing[i] + 5.5, `between: ${z - climbing[i]}`));
  assert.deepEqual(await elevations(id, away), far);
});

viewTest('smooths', {polygon: SQUARE, terrain: {name: 'Rough', unit: 'metre', grid: {origin: [0, 0], cell: [10, 10], columns: 41, rows: 41,
  elevations: Array.from({length: 41 * 41}, (_, i) => 100 + ((i * 7919) % 23))}}}, async (view, id) => {
  const border = SQUARE.coordinates[0];
  const [edge, outside] = [await elevations(id, border), await elevations(id, OUTSIDE)];
  const roughness = async () => {
    const {vertices} = await stand.client.json(`/v1/sessions/${id}/mesh.json?bbox=150,150,220,220`);
    const heights = vertices.filter(([x, y]) => x > 145 && x < 225 && y > 145 && y < 225).map(([, , z]) => z);
    const mean = heights.reduce((sum, z) => sum + z, 0) / heights.length;
    return Math.sqrt(heights.reduce((sum, z) => sum + (z - mean) ** 2, 0) / heights.length);
  };
  const before = await roughness();
  await openForm(view, async (form) => {
    await form.locator('#operation').selectOption('smooth');
    await form.getByLabel('Passes').fill('4');
    assert.equal(await form.getByLabel('Width').isVisible(), false);
  });
  const report = await dryThenApply(view, id);
  assert.deepEqual([report.operation, report.border, report.vertices_added], ['smooth', 'old', 0]);
  assert.ok((await roughness()) < before / 2, `${await roughness()} of ${before}`);
  assert.deepEqual(await elevations(id, border), edge, 'the border stays');
  assert.deepEqual(await elevations(id, OUTSIDE), outside);
  await view.page.locator('#body-regions').getByLabel('Border').last().selectOption('new');
  await view.page.locator('#edit-apply').click();
  await view.page.locator('#body-regions').getByText('Done: version 4').waitFor();
  await view.rest();
  assert.equal((await stand.client.json(`/v1/sessions/${id}/history/4`)).border, 'new');
  assert.notDeepEqual(await elevations(id, border), edge, 'now the border, too');
  await assertSameMesh(view, id);
});

viewTest('takes an empty field for no number', {polygon: SQUARE, expected: REFUSED}, async (view, id) => {
  await openForm(view, async (form) => {
    await form.locator('#level').fill('120');
    await view.page.locator('#edit-dry').click();
    await form.getByText('Dry run: nothing is changed yet').waitFor();
    await form.locator('#level').fill('');
    await form.getByText('Dry run: nothing is changed yet').waitFor({state: 'detached'});
  });
  await view.page.locator('#edit-apply').click();
  await view.page.getByRole('alert').getByText('/elevation').waitFor();
  assert.equal((await stand.client.session(id)).version, 2, 'the ground is not set to 0');
  await button(view, 'Dismiss').click();
  await view.page.locator('#operation').selectOption('set');
  await view.page.locator('#body-regions .field', {hasText: 'a plane of three points'}).locator('select').selectOption('plane');
  await view.page.locator('#body-regions').getByRole('textbox', {name: 'Points'}).fill('1, 2, 3\n4, 5, 6');
  await view.page.locator('#edit-apply').click();
  await view.page.getByRole('alert').getByText('/plane').first().waitFor();
  assert.equal((await (await ask(`${stand.server.origin}/v1/sessions/${id}`)).json()).version, 2);
});
