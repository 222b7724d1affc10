// SPDX-License-Identifier: Apache-2.0
// Debian's Chromium with a page of the running program in it. Whatever a page complains of, and
// whatever it asks of anyone but that program, fails the test that uses it.

import assert from 'node:assert/strict';
import {existsSync} from 'node:fs';
import {chromium} from 'playwright-core';
import {ask} from '../support/program.mjs';

const CHROMIUM = process.env.CHROMIUM ?? ['/usr/bin/chromium', '/usr/bin/chromium-browser'].find(existsSync) ?? 'chromium';
const PATIENCE = Number(process.env.PATIENCE ?? 60_000);

export function launch() {
  return chromium.launch({executablePath: CHROMIUM, args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist']});
}

/** A hilly grid of 10 m cells from 0,0 to 400,400: small, so that the processor draws it soon. */
export function hills(size = 41) {
  const elevations = Array.from({length: size * size}, (_, i) => {
    const [x, y] = [i % size, Math.floor(i / size)];
    return 100 + 12 * Math.sin(x / 5) + 9 * Math.cos(y / 7) + x * 0.3;
  });
  return {name: 'Hills', unit: 'metre', grid: {origin: [0, 0], cell: [10, 10], columns: size, rows: size, elevations}};
}

export class Client {
  constructor(origin) {
    this.origin = origin;
  }
  async json(path, options) {
    const response = await ask(this.origin + path, options);
    const body = await response.json();
    assert.ok(response.ok, JSON.stringify(body));
    return body;
  }
  async make(id, body = hills()) {
    await ask(`${this.origin}/v1/sessions/${id}`, {method: 'DELETE'});
    return this.json(`/v1/sessions/${id}`, {method: 'PUT', headers: {'Content-Type': 'application/json'}, body: JSON.stringify(body)});
  }
  session(id) {
    return this.json(`/v1/sessions/${id}`);
  }
  integrate(id, geometry, query = '') {
    return this.json(`/v1/sessions/${id}/polygons${query}`, {method: 'POST', headers: {'Content-Type': 'application/geo+json'}, body: JSON.stringify(geometry)});
  }
}

/** A page on one session, or where there is none yet (`empty`), at rest. `prepare` sees the page before
    it asks for anything, `meet` before it is at rest. */
export async function openPage(browser, origin, session, {expected = [], empty = false, prepare = null, meet = null, ...options} = {}) {
  const context = await browser.newContext({viewport: {width: 1280, height: 720}, ...options});
  const page = await context.newPage();
  page.setDefaultTimeout(PATIENCE);
  const complaints = [];
  page.on('console', (message) => { if (['error', 'warning'].includes(message.type())) complaints.push(message.text()); });
  page.on('pageerror', (error) => { complaints.push(String(error)); });
  page.on('request', (request) => {
    const url = new URL(request.url());
    if (!['data:', 'blob:'].includes(url.protocol) && url.origin !== origin) complaints.push(`asked ${url}`);
  });
  await page.addInitScript(() => {
    document.addEventListener('securitypolicyviolation', (event) => { console.error(`policy: ${event.violatedDirective} ${event.blockedURI}`); });
  });
  await prepare?.(page);
  await page.goto(`${origin}/#${session}`);
  await meet?.(page);
  const rest = () => page.waitForFunction((none) => window.tinsmith && (none || window.tinsmith.app.session) && window.tinsmith.app.busy === 0 && !window.tinsmith.stage.isEconomical, empty);
  await rest();
  return {
    page, rest,
    state: (read, argument) => page.evaluate(read, argument),
    /** The canvas's own pixels. */
    pixels: () => page.evaluate(() => {
      const {stage} = window.tinsmith;
      stage.renderer.render(stage.scene, stage.camera);
      return stage.canvas.toDataURL();
    }),
    /** Where a plan position is on the page. */
    spot: (x, y) => page.evaluate(([px, py]) => {
      const {stage, app} = window.tinsmith;
      const o = app.mesh.origin;
      const at = stage.project(stage.controls.target.clone().set(px - o[0], py - o[1], app.ground.at(px, py).z - o[2]));
      const frame = stage.canvas.getBoundingClientRect();
      return [at.x + frame.x, at.y + frame.y];
    }, [x, y]),
    async end() {
      await context.close();
      const left = complaints.filter((text) => !expected.some((pattern) => pattern.test(text)) &&
        // Chromium tells of its own slowness when pixels are read.
        !/GPU stall due to ReadPixels/.test(text));
      assert.deepEqual(left, []);
    },
  };
}

/** Clicks far enough apart in time to be no double click. */
export async function clickAt(view, x, y) {
  await view.page.mouse.click(...(await view.spot(x, y)));
  await view.page.waitForTimeout(420);
}
