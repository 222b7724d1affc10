// SPDX-License-Identifier: Apache-2.0
// What the tests of the page have in common: one program and one browser for each file, a session and
// a page for each test.

import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {startServer} from '../support/program.mjs';
import {Client, clickAt, launch, openPage} from './browser.mjs';

export const SQUARE = {type: 'Polygon', coordinates: [[[120, 120], [250, 115], [260, 240], [125, 250], [120, 120]]]};
// The browser writes a line of its own for each refusal that the page tells in words.
export const REFUSED = [/Failed to load resource: the server responded with a status of 4\d\d/];

/** Known once the tests run. */
export const stand = {server: null, browser: null, client: null};
before(async () => {
  stand.server = await startServer();
  stand.client = new Client(stand.server.origin);
  stand.browser = await launch();
});
after(async () => {
  await stand.browser?.close();
  await stand.server?.stop();
});

/** A page on a session of its own, closed at the end with nothing to complain of. */
export function viewTest(name, options, body) {
  if (typeof options === 'function') [body, options] = [options, {}];
  test(name, async () => {
    const id = name.toLowerCase().replace(/[^a-z0-9]+/g, '-').slice(0, 30).replace(/-$/, '');
    await stand.client.make(id, options.terrain);
    if (options.polygon) await stand.client.integrate(id, options.polygon);
    const view = await openPage(stand.browser, stand.server.origin, id, options);
    await body(view, id);
    await view.end();
  });
}

export const button = (view, name) => view.page.getByRole('button', {name, exact: true});

/** The page's buffers against the server's mesh, number for number. */
export async function assertSameMesh(view, id) {
  const mesh = await stand.client.json(`/v1/sessions/${id}/mesh.json`);
  const own = await view.state(() => {
    const {mesh: m} = window.tinsmith.app;
    return {version: m.version, vertices: [...m.positions.slice(0, 3 * m.vertexCount)], triangles: [...m.corners.slice(0, 3 * m.triangleCount)]};
  });
  assert.deepEqual(own.vertices, mesh.vertices.flat());
  assert.deepEqual(own.triangles, mesh.triangles.flat());
  assert.equal(own.version, (await stand.client.session(id)).version);
}

export async function drawSquare(view) {
  await button(view, 'Draw polygon').click();
  for (const [x, y] of [[120, 120], [250, 115], [260, 240]]) await clickAt(view, x, y);
  await view.page.mouse.dblclick(...(await view.spot(125, 250)));
  await view.page.waitForFunction(() => window.tinsmith.draft.promised);
  await view.rest();
}

/** Presses Integrate and waits for the pixels and the report. */
export async function integrate(view) {
  await button(view, 'Integrate').click();
  await view.page.waitForFunction(() => window.tinsmith.draft.measured);
  await view.rest();
}

/** Files, or text, dropped on an element, or pasted. */
export async function give(view, selector, kind, {files = [], text = ''}) {
  await view.page.locator(selector).first().evaluate((element, given) => {
    const data = new DataTransfer();
    for (const {name, base64} of given.files) data.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], name));
    if (given.text) data.setData('text/plain', given.text);
    if (given.kind === 'paste') element.dispatchEvent(new ClipboardEvent('paste', {bubbles: true, clipboardData: data}));
    else for (const type of ['dragenter', 'dragover', 'drop']) element.dispatchEvent(new DragEvent(type, {bubbles: true, cancelable: true, dataTransfer: data}));
  }, {kind, text, files: files.map(({name, content}) => ({name, base64: Buffer.from(content).toString('base64')}))});
}
