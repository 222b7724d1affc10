// SPDX-License-Identifier: Apache-2.0
// What comes in and what goes out: terrains and shapes that are dropped, pasted, or in another unit
// or system; downloads; the curl lines.

import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {readFileSync} from 'node:fs';
import {join} from 'node:path';
import {test} from 'node:test';
import {ask, project, startServer} from '../support/program.mjs';
import {Client, hills, openPage} from './browser.mjs';
import {assertSameMesh, button, drawSquare, give, integrate, REFUSED, SQUARE, stand, viewTest} from './stand.mjs';

const FEET = {...hills(), unit: 'US survey foot'};
const bytesOf = async (path) => Buffer.from(await (await ask(stand.server.origin + path)).arrayBuffer());
const drop = (id) => ask(`${stand.server.origin}/v1/sessions/${id}`, {method: 'DELETE'});

viewTest('snaps by a millimetre in feet too', {terrain: FEET}, async (view, id) => {
  await view.page.locator('#options summary').click();
  assert.equal(await view.page.locator('#option-snap').inputValue(), '0.0032808');
  assert.match(await view.page.locator('#options').textContent(), /ft, to corners and edges this near/);
  await drawSquare(view);
  assert.match(await view.page.locator('#calls code').first().textContent(), /snap=0\.0032808&dry_run=true/);
  assert.match(await view.page.locator('#report').textContent(), /Certified deviation.*ft/);
  await integrate(view);
  assert.equal((await stand.client.session(id)).polygons, 1);
  await assertSameMesh(view, id);
  assert.match(await view.page.locator('.scale').textContent(), /ft$/);
  // What was chosen by hand stays with another terrain; what was not follows its unit.
  await stand.client.make('in-metres');
  await view.page.evaluate(() => window.tinsmith.app.listSessions());
  await view.page.locator('#session').selectOption('in-metres');
  await view.page.waitForFunction(() => window.tinsmith.app.session.id === 'in-metres');
  await view.rest();
  assert.equal(await view.page.locator('#option-snap').inputValue(), '0.001');
  await view.page.locator('#option-snap').fill('0.5');
  await view.page.locator('#option-snap').press('Tab');
  await view.page.locator('#session').selectOption(id);
  await view.page.waitForFunction((own) => window.tinsmith.app.session.id === own, id);
  await view.rest();
  assert.equal(await view.page.locator('#option-snap').inputValue(), '0.5');
  await drop('in-metres');
});

viewTest('loads what is dropped, of every kind', async (view, id) => {
  const {triangles} = await stand.client.session(id);
  const files = [['tif', readFileSync(join(project, 'tests/data/jacksboro.tif')), 277268], ['csv', readFileSync(join(project, 'tests/data/spot_heights.csv')), null]];
  for (const ending of ['glb', 'obj', 'xml', 'gltf']) {
    const query = ending === 'glb' ? '?compression=none' : '';
    files.push([ending, await bytesOf(`/v1/sessions/${id}/mesh.${ending}${query}`), triangles]);
  }
  files.push(['json', JSON.stringify(hills()), triangles]);
  await view.state(() => {
    window.seen = new Set();
    window.tinsmith.app.on(['progress'], () => { window.seen.add(document.querySelector('.progress').textContent.replace(/Stop$/, '')); });
  });
  for (const [ending, content, expected] of files) {
    const name = `dropped-${ending}`;
    await drop(name);
    const before = await view.pixels();
    await give(view, ending === 'csv' ? '#panel' : '#view', 'drop', {files: [{name: `${name}.${ending}`, content}]});
    await view.page.waitForFunction((made) => window.tinsmith.app.session.id === made, name, {timeout: 20_000}).catch(async () => assert.fail(`${name}: ${await view.page.locator('#problem').textContent()}`));
    await view.rest();
    const session = await stand.client.session(name);
    if (expected) assert.equal(session.triangles, expected, ending);
    if (ending !== 'tif') await assertSameMesh(view, name);
    assert.ok(!['tif', 'csv'].includes(ending) || before !== await view.pixels());
  }
  const seen = await view.state(() => [...window.seen]);
  for (const text of ['Sending dropped-tif.tif', 'Building the mesh of dropped-tif.tif']) assert.ok(seen.includes(text), seen.join());
  for (const [ending] of files) await drop(`dropped-${ending}`);
});

viewTest('loads with the options that a file needs', {expected: REFUSED}, async (view) => {
  const degrees = {name: 'degrees.csv', content: 'lon,lat,h\n-84.13,36.34,300\n-84.12,36.34,310\n-84.12,36.35,330\n-84.13,36.35,320\n'};
  await drop('degrees');
  await give(view, '#view', 'drop', {files: [degrees]});
  await view.page.getByRole('alert').getByText('project').first().waitFor();
  await view.page.locator('#loading summary').click();
  await view.page.getByLabel('System').first().fill('EPSG:4326');
  await view.page.getByLabel('Degrees').selectOption('auto');
  await give(view, '#view', 'drop', {files: [degrees]});
  await view.page.waitForFunction(() => window.tinsmith.app.session.id === 'degrees');
  await view.rest();
  assert.equal((await stand.client.session('degrees')).crs, 'EPSG:32616');
  await drop('degrees');
});

viewTest('stops an upload', async (view, id) => {
  const chrome = await view.page.context().newCDPSession(view.page);
  await chrome.send('Network.enable');
  await chrome.send('Network.emulateNetworkConditions', {offline: false, latency: 0, downloadThroughput: -1, uploadThroughput: 20_000});
  await view.page.locator('#file').setInputFiles(join(project, 'tests/data/jacksboro.tif'));
  await button(view, 'Stop').click();
  await view.page.getByRole('alert').getByText('Stopped').waitFor();
  await view.rest();
  assert.equal((await ask(`${stand.server.origin}/v1/sessions/jacksboro`)).status, 404);
  assert.equal(await view.state(() => window.tinsmith.app.session.id), id);
});

viewTest('takes GeoJSON that is dropped or pasted', async (view, id) => {
  const promised = () => view.page.waitForFunction(() => window.tinsmith.draft.promised && window.tinsmith.app.busy === 0);
  const empty = await view.pixels();
  await view.page.locator('#tab-history').click();
  await give(view, '#panel', 'drop', {files: [{name: 'square.geojson', content: JSON.stringify(SQUARE)}]});
  await promised();
  assert.equal(await view.page.locator('#body-draw').isVisible(), true);
  assert.notEqual(await view.pixels(), empty);
  assert.match(await view.page.locator('#calls code').first().textContent(), /-d @square\.geojson/);
  await button(view, 'Cancel').click();
  assert.equal(await view.pixels(), empty);
  for (const kind of ['paste', 'drop']) {
    await give(view, '#view', kind, {text: JSON.stringify(SQUARE)});
    await promised();
    await integrate(view);
  }
  await give(view, '#view', 'paste', {text: 'a letter'});
  const {features} = await stand.client.json(`/v1/sessions/${id}/polygons`);
  assert.equal(features.length, 2);
  await assertSameMesh(view, id);
});

viewTest('takes shapes in another system', {terrain: {...hills(), crs: 'EPSG:32616', unit: undefined, grid: {...hills().grid, origin: [757000, 4026000]}}}, async (view, id) => {
  const degrees = {type: 'Polygon', coordinates: [[[-84.1355, 36.3455], [-84.1335, 36.3455], [-84.1335, 36.3470], [-84.1355, 36.3470], [-84.1355, 36.3455]]]};
  const empty = await view.pixels();
  await view.page.locator('#options summary').click();
  await view.page.locator('#option-crs').fill('EPSG:4326');
  await view.page.locator('#option-crs').press('Tab');
  await give(view, '#view', 'drop', {files: [{name: 'field.geojson', content: JSON.stringify(degrees)}]});
  await view.page.waitForFunction(() => window.tinsmith.draft.promised && window.tinsmith.app.busy === 0);
  assert.notEqual(await view.pixels(), empty, 'its outline lies on the ground');
  assert.equal(await view.state(() => window.tinsmith.draft.placed.length), 1);
  await integrate(view);
  const [feature] = (await stand.client.json(`/v1/sessions/${id}/polygons`)).features;
  assert.ok(feature.tinsmith.plan_area > 20_000 && feature.tinsmith.plan_area < 40_000);
  // What is drawn by hand is in the terrain's own.
  await view.state(() => {
    const {draft} = window.tinsmith;
    draft.begin('LineString');
    draft.add(757100, 4026100);
    draft.add(757200, 4026150);
    draft.finish();
  });
  await button(view, 'Dry run').click();
  await view.page.waitForFunction(() => window.tinsmith.draft.promised);
  await integrate(view);
  assert.equal((await stand.client.session(id)).polygons, 2);
});

viewTest('downloads what it offers, lists whole', {polygon: SQUARE}, async (view, id) => {
  const many = Array.from({length: 1005}, (_, i) => ({type: 'Feature', properties: {}, geometry: {type: 'Point', coordinates: [20 + (i % 35) * 10.3, 20 + Math.floor(i / 35) * 10.7]}}));
  await stand.client.integrate(id, {type: 'FeatureCollection', features: many});
  await view.page.reload();
  await view.rest();
  const menu = view.page.locator('#download summary');
  await menu.click();
  await view.page.locator('#download a').first().waitFor();
  const names = await view.page.locator('#download a').allTextContents();
  const starts = {glb: 'glTF', xml: '<?xml', obj: '# Tinsmith', json: '{', geojson: '{"type":"FeatureCollection"'};
  for (const name of names) {
    if (!await view.page.locator('#download a').first().isVisible()) await menu.click();
    const waiting = view.page.waitForEvent('download');
    await view.page.locator('#download a', {hasText: name}).first().click();
    const download = await waiting;
    const content = readFileSync(await download.path(), 'utf8');
    const file = download.suggestedFilename();
    assert.ok(content.startsWith(starts[file.slice(file.lastIndexOf('.') + 1)]), `${file}: ${content.slice(0, 30)}`);
    if (file.endsWith('polygons.geojson')) assert.equal(JSON.parse(content).features.length, 1006);
    assert.match(await view.page.locator('#calls code').first().textContent(), new RegExp(`-o ${file.replaceAll('.', '\\.')}$`));
  }
  for (const wanted of ['GLB', 'LandXML', 'GeoJSON']) assert.ok(names.some((name) => name.includes(wanted)), wanted);
});

viewTest('shows lines for the shell that do the same', {polygon: SQUARE}, async (view, id) => {
  const shell = (line) => execFileSync('bash', ['-c', `${line} --silent --show-error --fail -o /dev/null -w '%{http_code}'`], {encoding: 'utf8', cwd: join(project, 'build')}).trim();
  const line = () => view.page.locator('#calls code').first().textContent();
  const version = async () => (await stand.client.session(id)).version;
  const plain = (text) => text.replace(/ -o [\w.-]+/, '').replace(/-H 'If-Match: [^']*' ?/, '');
  await button(view, 'Undo').click();
  await view.page.waitForFunction(() => window.tinsmith.app.session.version === 3);
  await view.rest();
  const undo = plain(await line());
  await button(view, 'Redo').click();
  await view.page.waitForFunction(() => window.tinsmith.app.session.version === 4);
  await view.rest();
  assert.equal(shell(undo), '200');
  assert.equal(await version(), 5);
  assert.equal(shell(plain(await line())), '200', 'redo');
  assert.equal(await version(), 6);
  await view.state(() => window.tinsmith.app.catchUp());
  await view.page.locator('#tab-regions').click();
  await view.page.locator('.regions button').first().click();
  await view.page.locator('#edit-apply').click();
  await view.page.waitForFunction(() => window.tinsmith.app.session.version === 7);
  await view.rest();
  assert.equal(shell(plain(await line())), '200', 'edit');
  assert.equal(await version(), 8);
  await view.state(() => window.tinsmith.app.catchUp());
  await button(view, 'Take out').click();
  await view.page.waitForFunction(() => window.tinsmith.app.session.version === 9);
  await view.rest();
  assert.match(await line(), new RegExp(`^curl -X DELETE '?http:.*/v1/sessions/${id}/polygons/p1\\?cascade=true'? -H 'Accept`));
  const all = await view.page.locator('#calls code').allTextContents();
  for (const read of all.filter((text) => /mesh\?since|mesh\.glb|history/.test(text))) assert.equal(shell(plain(read)), '200', read);
});

test('invites to load where there is no terrain', async () => {
  const server = await startServer();
  const view = await openPage(stand.browser, server.origin, '', {empty: true});
  assert.equal(await view.page.locator('#welcome').isVisible(), true);
  await give(view, '#welcome', 'drop', {files: [{name: 'first.csv', content: readFileSync(join(project, 'tests/data/spot_heights.csv'))}]});
  await view.page.waitForFunction(() => window.tinsmith.app.session?.id === 'first');
  await view.rest();
  assert.equal(await view.page.locator('#welcome').isVisible(), false);
  const client = new Client(server.origin);
  assert.equal((await client.json('/v1/sessions')).sessions.length, 1);
  await view.page.locator('#tab-terrain').click();
  await button(view, 'Delete…').click();
  await button(view, 'Delete').click();
  await view.page.locator('#welcome').waitFor();
  await view.end();
  await server.stop();
});
