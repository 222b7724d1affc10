// SPDX-License-Identifier: Apache-2.0
// The polygons in the mesh: choose one, move its ground, take it out, measure it.
import type {EditReport} from '../api';
import type {App} from '../app';
import type {RegionEdit, Wish} from '../region_edit';
import {lookOf, titleOf} from '../regions_view';
import {PATTERNS} from '../shaders';
import {areaText, brief, button, bytesText, field, figures, h, input, number, select, shortUnit} from '../ui';
import type {View} from '../view';

export function swatch(id: string, isRegion: boolean) {
  const look = lookOf(id);
  const pattern = isRegion ? PATTERNS[look.pattern] : 'line';
  const element = h('span', {class: `swatch ${pattern}`, title: isRegion ? `pattern: ${pattern}` : ''});
  element.style.setProperty('--colour', look.colour);
  return element;
}

export function buildRegions(app: App, edit: RegionEdit, view: View): HTMLElement {
  const list = h('ul', {class: 'regions', 'aria-label': 'Regions'});
  const empty = h('p', {class: 'soft'});
  const chosen = h('div', {hidden: true});
  const facts = h('div');
  chosen.append(facts, buildForm(app, edit), buildVolume(app, edit));
  app.on(['regions', 'selection'], () => {
    const areas = new Map(app.regions.map((region) => [region.polygon, region]));
    empty.hidden = app.features.length > 0;
    empty.textContent = app.session ? 'No polygon is in this mesh yet: draw one, or take a GeoJSON file.' : 'No terrain is shown.';
    list.replaceChildren(...app.features.map((feature) => {
      const {id} = feature.tinsmith;
      const region = areas.get(id);
      return h('li', {}, button('', () => {
        app.selected = id;
        app.tell('selection');
        app.say(`Region ${id} selected.`);
      }, {class: 'row', 'aria-pressed': String(id === app.selected)}), h('small', {}, region ? areaText(region.plan_area, app.session!.unit) : /Point/.test(feature.geometry?.type ?? '') ? 'point' : 'line'));
    }));
    [...list.querySelectorAll('button')].forEach((element, i) => {
      const {id} = app.features[i].tinsmith;
      element.append(swatch(id, areas.has(id)), h('span', {}, titleOf(app, id)));
    });
    const region = app.selected ? areas.get(app.selected) : undefined;
    chosen.hidden = !region;
    if (!region) return;
    const {unit} = app.session!;
    facts.replaceChildren(figures(titleOf(app, region.polygon), [], [
      ['Plan area', areaText(region.plan_area, unit)], ['Surface area', areaText(region.surface_area, unit)],
      ['Triangles', number(region.triangles.length)], ['Within', region.within.join(', ') || 'none']]),
      h('div', {class: 'buttons'}, button('Show', () => { show(app, view, region.triangles); }, {class: 'small'}),
        button('Take out', () => { void app.attempt(() => edit.takeOut()); }, {class: 'small danger', title: 'As if it had never been there', disabled: app.isReadOnly})));
  });
  return h('div', {}, empty, list, chosen);
}

function show(app: App, view: View, triangles: number[]) {
  let [x0, y0, x1, y1] = [Infinity, Infinity, -Infinity, -Infinity];
  for (const t of triangles) {
    for (let k = 0; k < 3; ++k) {
      const at = 3 * app.mesh.corners[3 * t + k];
      const [x, y] = [app.mesh.positions[at], app.mesh.positions[at + 1]];
      [x0, x1, y0, y1] = [Math.min(x0, x), Math.max(x1, x), Math.min(y0, y), Math.max(y1, y)];
    }
  }
  view.goTo((x0 + x1) / 2, (y0 + y1) / 2, Math.max(x1 - x0, y1 - y0) * 1.3);
}

function buildForm(app: App, edit: RegionEdit): HTMLElement {
  const {wish} = edit;
  const rows: [HTMLElement, () => boolean][] = [];
  const row = (element: HTMLElement, when: () => boolean) => { rows.push([element, when]); return element; };
  const text = (name: keyof Wish, attributes = {}) => input(wish[name], (value) => { (wish as any)[name] = value; edit.change(); }, attributes);
  const lifts = () => wish.operation === 'set' || wish.operation === 'offset';
  const level = text('elevation', {id: 'level'});
  const through = text('point', {placeholder: 'x, y, z', inputmode: 'text'});
  const width = field('Width', text('width'));
  const form = h('div', {class: 'fields'},
    field('Do', select([['set', 'set the ground'], ['offset', 'raise or lower'], ['smooth', 'smooth'], ['remove', 'cut a hole'], ['keep', 'keep only the inside']],
      wish.operation, (value) => { wish.operation = value as Wish['operation']; update(); }, {id: 'operation'})),
    row(field('To', select([['elevation', 'a level'], ['plane', 'a plane of three points'], ['slope', 'a slope']], wish.shape,
      (value) => { wish.shape = value as Wish['shape']; update(); })), () => wish.operation === 'set'),
    row(field('Level', level, 'elevation'), () => wish.operation === 'set' && wish.shape === 'elevation'),
    row(field('Points', h('textarea', {rows: 3, placeholder: 'x, y, z\nx, y, z\nx, y, z', oninput: (event: Event) => { wish.plane = (event.target as HTMLTextAreaElement).value; edit.change(); }})),
      () => wish.operation === 'set' && wish.shape === 'plane'),
    row(field('Slope', text('slope'), 'rise over run'), () => wish.operation === 'set' && wish.shape === 'slope'),
    row(field('Azimuth', text('azimuth'), 'the way up, ° from north'), () => wish.operation === 'set' && wish.shape === 'slope'),
    row(field('Through', through), () => wish.operation === 'set' && wish.shape === 'slope'),
    row(field('By', text('by'), 'below 0 lowers'), () => wish.operation === 'offset'),
    row(field('Passes', text('passes')), () => wish.operation === 'smooth'),
    row(field('Border', select([['old', 'stays; a rim inside climbs'], ['new', 'moves too'], ['taper', 'tapers outside']], wish.border,
      (value) => { wish.border = value as Wish['border']; update(); })), lifts),
    row(field('Border', select([['old', 'stays'], ['new', 'is smoothed too']], wish.edge, (value) => { wish.edge = value as Wish['edge']; edit.change(); })),
      () => wish.operation === 'smooth'),
    row(width, () => lifts() && wish.border !== 'new'));
  const update = () => {
    for (const [element, when] of rows) element.hidden = !when();
    edit.change();
  };
  const box = h('div');
  let shown = '';
  app.on(['selection'], () => {
    const region = app.regions.find((one) => one.polygon === app.selected);
    const name = region ? `${app.session?.id} ${region.polygon}` : '';
    // What was typed stays while the region does.
    if (!region || name === shown) { shown = name; return; }
    shown = name;
    // The mean of the corners is where the ground is; a level near it is what people try first.
    const sum = [0, 0, 0];
    for (const t of region.triangles) for (let k = 0; k < 9; ++k) sum[k % 3] += app.mesh.positions[3 * app.mesh.corners[3 * t + Math.floor(k / 3)] + (k % 3)];
    const mean = sum.map((all) => (all / Math.max(1, 3 * region.triangles.length)).toFixed(1));
    wish.elevation = level.value = mean[2];
    wish.point = through.value = mean.join(', ');
  });
  const apply = () => { void app.attempt(() => edit.apply(), apply); };
  const doIt = button('Apply', apply, {class: 'main', id: 'edit-apply'});
  app.on(['progress', 'session'], () => { doIt.disabled = app.editing || app.isReadOnly; });
  app.on(['edit'], () => { box.replaceChildren(...buildEditReport(app, edit)); });
  update();
  return h('div', {}, h('h2', {}, 'Edit the ground inside'), form, h('div', {class: 'buttons go'},
    button('Dry run', () => { void app.attempt(() => edit.dryRun()); }, {id: 'edit-dry'}), doIt), box);
}

function buildEditReport(app: App, edit: RegionEdit): HTMLElement[] {
  const {promised, measured, volume} = edit;
  const u = shortUnit(app.session?.unit ?? 'metre');
  const out: HTMLElement[] = [];
  const row = (title: string, of: (report: EditReport) => string | null): [string, string | null, string | null] =>
    [title, promised && of(promised), measured && of(measured.report)];
  const amount = (value: number | undefined) => (value === undefined ? null : `${brief(value)} ${u}³`);
  if (promised || measured) {
    out.push(figures(measured ? `Done: version ${measured.report.version}` : 'Dry run: nothing is changed yet', ['promised', 'measured'], [
      row('Cut', (r) => amount(r.cut)), row('Fill', (r) => amount(r.fill)),
      row('Largest change', (r) => `${brief(r.max_elevation_change)} ${u}`), row('Area affected', (r) => areaText(r.area_affected, app.session!.unit)),
      row('Vertices moved', (r) => number(r.vertices_moved)), row('Vertices added', (r) => number(r.vertices_added)),
      row('Triangles affected', (r) => number(r.triangles_affected)), row('Triangles removed', (r) => number(r.triangles_removed)),
      row('Server, ms', (r) => number(Object.values(r.time_ms).reduce((sum, value) => sum + value, 0), 2))]));
  }
  if (measured) out.push(h('p', {class: 'cost'}, h('b', {}, `${number(measured.cost.ms)} ms`), ' from click to pixels, ', h('b', {}, bytesText(measured.cost.bytes)), ' received'));
  if (volume) {
    out.push(figures(`Cut and fill ${volume.question}`, [], [
      ['Cut', amount(volume.answer.cut)], ['Fill', amount(volume.answer.fill)], ['Area', areaText(volume.answer.area, app.session!.unit)]]));
  }
  return out;
}

function buildVolume(app: App, edit: RegionEdit): HTMLElement {
  const level = input('', () => {}, {'aria-label': 'Level', placeholder: 'level'});
  const version = h('select', {'aria-label': 'Version'});
  app.on(['history'], () => {
    version.replaceChildren(...(app.history?.changes ?? []).slice(0, -1).map((change) => h('option', {value: change.version}, `version ${change.version}`)));
  });
  return h('details', {}, h('summary', {}, 'Measure cut and fill'),
    h('div', {class: 'inline'}, level, button('Against the level', () => {
      // Of an empty field there is no number: the server says so.
      void app.attempt(() => edit.askVolume({elevation: level.value.trim() === '' ? null : Number(level.value)}, `against ${level.value}`));
    }, {class: 'small'})),
    h('div', {class: 'inline'}, version, button('Against the version', () => {
      void app.attempt(() => edit.askVolume({version: Number(version.value)}, `against version ${version.value}`));
    }, {class: 'small'})));
}
