// SPDX-License-Identifier: Apache-2.0
// The page of / as people use it: in a real browser, on the running program. Each test looks at what
// the program says of the session afterwards, and at whether the picture changed.

import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {join} from 'node:path';
import {test} from 'node:test';
import {ask, project} from '../support/program.mjs';
import {clickAt, openPage} from './browser.mjs';
import {assertSameMesh, button, drawSquare, integrate, REFUSED, SQUARE, stand, viewTest} from './stand.mjs';

const POLICY = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src blob:; connect-src 'self'; img-src 'self' data: blob:; style-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

test('the page is served with its policy, its files for good', async () => {
  const page = await ask(`${stand.server.origin}/`);
  assert.equal(page.headers.get('content-security-policy'), POLICY);
  assert.equal(page.headers.get('cache-control'), 'no-cache');
  const html = await page.text();
  assert.doesNotMatch(html, /https?:\/\/(?!www\.w3\.org)|style=|onload=/);
  for (const [, file] of html.matchAll(/(?:src|href)="(viewer\/[^"]+)"/g)) {
    const answer = await ask(`${stand.server.origin}/${file}`);
    assert.equal(answer.status, 200);
    assert.match(answer.headers.get('cache-control'), /immutable/);
    assert.equal(answer.headers.get('content-encoding'), 'gzip');
    assert.equal((await ask(`${stand.server.origin}/${file}`, {headers: {'If-None-Match': answer.headers.get('etag')}})).status, 304);
  }
  for (const path of ['viewer/none.js', 'viewer/index.html', 'viewer/..%2fCMakeCache.txt']) assert.equal((await ask(`${stand.server.origin}/${path}`)).status, 404);
});

test('opens the demo terrain where no other is asked for', async () => {
  await stand.client.make('a-first-one');
  await stand.client.make('demo');
  const view = await openPage(stand.browser, stand.server.origin, '');
  assert.equal(await view.page.locator('#session').inputValue(), 'demo');
  await assertSameMesh(view, 'demo');
  assert.match(await view.page.locator('#legend').textContent(), /Elevation, m.*\d m$/);
  await view.end();
  for (const id of ['a-first-one', 'demo']) await ask(`${stand.server.origin}/v1/sessions/${id}`, {method: 'DELETE'});
});

viewTest('opens a terrain and says what is under the cursor', async (view, id) => {
  assert.match(await view.page.locator('#version').textContent(), /version 1/);
  await assertSameMesh(view, id);
  await view.page.mouse.move(...(await view.spot(203, 187)));
  await view.page.waitForFunction(() => document.querySelector('#readout').textContent.includes('203.'));
  const readout = await view.page.locator('#readout').textContent();
  const [, x, y, z, triangle] = /x([\d.]+)y([\d.]+)elevation([\d.]+) mtriangle([\d,]+)/.exec(readout);
  const told = await stand.client.json(`/v1/sessions/${id}/elevation?x=${x}&y=${y}`);
  assert.ok(Math.abs(told.elevation - z) < 0.02, `${told.elevation} ${z}`);
  assert.equal(told.triangle, Number(triangle.replace(',', '')));
});

viewTest('draws a polygon, promises, and integrates it', async (view, id) => {
  const empty = await view.pixels();
  await drawSquare(view);
  assert.equal((await stand.client.session(id)).version, 1, 'a dry run changes nothing');
  assert.match(await view.page.locator('#report').textContent(), /Dry run: nothing is changed yet/);
  const promised = await view.state(() => window.tinsmith.draft.promised.totals);
  const line = await view.page.locator('#calls code').first().textContent();
  assert.match(line, /snap=0.001&dry_run=true/);
  const shown = JSON.parse(execFileSync('bash', ['-c', `${line} --silent`], {encoding: 'utf8'}));
  assert.deepEqual(shown.totals, promised, 'the curl line does the same');

  await button(view, 'Integrate').click();
  await view.page.waitForFunction(() => window.tinsmith.draft.measured);
  await view.rest();
  const session = await stand.client.session(id);
  assert.deepEqual([session.version, session.polygons], [2, 1]);
  assert.deepEqual((await stand.client.json(`/v1/sessions/${id}/history/2`)).totals, promised);
  assert.match(await view.page.locator('#report').textContent(), /from click to pixels.*Integrated: version 2/s);
  await assertSameMesh(view, id);
  assert.notEqual(await view.pixels(), empty);
  assert.equal(await view.page.locator('#overlay .label').count(), 1);
});

viewTest('takes back corners, cancels, and draws a line', async (view, id) => {
  await button(view, 'Draw line').click();
  for (const [x, y] of [[100, 100], [200, 210], [300, 120]]) await clickAt(view, x, y);
  await view.page.keyboard.press('Backspace');
  assert.equal(await view.state(() => window.tinsmith.draft.points.length), 2);
  await view.page.keyboard.press('Escape');
  assert.equal(await view.state(() => window.tinsmith.draft.points.length), 0);
  await button(view, 'Draw line').click();
  for (const [x, y] of [[100, 100], [300, 210]]) await clickAt(view, x, y);
  await view.page.keyboard.press('Enter');
  await view.page.waitForFunction(() => window.tinsmith.draft.promised);
  await button(view, 'Integrate').click();
  await view.page.waitForFunction(() => window.tinsmith.draft.measured);
  const {features} = await stand.client.json(`/v1/sessions/${id}/polygons`);
  assert.equal(features[0].geometry.type, 'LineString');
});

viewTest('edits the ground, undoes and redoes', {polygon: SQUARE}, async (view, id) => {
  await view.page.locator('#tab-regions').click();
  await view.page.locator('.regions button').first().click();
  await view.page.locator('#level').fill('120');
  const before = await view.pixels();
  await view.page.locator('#edit-dry').click();
  await view.page.waitForFunction(() => document.querySelector('#body-regions').textContent.includes('Dry run: nothing'));
  assert.equal((await stand.client.session(id)).version, 2);
  await view.page.locator('#edit-apply').click();
  await view.page.waitForFunction(() => window.tinsmith.app.session.version === 3);
  await view.rest();
  const report = await stand.client.json(`/v1/sessions/${id}/history/3`);
  assert.ok(report.fill > 0);
  await view.page.waitForFunction(() => document.querySelector('#body-regions').textContent.includes('Done: version 3'));
  const after = await view.pixels();
  assert.notEqual(after, before);
  assert.equal((await stand.client.json(`/v1/sessions/${id}/elevation?x=190&y=180`)).elevation, 120);
  await assertSameMesh(view, id);

  await button(view, 'Undo').click();
  await view.page.waitForFunction(() => window.tinsmith.app.session.version === 4);
  await view.rest();
  await assertSameMesh(view, id);
  assert.notEqual(await view.pixels(), after);
  await view.page.keyboard.press('Control+Shift+Z');
  await view.page.waitForFunction(() => window.tinsmith.app.session.version === 5);
  await view.rest();
  await assertSameMesh(view, id);
  assert.equal((await stand.client.json(`/v1/sessions/${id}/elevation?x=190&y=180`)).elevation, 120);
});

viewTest('draws after many edits what a fresh page draws', {polygon: SQUARE}, async (view, id) => {
  await button(view, 'Facets').click();
  for (const corner of [60, 150, 200]) {
    await view.state((c) => {
      const {draft} = window.tinsmith;
      draft.begin('Polygon');
      for (const [x, y] of [[c, c], [c + 90, c + 7], [c + 40, c + 95]]) draft.add(x, y);
      draft.finish();
    }, corner);
    assert.ok(await button(view, 'Integrate').isDisabled(), 'nothing is done without a report');
    await button(view, 'Dry run').click();
    await button(view, 'Integrate').click();
    await view.page.waitForFunction(() => window.tinsmith.draft.measured);
    await view.rest();
  }
  await button(view, 'Undo').click();
  await view.page.waitForFunction(() => window.tinsmith.app.session.version === 6);
  await view.rest();
  const still = async () => {
    await view.state(() => { window.tinsmith.app.selected = null; window.tinsmith.app.tell('selection'); });
    await view.page.waitForFunction(() => !window.tinsmith.view.regions.isGlowing);
    await view.state(() => window.tinsmith.stage.drawn());
    return view.pixels();
  };
  if (await button(view, 'Facets').getAttribute('aria-pressed') === 'true') await button(view, 'Facets').click();
  const patched = await still();
  await view.page.reload();
  await view.rest();
  assert.ok(patched === (await still()), 'the buffers that edits were written to give another picture');
  assert.equal((await stand.client.session(id)).polygons, 3);
});

viewTest('cuts a hole, and the buffers shrink with it', {polygon: SQUARE}, async (view, id) => {
  const before = await stand.client.session(id);
  await view.page.locator('#tab-regions').click();
  await view.page.locator('.regions button').first().click();
  await view.page.locator('#operation').selectOption('remove');
  await view.page.locator('#edit-apply').click();
  await view.page.waitForFunction(() => window.tinsmith.app.session.version === 3);
  await view.rest();
  assert.ok((await stand.client.session(id)).triangles < before.triangles);
  await assertSameMesh(view, id);
  await view.page.locator('#tab-history').click();
  assert.equal(await view.page.locator('.history li').count(), 3);
});

viewTest('shows the section along a line, before and after', {polygon: SQUARE}, async (view, id) => {
  await stand.client.json(`/v1/sessions/${id}/edits`, {method: 'POST', headers: {'Content-Type': 'application/json'},
    body: JSON.stringify({operation: 'offset', polygon: 'p1', by: 20, rim: 5})});
  await view.page.reload();
  await view.rest();
  const plain = await view.pixels();
  await view.page.locator('#tab-history').click();
  await button(view, 'Compare with version 2').click();
  await view.page.waitForFunction(() => window.tinsmith.stage.compare);
  await view.rest();
  assert.match(await view.page.locator('#curtain').textContent(), /version 2version 3 \(now\)/);
  await view.page.locator('#tab-profile').click();
  await button(view, 'Draw a profile line').click();
  await clickAt(view, 60, 180);
  await view.page.mouse.dblclick(...(await view.spot(340, 185)));
  await view.page.waitForSelector('.plot path.before');
  const line = await view.state(() => window.tinsmith.draft.points);
  const told = await stand.client.json(`/v1/sessions/${id}/profile`, {method: 'POST', headers: {'Content-Type': 'application/geo+json'},
    body: JSON.stringify({type: 'LineString', coordinates: line})});
  assert.match(await view.page.locator('#body-profile .figures').textContent(), new RegExp(`Edges crossed${told.crossings}`));
  const heights = await view.page.evaluate(() => ['now', 'before'].map((name) => document.querySelector(`.plot path.${name}`).getBBox().y));
  assert.ok(heights[0] < heights[1], 'the raised ground stands above what was');
  assert.notEqual(await view.pixels(), plain);
});

viewTest('loads a terrain with progress and refuses what it cannot read', {expected: REFUSED}, async (view) => {
  await ask(`${stand.server.origin}/v1/sessions/jacksboro`, {method: 'DELETE'});
  await view.page.locator('#tab-terrain').click();
  await view.state(() => {
    window.seen = [];
    window.tinsmith.app.on(['progress'], () => { window.seen.push(document.querySelector('.progress').textContent); });
  });
  await view.page.locator('#file').setInputFiles(join(project, 'tests/data/jacksboro.tif'));
  await view.page.waitForFunction(() => window.tinsmith.app.session.id === 'jacksboro');
  await view.rest();
  assert.ok((await view.state(() => window.seen)).some((text) => text.includes('Sending jacksboro.tif')));
  const session = await stand.client.session('jacksboro');
  assert.equal(await view.state(() => window.tinsmith.app.mesh.triangleCount), session.triangles);
  await view.page.locator('#file').setInputFiles({name: 'terrain.dat', mimeType: '', buffer: Buffer.from('what is this')});
  await view.page.getByRole('alert').getByText('Content-Type is not supported').waitFor();
  assert.equal((await stand.client.json('/v1/sessions')).sessions.some(({id}) => id === 'terrain'), false);
  await ask(`${stand.server.origin}/v1/sessions/jacksboro`, {method: 'DELETE'});
});

viewTest('tells of a conflict and resolves it', {expected: REFUSED}, async (view, id) => {
  await drawSquare(view);
  await stand.client.integrate(id, {type: 'LineString', coordinates: [[20, 20], [380, 60]]});
  const stale = await view.pixels();
  await button(view, 'Integrate').click();
  await view.page.getByRole('alert').getByText('Someone else changed this terrain').waitFor();
  await view.rest();
  assert.deepEqual([(await stand.client.session(id)).version, (await stand.client.session(id)).polygons], [2, 1], 'nothing of it was done');
  await assertSameMesh(view, id);
  assert.notEqual(await view.pixels(), stale);
  await button(view, 'Do it on this version').click();
  await view.page.waitForFunction(() => window.tinsmith.app.session.version === 3);
  await view.rest();
  assert.equal((await stand.client.session(id)).polygons, 2);
  await assertSameMesh(view, id);
});

viewTest('tells what is wrong, and marks where', {expected: REFUSED}, async (view, id) => {
  const bow = {type: 'Polygon', coordinates: [[[100, 100], [300, 300], [900, 100], [100, 300], [100, 100]]]};
  await view.page.locator('#options summary').click();
  await view.page.getByLabel('Off the terrain').selectOption('reject');
  await view.page.getByText('Paste GeoJSON').click();
  await view.page.getByLabel('GeoJSON text').fill(JSON.stringify(bow));
  await button(view, 'Take it').click();
  const told = view.page.getByRole('alert');
  await told.getByText('LEAVES_MESH').first().waitFor();
  assert.equal((await stand.client.session(id)).version, 1);
  const mark = view.page.locator('#overlay .mark').first();
  await mark.waitFor();
  await view.page.waitForFunction(() => document.querySelector('#overlay .mark').style.transform);
  const fault = await view.state(() => window.tinsmith.app.problem.errors[0].coordinate);
  const near = await view.state(([x, y]) => {
    const {stage, app} = window.tinsmith;
    const o = app.mesh.origin;
    return stage.project(stage.controls.target.clone().set(x - o[0], y - o[1], (app.ground.at(x, y)?.z ?? o[2]) - o[2]));
  }, fault);
  const transform = await mark.evaluate((element) => element.style.transform);
  assert.match(transform, new RegExp(`^translate\\(${near.x.toFixed(0).slice(0, -1)}`));
  await told.getByRole('button', {name: /^Show/}).first().click();
  await told.getByRole('button', {name: 'Dismiss'}).click();
  assert.equal(await view.page.locator('#overlay .mark').count(), 0);
});

viewTest('is where it was after a reload', {polygon: SQUARE}, async (view, id) => {
  assert.equal(new URL(view.page.url()).hash, `#${id}`);
  await view.page.reload();
  await view.rest();
  assert.equal(await view.page.locator('#session').inputValue(), id);
  assert.equal(await view.page.locator('#overlay .label').count(), 1);
  await assertSameMesh(view, id);
});

viewTest('forks a session and deletes the copy', async (view, id) => {
  await view.page.locator('#tab-terrain').click();
  await button(view, 'Fork').click();
  await view.page.waitForFunction((old) => window.tinsmith.app.session.id !== old, id);
  await view.rest();
  const copy = await view.state(() => window.tinsmith.app.session.id);
  assert.equal((await stand.client.session(copy)).triangles, (await stand.client.session(id)).triangles);
  await button(view, 'Delete…').click();
  await button(view, 'Delete').click();
  await view.page.waitForFunction((old) => window.tinsmith.app.session.id !== old, copy);
  await view.rest();
  assert.equal((await ask(`${stand.server.origin}/v1/sessions/${copy}`)).status, 404);
});

viewTest('takes a dropped GeoJSON file, and offers the downloads', async (view, id) => {
  const empty = await view.pixels();
  await view.page.locator('#geojson').setInputFiles({name: 'square.geojson', mimeType: 'application/geo+json', buffer: Buffer.from(JSON.stringify(SQUARE))});
  await view.page.waitForFunction(() => window.tinsmith.draft.promised);
  await view.rest();
  assert.notEqual(await view.pixels(), empty);
  assert.equal((await stand.client.session(id)).version, 1);
  await view.page.locator('#download summary').click();
  const links = view.page.locator('#download a');
  await links.first().waitFor();
  for (const link of await links.all()) assert.equal((await ask(await link.evaluate((a) => a.href))).status, 200);
});
