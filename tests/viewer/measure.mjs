// SPDX-License-Identifier: Apache-2.0
// npm run measure [-- SIDE]: how the page does on a grid of SIDE x SIDE posts, by default a million
// triangles: opening, frames, the cursor, edits from click to pixels. Prints a table; asserts nothing.

import {cpus} from 'node:os';
import {setTimeout} from 'node:timers/promises';
import {startServer} from '../support/program.mjs';
import {Client, launch, openPage} from './browser.mjs';

const SIDE = Number(process.argv[2] ?? 708);
const CELL = 10;
const REPEATS = 7;

/** Ridges on ridges; the same each time. */
function ground(side) {
  const elevations = new Array(side * side);
  for (let i = 0; i < elevations.length; ++i) {
    const [x, y] = [i % side, Math.floor(i / side)];
    let z = 400;
    for (let wave = 260, high = 110, turn = 0.4; wave > 4; wave /= 2.3, high /= 2.4, turn += 1.3) {
      z += high * (1 - 2 * Math.abs(Math.sin((x * Math.cos(turn) + y * Math.sin(turn)) / wave) * Math.cos((y * Math.cos(turn) - x * Math.sin(turn)) / wave)));
    }
    elevations[i] = Math.round(z * 1000) / 1000;
  }
  return {name: 'Ridges', unit: 'metre', grid: {origin: [0, 0], cell: [CELL, CELL], columns: side, rows: side, elevations}};
}

/** A shore of 90 corners around a place, about 900 m across where there is room. */
function shore(x, y) {
  const radius = Math.min(450, SIDE * CELL / 9);
  return Array.from({length: 90}, (_, i) => {
    const angle = (i / 90) * 2 * Math.PI;
    const r = radius * (0.75 + 0.2 * Math.sin(3 * angle) + 0.05 * Math.sin(17 * angle));
    return [x + r * Math.cos(angle), y + r * Math.sin(angle)];
  });
}

const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];
const row = (what, value) => { console.log(`${what.padEnd(58)} ${value}`); };
const ms = (values) => `${median(values).toFixed(values[0] < 10 ? 2 : 0)} ms (${Math.min(...values).toFixed(0)} to ${Math.max(...values).toFixed(0)})`;

const server = await startServer();
const client = new Client(server.origin);
const browser = await launch();
await client.make('ridges', ground(SIDE));
const session = await client.session('ridges');
const begin = performance.now();
const view = await openPage(browser, server.origin, 'ridges');
const opened = performance.now() - begin;
const {page} = view;
const renderer = await view.state(() => {
  const gl = window.tinsmith.stage.renderer.getContext();
  return gl.getParameter(gl.getExtension('WEBGL_debug_renderer_info')?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER);
});
row('Processor', `${cpus().length} x ${cpus()[0].model}`);
row('Chromium', `${browser.version()}, ${renderer}`);
row('Triangles', session.triangles.toLocaleString('en'));
row('Opened, from the address to rest', `${opened.toFixed(0)} ms`);

/** Whole frames at full detail, each waited for until its pixels are there. */
row('One whole frame at 904 x 628, at rest', ms(await view.state(async (count) => {
  const {stage} = window.tinsmith;
  const took = [];
  for (let i = 0; i < count; ++i) {
    const start = performance.now();
    await stage.drawn();
    took.push(performance.now() - start);
  }
  return took;
}, REPEATS)));

/** Drags with the mouse for a while; frames that the page drew, a second. */
async function drag(what, mouse) {
  await page.mouse.move(800, 380);
  await page.mouse.down({button: mouse});
  const frames = () => view.state(() => [window.tinsmith.stage.frames, performance.now()]);
  // The first frames tell the page how slow drawing is.
  for (let i = 0; i < 30; ++i) { await page.mouse.move(800 + 5 * i, 380); await setTimeout(16); }
  const [f0, t0] = await frames();
  for (let i = 0, end = performance.now() + 5000; performance.now() < end; ++i) {
    await page.mouse.move(950 + 200 * Math.sin(i / 25), 380 + 60 * Math.sin(i / 40));
    await setTimeout(12);
  }
  const [f1, t1] = await frames();
  await page.mouse.up({button: mouse});
  await setTimeout(1500);
  row(`Frames a second while ${what}`, ((f1 - f0) / (t1 - t0) * 1000).toFixed(1));
}
await drag('the view turns', 'right');
await drag('the view shifts', 'left');

row('What is under the cursor, a ray', `${(await view.state(() => {
  const {pointer} = window.tinsmith;
  const start = performance.now();
  for (let i = 0; i < 2000; ++i) pointer.at(100 + (i * 37) % 700, 100 + (i * 53) % 450);
  return (performance.now() - start) / 2;
})).toFixed(1)} µs`);

const size = SIDE * CELL;
const costs = [], rests = [], undos = [];
for (let i = 0; i < REPEATS; ++i) {
  await view.state((corners) => {
    const {draft} = window.tinsmith;
    draft.begin('Polygon');
    for (const [x, y] of corners) draft.add(x, y);
    draft.finish();
    window.tinsmith.app.openTab('draw');
  }, shore(size * (0.2 + 0.1 * i), size * (0.25 + 0.08 * (i * 3 % 7))));
  await page.locator('#dry').click();
  await page.waitForFunction(() => window.tinsmith.draft.promised);
  await view.rest();
  const start = performance.now();
  await page.locator('#integrate').click();
  await page.waitForFunction(() => window.tinsmith.draft.measured && window.tinsmith.app.busy === 0);
  rests.push(performance.now() - start);
  costs.push(await view.state(() => window.tinsmith.draft.measured.cost));
  await view.rest();
}
row('Integrating 90 segments, from click to pixels', ms(costs.map((cost) => cost.ms)));
row('  of it until the answer is there', ms(costs.map((cost) => cost.answer ?? NaN)));
row('  bytes received', `${median(costs.map(({bytes}) => bytes)).toLocaleString('en')} of ${(24 * session.vertices + 12 * session.triangles).toLocaleString('en')}`);
row('  until regions, history and report are there', ms(rests));
for (let i = 0; i < 3; ++i) {
  undos.push(await view.state(async () => (await window.tinsmith.app.edit({method: 'POST', path: window.tinsmith.app.path('/undo')})).cost.ms));
  await view.rest();
}
row('Undo, from click to pixels', ms(undos));
await view.end();
await browser.close();
await server.stop();
