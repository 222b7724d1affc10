// SPDX-License-Identifier: Apache-2.0
// The page for those who use no mouse, or another sight, or a telephone.

import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {button, integrate, REFUSED, SQUARE, stand, viewTest} from './stand.mjs';

const AXE = createRequire(import.meta.url).resolve('axe-core/axe.min.js');

viewTest('does the main job with the keyboard alone', async (view, id) => {
  const {page} = view;
  const before = await view.pixels();
  /** Tabs forward until that element has the focus. */
  const reach = async (selector) => {
    for (let i = 0; i < 80; ++i) {
      await page.keyboard.press('Tab');
      if (await page.evaluate((s) => document.activeElement.matches(s), selector)) return;
    }
    assert.fail(`no Tab leads to ${selector}`);
  };
  await reach('#draw-Polygon');
  await page.keyboard.press('Enter');
  await reach('#points summary');
  await page.keyboard.press('Enter');
  await reach('#points input[placeholder]');
  for (const corner of ['120, 120', '250 115', '260;240']) {
    await page.keyboard.type(corner);
    await page.keyboard.press('Enter');
  }
  await reach('#view');
  await page.keyboard.press('ArrowUp');
  await page.keyboard.press(' ');
  assert.equal(await view.state(() => window.tinsmith.draft.points.length), 4, 'the space bar sets a corner at the cross');
  await page.keyboard.press('Backspace');
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => window.tinsmith.draft.promised);
  await view.rest();
  await reach('#integrate');
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => window.tinsmith.draft.measured);
  await view.rest();
  assert.equal((await stand.client.session(id)).polygons, 1);
  assert.match(await page.locator('#live').textContent(), /Integrated/);
  await page.keyboard.press('Control+z');
  await page.waitForFunction(() => window.tinsmith.app.session.version === 3);
  await view.rest();
  assert.equal((await stand.client.session(id)).polygons, 0);
  assert.notEqual(await view.pixels(), before, 'the view was moved by a key');
});

for (const [name, viewport] of [['a desk', {width: 1280, height: 720}], ['a telephone', {width: 390, height: 844}]]) {
  viewTest(`is accessible on ${name}`, {polygon: SQUARE, viewport, expected: REFUSED}, async (view) => {
    const {page} = view;
    // The policy lets no script in but the page's own: this one comes in beside it, by the debugger.
    await page.evaluate(readFileSync(AXE, 'utf8'));
    const look = async (what) => {
      // A button on its way to another colour has the contrast of neither.
      await page.evaluate(() => Promise.allSettled(document.getAnimations().map((one) => one.finished)));
      const {violations} = await page.evaluate(() => window.axe.run(document, {resultTypes: ['violations']}));
      const serious = violations.filter(({impact}) => ['serious', 'critical'].includes(impact))
        .map(({id, nodes}) => `${what}: ${id} ${nodes.map(({target}) => target).join(' ')}`);
      assert.deepEqual(serious, []);
      const wide = await view.state(() => [document.documentElement, document.querySelector('#bodies')].map((box) => box.scrollWidth - box.clientWidth));
      assert.deepEqual(wide, [0, 0], `${what} is no wider than the screen`);
    };
    const open = async (tab) => {
      await page.locator(`#tab-${tab}`).click();
      // Everything that can be unfolded, and no menu over it.
      await view.state(() => { for (const details of document.querySelectorAll('details:not(.menu)')) details.open = true; });
    };
    const edit = async (press) => {
      await button(view, press).click();
      await view.rest();
    };
    await open('terrain');
    await button(view, 'Delete…').click();
    await look('terrain');
    await button(view, 'Keep').click();
    await open('draw');
    await look('draw');
    await page.getByLabel('GeoJSON text').fill(JSON.stringify({type: 'LineString', coordinates: [[20, 20], [380, 300], [300, 20]]}));
    await edit('Take it');
    await look('draw, promised');
    await integrate(view);
    await look('draw, measured');
    await open('regions');
    await page.locator('.regions button').first().click();
    await page.locator('#edit-dry').click();
    await view.rest();
    await page.locator('#edit-apply').click();
    await page.waitForFunction(() => window.tinsmith.app.session.version === 4);
    await view.rest();
    await look('regions');
    await open('profile');
    await view.state(() => window.tinsmith.profile.ask([[50, 50], [350, 330]]));
    await page.waitForSelector('.plot path.before');
    await look('profile');
    await open('history');
    await edit('Report of version 2');
    await edit('Compare with version 3');
    await look('history');
    await page.locator('#download summary').click();
    await look('downloads');
    await page.keyboard.press('Escape');
    await open('draw');
    await page.getByLabel('GeoJSON text').fill('{"type": "Polygon", "coordinates": [[[100, 100], [300, 300], [100, 100]]]}');
    await edit('Take it');
    await page.getByRole('alert').getByText('RING_TOO_SHORT').waitFor();
    await look('a problem');
  });
}
