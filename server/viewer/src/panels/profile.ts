// SPDX-License-Identifier: Apache-2.0
// A section as a drawing: distance across, elevation up.
import type {App} from '../app';
import type {Draft} from '../draft';
import type {Profile} from '../profile';
import {brief, button, field, figures, h, number, select, shortUnit, svg} from '../ui';
import {contourStep, type View} from '../view';
import {pointTable} from './draw';

const [WIDTH, HEIGHT, LEFT, BOTTOM, TOP] = [320, 190, 44, 26, 10];

export function buildProfile(app: App, draft: Draft, profile: Profile, view: View): HTMLElement {
  const plot = h('div', {class: 'plot'});
  const facts = h('div');
  const state = h('p', {class: 'soft'});
  const ask = button('Show the section', () => { if (draft.finish()) void app.attempt(() => profile.ask([...draft.points])); }, {class: 'main'});
  const points = h('details', {}, h('summary', {}, 'Corners'), pointTable(draft));
  draft.onChange(() => {
    const isOurs = draft.kind === 'Profile';
    points.hidden = ask.hidden = !isOurs;
    ask.disabled = !draft.isComplete;
    state.textContent = isOurs && draft.drawing ? `${draft.points.length} corners. Double-click or Enter shows the section.` : 'A line across the terrain, and the ground along it.';
  });
  const beside = h('div');
  app.on(['profile', 'history'], () => {
    const choices: [string, string][] = [['none', 'nothing'], ...profile.versions.reverse().map((v): [string, string] => [String(v), `version ${v}`])];
    beside.replaceChildren(...(profile.now && choices.length > 1 ? [field('Before', select(choices, String(profile.version ?? 'none'), (value) => {
      profile.against = value === 'none' ? 'none' : Number(value);
      void app.attempt(() => profile.askBefore());
    }, {id: 'beside'}))] : []));
  });
  app.on(['profile'], () => {
    view.showProfile(profile);
    plot.replaceChildren();
    facts.replaceChildren();
    const {now, before} = profile;
    if (!now) return;
    const stretches = now.stretches.map((stretch) => stretch.points.map((point): [number, number] => [point.distance, point.elevation]));
    plot.append(draw(now.length, stretches, before?.stretches ?? [], shortUnit(app.session?.unit ?? '')));
    const heights = stretches.flat().map(([, z]) => z);
    const u = shortUnit(app.session?.unit ?? '');
    facts.append(h('p', {class: 'soft'}, h('span', {class: 'key now'}), `version ${now.version}`,
      before && h('span', {class: 'key before'}), before && `version ${before.version}, to 1 mm`),
      figures('Section', [], [
        ['Length', `${brief(now.length)} ${u}`], ['Edges crossed', number(now.crossings)],
        ['Lowest', heights.length ? `${number(heights.reduce((a, b) => Math.min(a, b)), 2)} ${u}` : null],
        ['Highest', heights.length ? `${number(heights.reduce((a, b) => Math.max(a, b)), 2)} ${u}` : null]]));
  });
  return h('div', {}, h('div', {class: 'buttons'},
    button('Draw a profile line', () => { draft.begin('Profile'); }), button('Clear', () => { draft.cancel(); profile.clear(); }, {class: 'small'})),
    state, points, h('div', {class: 'buttons'}, ask), beside, plot, facts);
}

function draw(length: number, now: [number, number][][], before: [number, number][][], unit: string): SVGElement {
  const all = [...now.flat(), ...before.flat()].map(([, z]) => z);
  let low = Infinity, high = -Infinity;
  for (const z of all) { low = Math.min(low, z); high = Math.max(high, z); }
  if (all.length === 0) [low, high] = [0, 1];
  if (high - low < 1e-6) [low, high] = [low - 1, high + 1];
  const margin = (high - low) * 0.06;
  [low, high] = [low - margin, high + margin];
  const x = (d: number) => LEFT + (d / length) * (WIDTH - LEFT - 8);
  const y = (z: number) => HEIGHT - BOTTOM - ((z - low) / (high - low)) * (HEIGHT - BOTTOM - TOP);
  const path = (points: [number, number][]) => points.map(([d, z], i) => `${i ? 'L' : 'M'}${x(d).toFixed(1)} ${y(z).toFixed(1)}`).join('');
  const out = svg('svg', {viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: 'img', 'aria-label': `Section of ${brief(length)} ${unit}, from ${brief(low)} to ${brief(high)} ${unit}`});
  const step = contourStep((high - low) * 3);
  for (let z = Math.ceil(low / step) * step; z <= high; z += step) {
    out.append(svg('line', {x1: LEFT, x2: WIDTH - 8, y1: y(z), y2: y(z), class: 'grid'}), svg('text', {x: LEFT - 6, y: y(z) + 3.5, 'text-anchor': 'end'}, number(z, Math.max(0, -Math.floor(Math.log10(step))))));
  }
  const along = contourStep(length * 3);
  for (let d = 0; d <= length; d += along) out.append(svg('text', {x: x(d), y: HEIGHT - 8, 'text-anchor': d === 0 ? 'start' : 'middle'}, d === 0 ? `0 ${unit}` : number(d, Math.max(0, -Math.floor(Math.log10(along))))));
  for (const stretch of now) out.append(svg('path', {class: 'fill', d: `${path(stretch)}L${x(stretch[stretch.length - 1][0])} ${HEIGHT - BOTTOM}L${x(stretch[0][0])} ${HEIGHT - BOTTOM}Z`}));
  for (const stretch of before) out.append(svg('path', {class: 'before', d: path(stretch)}));
  for (const stretch of now) out.append(svg('path', {class: 'now', d: path(stretch)}));
  return out;
}
