// SPDX-License-Identifier: Apache-2.0
// What stands on the map's margin: legend, scale, figures under the cursor, what is shown.
import type {App} from './app';
import type {Compare} from './compare';
import type {Overlay} from './overlay';
import type {Pointer} from './pointer';
import {RAMP} from './shaders';
import {button, byId, h, number, shortUnit} from './ui';
import {contourStep, type View} from './view';

export function buildLegend(app: App, view: View) {
  const bar = h('div', {class: 'bar'});
  bar.style.setProperty('--ramp', RAMP.join(', '));
  const ticks = h('div', {class: 'ticks'});
  const title = h('div', {class: 'title'});
  const lines = h('small');
  const scale = h('div', {class: 'scale'}, h('i'), h('span'));
  byId('legend').append(h('div', {class: 'ramp'}, title, h('div', {class: 'row'}, bar, ticks), lines), scale);
  app.on(['look', 'session'], () => {
    const unit = shortUnit(app.session?.unit ?? '');
    const [low, high] = view.range;
    title.textContent = `Elevation, ${unit}${view.exaggeration !== 1 ? ` (×${view.exaggeration})` : ''}`;
    const digits = high - low >= 100 ? 0 : high - low >= 10 ? 1 : 2;
    ticks.replaceChildren(...[1, 0.5, 0].map((part) => h('span', {}, number(low + (high - low) * part, digits))));
    lines.textContent = view.contours ? `lines every ${contourStep(high - low)} ${unit}` : '';
    byId('legend').hidden = !app.session;
  });
  view.stage.onFrame.push(() => {
    const unit = view.stage.unitsPerPixel();
    const raw = unit * 110, power = 10 ** Math.floor(Math.log10(raw));
    const length = power * ([5, 2, 1].find((n) => n * power <= raw) ?? 1);
    (scale.firstChild as HTMLElement).style.width = `${(length / unit).toFixed(0)}px`;
    const u = shortUnit(app.session?.unit ?? 'metre');
    scale.lastChild!.textContent = u === 'm' && length >= 1000 ? `${length / 1000} km` : `${length} ${u}`;
  });
}

export function buildReadout(app: App, pointer: Pointer) {
  app.on(['hover', 'regions', 'session'], () => {
    const {hover} = pointer;
    const readout = byId('readout');
    readout.hidden = !hover;
    if (!hover) return;
    const polygons = app.around(hover.triangle).map((region) => region.polygon);
    const cell = (name: string, value: string) => h('span', {}, h('small', {}, name), value);
    readout.replaceChildren(cell('x', number(hover.x, 2)), cell('y', number(hover.y, 2)),
      cell('elevation', `${number(hover.z, 2)} ${shortUnit(app.session?.unit ?? '')}`),
      cell('triangle', number(hover.triangle)), cell('in', polygons.join(', ') || 'no region'));
  });
}

/** A button that is on or off. */
function toggle(text: string, title: string, isOn: () => boolean, set: (on: boolean) => void) {
  const element = button(text, () => { set(!isOn()); element.setAttribute('aria-pressed', String(isOn())); }, {title, 'aria-pressed': String(isOn())});
  return element;
}

export function buildLooks(app: App, view: View, overlay: Overlay, compare: Compare) {
  const {regions} = view;
  const swipe = button('Before/after', () => {
    void app.attempt(async () => {
      const back = app.history?.changes.filter((change) => change.version < (app.session?.version ?? 0)).pop()?.version ?? null;
      if (!compare.swipe && compare.group === null) await compare.load(back);
      compare.swipe = compare.group !== null && !compare.swipe;
      if (compare.group === null) app.say('There is no earlier version yet.');
      app.tell('compare');
    });
  }, {'aria-pressed': 'false', title: 'Compare with an earlier version'});
  byId('looks').append(
    toggle('Facets', 'The edges of all triangles', () => view.terrain?.wireframe ?? false, (on) => { if (view.terrain) view.terrain.wireframe = on; view.look(); }),
    toggle('Constraints', 'The edges that polygons and lines have made', () => regions.showLines, (on) => { regions.showLines = on; app.tell('look'); }),
    toggle('Regions', 'Colours, patterns and labels', () => regions.showFills, (on) => { regions.showFills = overlay.showLabels = on; app.tell('look'); }),
    toggle('Contours', 'Lines of equal elevation', () => view.contours, (on) => { view.contours = on; view.look(); }),
    toggle('Height ×3', 'Elevations drawn three times as high', () => view.exaggeration !== 1, (on) => { view.exaggeration = on ? 3 : 1; view.look(); }),
    swipe,
    button('From above', () => { view.fit(true); }, {title: 'Look straight down'}),
    button('Whole', () => { view.fit(); }, {title: 'The whole terrain (Home)'}),
  );
  buildSwipe(app, view, compare, swipe);
}

function buildSwipe(app: App, view: View, compare: Compare, toggleButton: HTMLElement) {
  const box = byId('swipe');
  const range = box.querySelector('input')!;
  const curtain = byId('curtain');
  const left = h('b'), right = h('b');
  curtain.append(left, right);
  const place = () => {
    compare.part = Number(range.value) / 100;
    curtain.style.left = `${range.value}%`;
    if (view.stage.compare) view.stage.compare.part = compare.part;
    view.stage.invalidate();
  };
  range.addEventListener('input', place);
  app.on(['compare', 'session'], () => {
    box.hidden = !compare.swipe;
    toggleButton.setAttribute('aria-pressed', String(compare.swipe));
    left.textContent = `version ${compare.version}`;
    right.textContent = `version ${app.session?.version} (now)`;
    view.look();
    place();
  });
}
