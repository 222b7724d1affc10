// SPDX-License-Identifier: Apache-2.0
// A server that asks for a key. What stands before it here answers 401 as such a server does, and lets
// through what carries the right one.

import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join} from 'node:path';
import {project} from '../support/program.mjs';
import {assertSameMesh, button, drawSquare, integrate, REFUSED, SQUARE, stand, viewTest} from './stand.mjs';

const KEY = 'tk_right-0123456789';
const AXE = createRequire(import.meta.url).resolve('axe-core/axe.min.js');
const REFUSAL = {
  status: 401, headers: {'WWW-Authenticate': 'Bearer'}, contentType: 'application/problem+json',
  body: JSON.stringify({type: 'urn:tinsmith:problem:unauthorized', title: 'A key is needed', status: 401, detail: 'Send it as Authorization: Bearer KEY.'}),
};

/** The door. `seen`: what came with the right key and what did not. */
function door(seen) {
  return (page) => page.route('**/v1/**', async (route) => {
    const headers = await route.request().allHeaders();
    const isRight = headers.authorization === `Bearer ${KEY}`;
    seen.push([route.request().method(), new URL(route.request().url()).pathname, isRight]);
    if (!isRight) return route.fulfill(REFUSAL);
    delete headers.authorization;
    return route.continue({headers});
  });
}
const give = async (page, key) => {
  await page.locator('#key').fill(key);
  await page.locator('#key').press('Enter');
};

const seen = [];
viewTest('asks for a key and works with it', {polygon: SQUARE, expected: REFUSED, prepare: door(seen), meet: async (page) => {
  const dialog = page.getByRole('dialog', {name: 'This server asks for a key'});
  await dialog.waitFor();
  assert.equal(await page.evaluate(() => document.activeElement.id), 'key', 'one can type at once');
  assert.equal(await page.locator('#key').getAttribute('type'), 'password');
  await page.evaluate(readFileSync(AXE, 'utf8'));
  const {violations} = await page.evaluate(() => window.axe.run(document));
  assert.deepEqual(violations.filter(({impact}) => ['serious', 'critical'].includes(impact)).map(({id}) => id), []);
  await give(page, 'not a key');
  await dialog.getByText('no blanks').waitFor();
  await give(page, 'tk_wrong');
  await dialog.getByText('It does not take the key').waitFor();
  await give(page, `  ${KEY} `);
  await dialog.waitFor({state: 'hidden'});
}}, async (view, id) => {
  const {page} = view;
  await assertSameMesh(view, id);
  const refusals = seen.filter(([, , isRight]) => !isRight).length;
  assert.equal(refusals, 2, 'one without a key, one with a wrong one');
  await drawSquare(view);
  await integrate(view);
  assert.equal((await stand.client.session(id)).polygons, 2);
  await page.locator('#tab-terrain').click();
  await page.locator('#file').setInputFiles({name: 'with-key.csv', mimeType: 'text/csv', buffer: readFileSync(join(project, 'tests/data/spot_heights.csv'))});
  await page.waitForFunction(() => window.tinsmith.app.session.id === 'with-key');
  await view.rest();
  for (const name of ['OBJ', 'Constrained edges, GeoJSON']) {
    await page.locator('#download summary').click();
    const waiting = page.waitForEvent('download');
    await page.locator('#download a', {hasText: name}).click();
    assert.match(readFileSync(await (await waiting).path(), 'utf8'), /^(# Tinsmith|\{"type":"FeatureCollection")/);
  }
  await page.locator('#tab-history').click();
  assert.equal(seen.filter(([, , isRight]) => !isRight).length, refusals, JSON.stringify(seen.filter(([, , isRight]) => !isRight)));

  // Lines for the shell name a variable; the key is nowhere to be read.
  for (const line of await page.locator('#calls code').allTextContents()) assert.match(line, /-H "Authorization: Bearer \$TINSMITH_KEY"/);
  const html = await page.content();
  assert.ok(!html.includes(KEY) && !(await page.locator('#key').inputValue()));
  assert.deepEqual(await page.evaluate(() => [Object.values(sessionStorage), localStorage.length, document.cookie]), [[KEY], 0, '']);

  await page.reload();
  await view.rest();
  assert.equal(await page.getByRole('dialog').count(), 0, 'the tab remembers it');
  await button(view, 'Forget the key').click();
  await page.getByRole('dialog').waitFor();
  assert.deepEqual(await page.evaluate(() => Object.values(sessionStorage)), []);
  await page.keyboard.press('Escape');
  await page.getByRole('alert').getByText('A key is needed').waitFor();
  await button(view, 'Try again').click();
  await give(page, KEY);
  await view.rest();
  await page.unroute('**/v1/**');
  await stand.client.json('/v1/sessions/with-key', {method: 'DELETE'});
});

const late = [];
viewTest('asks again when a key is not taken any more', {expected: REFUSED}, async (view, id) => {
  await drawSquare(view);
  await door(late)(view.page);
  await button(view, 'Integrate').click();
  await view.page.getByRole('dialog').waitFor();
  await give(view.page, KEY);
  await view.page.waitForFunction(() => window.tinsmith.draft.measured);
  await view.rest();
  assert.equal((await stand.client.session(id)).version, 2, 'what was asked for is done, once');
  await view.page.locator('#tab-terrain').click();
  await view.state(() => sessionStorage.clear());
  await view.page.unroute('**/v1/**');
});
