// SPDX-License-Identifier: Apache-2.0
// What goes wrong around the page: the connection, the disk, other people, time that runs out.

import assert from 'node:assert/strict';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {test} from 'node:test';
import {ask, project, startServer} from '../support/program.mjs';
import {Client, hills, openPage} from './browser.mjs';
import {assertSameMesh, button, drawSquare, give, integrate, REFUSED, SQUARE, stand, viewTest} from './stand.mjs';

const UNREACHED = [/Failed to load resource: net::ERR_(INTERNET_DISCONNECTED|FAILED)/];
const REFUSED_FOR_NOW = [/Failed to load resource: the server responded with a status of (503|429)/];
const IN_DEGREES = {...hills(), crs: 'EPSG:32616', unit: undefined, grid: {...hills().grid, origin: [757000, 4026000]}};

const told = (view) => view.page.getByRole('alert');

viewTest('says when the server is out of reach, and goes on', {expected: UNREACHED}, async (view, id) => {
  await drawSquare(view);
  const context = view.page.context();
  await context.setOffline(true);
  await button(view, 'Integrate').click();
  await told(view).getByText('The server does not answer').waitFor();
  await context.setOffline(false);
  assert.equal((await stand.client.session(id)).version, 1);
  await button(view, 'Try again').click();
  await view.page.waitForFunction(() => window.tinsmith.draft.measured);
  await view.rest();
  assert.equal(await told(view).textContent(), '');
  assert.equal((await stand.client.session(id)).version, 2);
  await assertSameMesh(view, id);
});

for (const [status, word, title, detail] of [
  [503, 'storage-unavailable', 'The change could not be kept', 'The disk takes no more: nothing of this was done.'],
  [429, 'too-many-requests', 'Too many requests', 'This key has sent more than it may.']]) {
  viewTest(`offers to try again after a ${status}`, {expected: REFUSED_FOR_NOW}, async (view, id) => {
    await drawSquare(view);
    await view.page.route('**/polygons*', (route) => route.fulfill({status, headers: {'Retry-After': '7'}, contentType: 'application/problem+json',
      body: JSON.stringify({type: `urn:tinsmith:problem:${word}`, title, status, detail})}), {times: 1});
    await button(view, 'Integrate').click();
    await told(view).getByText(title).waitFor();
    assert.match(await told(view).textContent(), new RegExp(`${detail} Try again in 7 s\\.`));
    assert.equal((await stand.client.session(id)).version, 1);
    await button(view, 'Try again').click();
    await view.page.waitForFunction(() => window.tinsmith.draft.measured);
    await view.rest();
    assert.deepEqual([(await stand.client.session(id)).version, await told(view).textContent()], [2, '']);
  });
}

viewTest('is told by a proxy that speaks no JSON', {expected: REFUSED_FOR_NOW}, async (view) => {
  await view.page.route('**/polygons*', (route) => route.fulfill({status: 503, contentType: 'text/html', body: '<h1>Bad day</h1>'}), {times: 1});
  await drawSquareWithoutPromise(view);
  await told(view).getByText('The server answered 503').waitFor();
});
async function drawSquareWithoutPromise(view) {
  await view.page.locator('#geojson').setInputFiles({name: 'square.geojson', mimeType: 'application/geo+json', buffer: Buffer.from(JSON.stringify(SQUARE))});
}

viewTest('never does an edit twice whose answer was lost', {expected: UNREACHED}, async (view, id) => {
  await drawSquare(view);
  await view.page.route('**/polygons*', async (route) => {
    await route.fetch();
    await route.abort();
  }, {times: 1});
  await button(view, 'Integrate').click();
  await told(view).getByText('The server does not answer').waitFor();
  assert.equal((await stand.client.session(id)).version, 2, 'it was made, but nobody here knows');
  await button(view, 'Try again').click();
  await view.page.waitForFunction(() => window.tinsmith.draft.measured);
  await view.rest();
  const {version, polygons} = await stand.client.session(id);
  assert.deepEqual([version, polygons, await told(view).textContent()], [2, 1, '']);
  await assertSameMesh(view, id);
  // The same shape once more, because it is wished for, is another edit.
  await drawSquare(view);
  await integrate(view);
  assert.equal((await stand.client.session(id)).polygons, 2);
});

viewTest('never does an edit twice whose aftermath was lost', {expected: UNREACHED}, async (view, id) => {
  await drawSquare(view);
  await view.page.route('**/regions*', (route) => route.abort());
  await button(view, 'Integrate').click();
  await told(view).getByText('It is done, but not all of it could be fetched').waitFor();
  assert.match(await told(view).textContent(), /this terrain has version 2/);
  assert.equal(await button(view, 'Try again').count(), 0);
  await view.page.unroute('**/regions*');
  await button(view, 'Fetch it').click();
  await view.page.waitForFunction(() => window.tinsmith.app.regions.length === 1);
  await view.rest();
  assert.equal((await stand.client.session(id)).version, 2);
  assert.equal(await view.page.locator('#version').textContent(), 'version 2');
  await assertSameMesh(view, id);
});

viewTest('makes one edit of two quick clicks', {polygon: SQUARE}, async (view, id) => {
  await view.page.locator('#tab-regions').click();
  await view.page.locator('.regions button').first().click();
  await view.state(() => { for (let i = 0; i < 2; ++i) document.querySelector('#edit-apply').click(); });
  await view.page.waitForFunction(() => window.tinsmith.app.session.version === 3);
  await view.rest();
  assert.equal((await stand.client.session(id)).version, 3);
  assert.equal(await told(view).textContent(), '');
  await assertSameMesh(view, id);
});

viewTest('says that a terrain is gone', {expected: REFUSED}, async (view, id) => {
  await drawSquare(view);
  await stand.client.json(`/v1/sessions/${id}`, {method: 'DELETE'});
  await button(view, 'Integrate').click();
  await told(view).getByText('This terrain is gone').waitFor();
  assert.match(await told(view).textContent(), new RegExp(`"${id}"`));
  await view.page.locator('#welcome').waitFor();
  assert.equal(await view.page.locator('#session').inputValue(), '');
  assert.equal(new URL(view.page.url()).hash, '');
  assert.ok(await button(view, 'Integrate').isDisabled() && await button(view, 'Undo').isDisabled());
  assert.deepEqual(await view.state(() => [window.tinsmith.view.terrain, window.tinsmith.app.mesh.triangleCount]), [null, 0]);
  // Another one can be opened from here.
  await stand.client.make('the-next-one');
  await view.state(() => window.tinsmith.app.listSessions());
  await view.page.locator('#session').selectOption('the-next-one');
  await view.page.waitForFunction(() => window.tinsmith.app.session?.id === 'the-next-one');
  await view.rest();
  await assertSameMesh(view, 'the-next-one');
  await ask(`${stand.server.origin}/v1/sessions/the-next-one`, {method: 'DELETE'});
});

viewTest('knows a terrain made anew under its name', {polygon: SQUARE}, async (view, id) => {
  await stand.client.make(id, hills(31));
  await stand.client.integrate(id, {type: 'LineString', coordinates: [[20, 20], [200, 60]]});
  await stand.client.integrate(id, {type: 'LineString', coordinates: [[20, 120], [200, 160]]});
  await view.state(() => window.tinsmith.app.catchUp());
  await view.rest();
  await assertSameMesh(view, id);
  assert.equal(await view.page.locator('#overlay .label').count(), 0);
});

viewTest('takes the terrain that the address names', {expected: REFUSED}, async (view, id) => {
  await stand.client.make('another-one', hills(21));
  await view.state(() => { location.hash = 'another-one'; });
  await view.page.waitForFunction(() => window.tinsmith.app.session.id === 'another-one');
  await view.rest();
  await assertSameMesh(view, 'another-one');
  await view.state(() => { location.hash = 'none-of-these'; });
  await told(view).getByText('There is no such session').waitFor();
  await view.page.goto('about:blank');
  await view.page.goto(`${stand.server.origin}/#none-of-these`);
  await told(view).getByText('There is no terrain "none-of-these" here').waitFor();
  await view.rest();
  await ask(`${stand.server.origin}/v1/sessions/another-one`, {method: 'DELETE'});
  assert.ok(id);
});

/** The session's own JSON, with something added. */
const changed = (more) => async (route) => {
  const response = await route.fetch();
  const body = await response.json();
  if (body.sessions) body.sessions = more(body.sessions); else Object.assign(body, more(body));
  await route.fulfill({response, json: body});
};

viewTest('shows what takes no changes', {polygon: SQUARE, prepare: (page) => page.route(/\/v1\/sessions\/[\w-]+$/, changed(() => ({notes: ['This session is read-only: it is as version 2 was.']})))},
  async (view, id) => {
    assert.equal(await view.page.locator('#version').textContent(), 'version 2, read-only');
    assert.ok(await button(view, 'Undo').isDisabled());
    await drawSquare(view);
    assert.ok(await button(view, 'Integrate').isDisabled());
    await view.page.locator('#tab-regions').click();
    await view.page.locator('.regions button').first().click();
    assert.ok(await button(view, 'Apply').isDisabled() && await button(view, 'Take out').isDisabled());
    await view.page.locator('#tab-terrain').click();
    assert.match(await view.page.locator('.notes').textContent(), /read-only/);
    assert.equal((await stand.client.session(id)).version, 2);
  });

test('opens no damaged terrain unasked, and deletes it', async () => {
  const {client, browser, server} = stand;
  await client.make('a-damaged-one');
  await client.make('b-sound-one');
  const damaged = {notes: ['Out of service: row 7 of its journal is damaged.'], vertices: 0, triangles: 0};
  const view = await openPage(browser, server.origin, '', {prepare: (page) => page.route(/\/v1\/sessions$/,
    changed((all) => all.map((one) => (one.id === 'a-damaged-one' ? {...one, ...damaged} : one))))});
  assert.equal(await view.page.locator('#session').inputValue(), 'b-sound-one');
  await view.page.locator('#tab-terrain').click();
  const row = view.page.locator('.sessions li', {hasText: 'a-damaged-one'});
  assert.match(await row.textContent(), /out of service/);
  await button(view, 'Delete a-damaged-one…').click();
  await button(view, 'Delete').click();
  await row.waitFor({state: 'detached'});
  await view.rest();
  assert.equal((await ask(`${server.origin}/v1/sessions/a-damaged-one`)).status, 404);
  assert.equal(await view.page.locator('#session').inputValue(), 'b-sound-one');
  await view.end();
  await ask(`${server.origin}/v1/sessions/b-sound-one`, {method: 'DELETE'});
});

test('tells until when a terrain is kept', async () => {
  const data = mkdtempSync(join(tmpdir(), 'tinsmith-page-'));
  const server = await startServer('--data', data, '--session-ttl', '7200');
  const client = new Client(server.origin);
  await client.make('passing');
  const view = await openPage(stand.browser, server.origin, 'passing', {locale: 'en-GB', timezoneId: 'UTC'});
  await view.page.locator('#tab-terrain').click();
  const {expires} = await client.session('passing');
  const told = /until (?:\d+ \w+, )?(\d\d):(\d\d)/.exec(await view.page.locator('.sessions li').textContent());
  assert.ok(told, await view.page.locator('.sessions li').textContent());
  const [hours, minutes] = [new Date(expires).getUTCHours(), new Date(expires).getUTCMinutes()];
  const off = Math.abs(60 * hours + minutes - 60 * Number(told[1]) - Number(told[2]));
  assert.ok(Math.min(off, 1440 - off) <= 2, `${told[0]} of ${expires}`);
  assert.match(await view.page.locator('#body-terrain').textContent(), /Kept until.*later if used/);
  await view.end();
  await server.stop();
  rmSync(data, {recursive: true});
});

viewTest('marks faults of shapes in another system where they are', {terrain: IN_DEGREES, expected: REFUSED}, async (view, id) => {
  await view.page.locator('#options summary').click();
  await view.page.locator('#option-crs').fill('EPSG:4326');
  await view.page.locator('#option-crs').press('Tab');
  // What is wrong with the shape itself is told in degrees, as it was sent.
  const open = {type: 'Polygon', coordinates: [[[-84.1355, 36.3455], [-84.1335, 36.3455], [-84.1335, 36.347]]]};
  const {points: [wanted]} = await stand.client.json(`/v1/sessions/${id}/elevation?crs=EPSG:4326`, {method: 'POST', headers: {'Content-Type': 'application/json'},
    body: JSON.stringify({points: [open.coordinates[0][0]]})});
  const takeShape = async (shape) => {
    await view.page.locator('#geojson').setInputFiles({name: 'shape.geojson', mimeType: 'application/geo+json', buffer: Buffer.from(JSON.stringify(shape))});
    await view.page.locator('#overlay .mark').first().waitFor();
    return view.state(() => window.tinsmith.app.problem.errors.map(({code, coordinate}) => [code, coordinate]));
  };
  for (const [code, [x, y]] of (await takeShape(open)).filter(([, coordinate]) => coordinate)) {
    assert.match(code, /RING/);
    assert.ok(Math.hypot(x - wanted.x, y - wanted.y) < 250 && x > 757000 && x < 757400 && y > 4026000 && y < 4026400, `${code} ${x} ${y}`);
  }
  await button(view, 'Dismiss').click();
  assert.equal(await view.page.locator('#overlay .mark').count(), 0);
  // What the mesh refuses is told in its own.
  await view.page.getByLabel('Off the terrain').selectOption('reject');
  const leaving = {type: 'LineString', coordinates: [[-84.1355, 36.3455], [-84.1255, 36.3455]]};
  const [[code, [x]]] = await takeShape(leaving);
  assert.equal(code, 'LEAVES_MESH');
  assert.ok(Math.abs(x - 757400) < 0.001, `at the terrain's edge: ${x}`);
  assert.equal((await stand.client.session(id)).version, 1);
});

viewTest('promises the angles that then come', async (view, id) => {
  await drawSquare(view);
  const bars = view.page.locator('#report .angles rect');
  assert.equal(await bars.count(), 24);
  const text = await view.page.locator('#report .angles').textContent();
  assert.match(text, /before: \d+, least.*would be: \d+, least/);
  const promised = await view.state(() => window.tinsmith.draft.promised.smallest_angles);
  await integrate(view);
  const measured = await view.state(() => window.tinsmith.draft.measured.angles);
  assert.deepEqual([measured.before.bars, measured.after.bars], [promised.before, promised.after]);
  assert.equal((await view.page.locator('#report .angles').textContent()).replace('after:', 'would be:'), text);
  assert.equal((await stand.client.session(id)).version, 2);
});

viewTest('finds another name where one is taken by somebody unseen', {expected: REFUSED}, async (view) => {
  await stand.client.make('spots', hills(11));
  // Made since this page read its list.
  await view.state(() => { window.tinsmith.app.sessions = window.tinsmith.app.sessions.filter(({id}) => id !== 'spots'); });
  const files = [{name: 'spots.csv', content: readFileSync(join(project, 'tests/data/spot_heights.csv'))}];
  await give(view, '#view', 'drop', {files});
  await view.page.waitForFunction(() => window.tinsmith.app.session.id === 'spots-2');
  await view.rest();
  assert.equal((await stand.client.session('spots')).triangles, 200, 'the other is as it was');
  await give(view, '#view', 'drop', {files: [...files, ...files]});
  await told(view).getByText('drop one at a time').waitFor();
  for (const id of ['spots', 'spots-2']) await ask(`${stand.server.origin}/v1/sessions/${id}`, {method: 'DELETE'});
});

let starting = 2;
viewTest('waits for a server that is starting', {expected: REFUSED_FOR_NOW, prepare: (page) => page.route(/\/v1\/sessions$/, (route) => (starting-- > 0
  ? route.fulfill({status: 503, headers: {'Retry-After': '1'}, contentType: 'application/problem+json',
    body: JSON.stringify({type: 'urn:tinsmith:problem:not-ready', title: 'Not ready', status: 503, detail: 'It reads its sessions.'})}) : route.continue())),
meet: async (page) => { await page.locator('#hint').getByText('The server is starting').waitFor(); }}, async (view, id) => {
  assert.ok(starting < 0);
  assert.deepEqual([await view.page.locator('#hint').textContent(), await told(view).textContent()], ['', '']);
  await assertSameMesh(view, id);
});

viewTest('draws again when the graphics come back', {polygon: SQUARE, expected: [/Context (Lost|Restored)/, /CONTEXT_LOST_WEBGL/]}, async (view) => {
  await view.page.waitForFunction(() => !window.tinsmith.view.regions.isGlowing);
  const before = await view.pixels();
  await view.state(async () => {
    const {stage} = window.tinsmith;
    const lose = stage.renderer.getContext().getExtension('WEBGL_lose_context');
    const restored = new Promise((resolve) => { stage.canvas.addEventListener('webglcontextrestored', () => setTimeout(resolve, 200)); });
    lose.loseContext();
    await new Promise((resolve) => setTimeout(resolve, 200));
    lose.restoreContext();
    await restored;
    await stage.drawn();
  });
  assert.equal(await view.pixels(), before);
});

test('says where nothing can be drawn', async () => {
  const view = await openPage(stand.browser, stand.server.origin, '', {expected: [/WebGL/],
    prepare: (page) => page.addInitScript(() => { HTMLCanvasElement.prototype.getContext = () => null; }),
    meet: async (page) => {
      await page.getByText('This browser draws no terrain').waitFor();
      assert.equal(await page.locator('#welcome a').getAttribute('href'), 'docs');
      await page.evaluate(() => { window.tinsmith = {app: {busy: 0}, stage: {isEconomical: false}}; });
    }, empty: true});
  await view.end();
});
