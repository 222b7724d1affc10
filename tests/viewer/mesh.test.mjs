// SPDX-License-Identifier: Apache-2.0
// What is seen of the mesh and told of it: angles, regions, cut and fill, before and after, and what is
// drawn where drawing all would take too long.

import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {join} from 'node:path';
import {ask, project} from '../support/program.mjs';
import {clickAt, openPage} from './browser.mjs';
import {button, drawSquare, integrate, SQUARE, stand, viewTest} from './stand.mjs';
import {test} from 'node:test';

viewTest('counts the smallest angles before and after', async (view, id) => {
  const before = await stand.client.session(id);
  await drawSquare(view);
  await integrate(view);
  const {before: was, after: is} = await view.state(() => window.tinsmith.draft.measured.angles);
  const {smallest_angle_deg: told} = (await stand.client.json(`/v1/sessions/${id}/history/2`)).polygons[0];
  assert.ok(Math.abs(was.least - told.before) < 1e-6 && Math.abs(is.least - told.after) < 1e-6, JSON.stringify([was.least, is.least, told]));
  for (const angles of [was, is]) assert.equal(angles.bars.reduce((sum, count) => sum + count, 0), angles.count);
  assert.equal(is.count - was.count, (await stand.client.session(id)).triangles - before.triangles);
  const bars = view.page.locator('#report .angles rect');
  assert.equal(await bars.count(), 24);
  const heights = await bars.evaluateAll((all) => all.map((bar) => Number(bar.getAttribute('height'))));
  assert.deepEqual(heights.map((height) => height > 0), was.bars.flatMap((count, i) => [count > 0, is.bars[i] > 0]));
  assert.match(await view.page.locator('#report .angles').textContent(), /before: \d+, least/);
});

viewTest('outlines the triangle under the cursor', {polygon: SQUARE}, async (view, id) => {
  await view.page.mouse.move(...(await view.spot(190, 180)));
  await view.page.waitForFunction(() => document.querySelector('#cursor .under').getAttribute('d'));
  const readout = await view.page.locator('#readout').textContent();
  assert.match(readout, /in.*p1/);
  const corners = await view.state(() => document.querySelector('#cursor .under').getAttribute('d').slice(1, -1).split('L').map((text) => text.split(' ').map(Number)));
  const triangle = Number(/triangle([\d,]+)/.exec(readout)[1].replaceAll(',', ''));
  const mesh = await stand.client.json(`/v1/sessions/${id}/mesh.json`);
  const frame = await view.page.locator('#view').boundingBox();
  for (const [i, vertex] of mesh.triangles[triangle].entries()) {
    const [x, y] = await view.spot(...mesh.vertices[vertex]);
    assert.ok(Math.hypot(corners[i][0] + frame.x - x, corners[i][1] + frame.y - y) < 1.5);
  }
  await view.page.mouse.move(20, 400);
  await view.page.waitForFunction(() => !document.querySelector('#cursor .under').getAttribute('d'));
});

viewTest('tells regions apart by label and pattern', {polygon: {type: 'FeatureCollection', features: [
  {type: 'Feature', properties: {name: 'yard'}, geometry: SQUARE},
  {type: 'Feature', properties: {}, geometry: {type: 'Polygon', coordinates: [[[280, 280], [360, 280], [360, 360], [280, 280]]]}}]}}, async (view) => {
  assert.deepEqual(await view.page.locator('#overlay .label').allTextContents(), ['p1 yard', 'p2']);
  await view.page.locator('#tab-regions').click();
  const patterns = await view.page.locator('.regions .swatch').evaluateAll((all) => all.map((swatch) => swatch.className));
  assert.equal(new Set(patterns).size, 2);
  await clickAt(view, 190, 180);
  assert.equal(await view.state(() => window.tinsmith.app.selected), 'p1');
  const lit = await view.pixels();
  await button(view, 'Regions').click();
  assert.equal(await view.page.locator('#overlay .label').count(), 0);
  assert.notEqual(await view.pixels(), lit);
});

viewTest('measures cut and fill of a region', {polygon: SQUARE}, async (view, id) => {
  await stand.client.json(`/v1/sessions/${id}/edits`, {method: 'POST', headers: {'Content-Type': 'application/json'},
    body: JSON.stringify({operation: 'offset', polygon: 'p1', by: 3, rim: 5})});
  await view.page.reload();
  await view.rest();
  await view.page.locator('#tab-regions').click();
  await view.page.locator('.regions button').first().click();
  await view.page.getByText('Measure cut and fill').click();
  const ask = async (against) => stand.client.json(`/v1/sessions/${id}/volume`, {method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify({polygon: 'p1', against})});
  await view.page.getByRole('textbox', {name: 'Level', exact: true}).last().fill('110');
  await button(view, 'Against the level').click();
  await view.page.getByText('Cut and fill against 110').waitFor();
  const level = await ask({elevation: 110});
  const figure = (value) => view.page.evaluate((v) => v.toLocaleString('en', {maximumFractionDigits: 0}), value);
  assert.match(await view.page.locator('#body-regions').textContent(), new RegExp(`Fill${await figure(level.fill)} m³`));
  await view.page.getByLabel('Version', {exact: true}).selectOption('2');
  await button(view, 'Against the version').click();
  await view.page.getByText('Cut and fill against version 2').waitFor();
  const since = await ask({version: 2});
  assert.match(await view.page.locator('#body-regions').textContent(), new RegExp(`Cut${await figure(since.cut)} m³`));
});

viewTest('shows the section beside the version before, unasked', {polygon: SQUARE}, async (view, id) => {
  await stand.client.json(`/v1/sessions/${id}/edits`, {method: 'POST', headers: {'Content-Type': 'application/json'},
    body: JSON.stringify({operation: 'offset', polygon: 'p1', by: 20, rim: 5})});
  await view.page.reload();
  await view.rest();
  await view.page.locator('#tab-profile').click();
  await button(view, 'Draw a profile line').click();
  await clickAt(view, 60, 180);
  await view.page.mouse.dblclick(...(await view.spot(340, 180)));
  await view.page.waitForSelector('.plot path.before');
  assert.equal(await view.page.locator('#beside').inputValue(), '2');
  const was = await view.state(() => window.tinsmith.profile.before.stretches.flat());
  const line = await view.state(() => window.tinsmith.profile.line);
  const own = (await stand.client.json(`/v1/sessions/${id}/profile`, {method: 'POST', headers: {'Content-Type': 'application/geo+json'},
    body: JSON.stringify({type: 'LineString', coordinates: line})})).stretches[0].points;
  // Outside of the region nothing has moved; well inside by all of 20 m.
  const now = (d) => {
    const i = Math.max(1, own.findIndex((point) => point.distance >= d));
    const [a, b] = [own[i - 1], own[i]];
    return a.elevation + ((b.elevation - a.elevation) * (d - a.distance)) / (b.distance - a.distance || 1);
  };
  for (const [d, z] of was) {
    if (d < 50 || d > 215) assert.ok(Math.abs(now(d) - z) < 0.01, `${d}: ${now(d)} ${z}`);
    if (d > 80 && d < 170) assert.ok(Math.abs(now(d) - z - 20) < 0.01, `${d}: ${now(d)} ${z}`);
  }
  await view.page.locator('#beside').selectOption('none');
  await view.page.waitForFunction(() => !document.querySelector('.plot path.before'));
  await button(view, 'Undo').click();
  await view.page.waitForFunction(() => window.tinsmith.app.session.version === 4 && window.tinsmith.profile.now.version === 4);
});

viewTest('swipes between before and now', {polygon: SQUARE}, async (view, id) => {
  await stand.client.json(`/v1/sessions/${id}/edits`, {method: 'POST', headers: {'Content-Type': 'application/json'},
    body: JSON.stringify({operation: 'offset', polygon: 'p1', by: 30, rim: 5})});
  await view.page.reload();
  await view.rest();
  await button(view, 'Before/after').click();
  await view.page.waitForFunction(() => window.tinsmith.stage.compare);
  await view.rest();
  const shot = async () => { await view.state(() => window.tinsmith.stage.drawn()); return view.page.locator('#view').screenshot(); };
  const half = await shot();
  const slider = view.page.getByLabel('Before on the left, now on the right');
  await slider.focus();
  await view.page.keyboard.press('End');
  const before = await shot();
  await view.page.keyboard.press('Home');
  const now = await shot();
  assert.ok(!half.equals(before) && !half.equals(now) && !before.equals(now));
  await button(view, 'Before/after').click();
  assert.equal(await view.state(() => window.tinsmith.stage.compare), null);
});

viewTest('asks again for what was promised when the terrain has changed', {polygon: SQUARE}, async (view, id) => {
  await drawSquare(view);
  const promised = await view.state(() => window.tinsmith.draft.promised.totals);
  await stand.client.json(`/v1/sessions/${id}/polygons/p1`, {method: 'DELETE'});
  await view.state(() => window.tinsmith.app.catchUp());
  await view.page.waitForFunction(() => window.tinsmith.app.busy === 0 && !window.tinsmith.draft.stale);
  const renewed = await view.state(() => window.tinsmith.draft.promised.totals);
  assert.notDeepEqual(renewed, promised);
  await integrate(view);
  assert.deepEqual((await stand.client.json(`/v1/sessions/${id}/history/4`)).totals, renewed);
});

test('draws a large terrain by fewer triangles that look the same', async () => {
  const {client, browser, server} = stand;
  await ask(`${server.origin}/v1/sessions/large`, {method: 'PUT', headers: {'Content-Type': 'image/tiff'}, body: readFileSync(join(project, 'tests/data/jacksboro.tif'))});
  const view = await openPage(browser, server.origin, 'large');
  const drawn = (all) => view.state(async (whole) => {
    const {view: {terrain}, stage} = window.tinsmith;
    const {ground, reduced} = terrain;
    const shown = [ground.visible, reduced.visible];
    if (whole) [ground.visible, reduced.visible] = [true, false];
    stage.renderer.render(stage.scene, stage.camera);
    const {width, height} = stage.canvas;
    const copy = Object.assign(document.createElement('canvas'), {width, height}).getContext('2d');
    copy.drawImage(stage.canvas, 0, 0);
    [ground.visible, reduced.visible] = shown;
    return {shown, left: reduced.geometry.drawRange.count / 3, pixels: [...copy.getImageData(0, 0, width, height).data.filter((_, i) => i % 4 < 3)]};
  }, all);
  const less = await drawn(false), whole = await drawn(true);
  assert.deepEqual(less.shown, [false, true], 'the browser of the tests draws with the processor');
  assert.ok(less.left < 0.75 * (await client.session('large')).triangles, `${less.left}`);
  const differences = less.pixels.map((value, i) => Math.abs(value - whole.pixels[i]));
  const mean = differences.reduce((sum, value) => sum + value, 0) / differences.length;
  assert.ok(mean > 0 && mean < 4, `${mean} of 255`);
  assert.ok(differences.filter((value) => value > 80).length < 0.004 * differences.length);
  // Beside what was, too: with nothing changed that is seen from here, both halves are as before.
  await client.integrate('large', JSON.parse(readFileSync(join(project, 'tests/data/parcel.geojson'), 'utf8')));
  await view.state(() => window.tinsmith.app.catchUp());
  await button(view, 'Before/after').click();
  await view.page.waitForFunction(() => window.tinsmith.stage.compare);
  await view.rest();
  const before = await view.state(() => {
    const shown = [];
    window.tinsmith.stage.compare.before.traverse((object) => { if (object.visible && object.geometry?.index) shown.push(object.geometry.drawRange.count / 3); });
    return shown;
  });
  assert.ok(before.every((count) => count < 0.75 * 277268) && Math.abs(before.reduce((sum, count) => sum + count, 0) - less.left) < 0.02 * less.left, `${before} ${less.left}`);
  await view.end();
  await ask(`${server.origin}/v1/sessions/large`, {method: 'DELETE'});
});
