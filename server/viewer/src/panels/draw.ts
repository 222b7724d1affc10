// SPDX-License-Identifier: Apache-2.0
// The main job: a shape, what would come of it, and then its edges in the mesh.
import {type App, Said} from '../app';
import type {Draft, Kind} from '../draft';
import {button, field, h, input, number, select, shortUnit} from '../ui';
import {buildReport} from './report';

const CHOICES: [string, string, [string, string][], string][] = [
  ['elevation', 'Elevation', [['drape', 'drape on the ground'], ['own', 'bend to own z']], ''],
  ['on_crossing', 'Where lines cross', [['new', 'the new elevation counts'], ['old', 'the earlier one counts']], 'own z only'],
  ['improve', 'Improve triangles', [['strict', 'strict: ground stays'], ['none', 'none'], ['paper', 'paper: anywhere'], ['bounded', 'bounded by a deviation']], ''],
  ['outside', 'Off the terrain', [['skip', 'leave out'], ['reject', 'refuse']], ''],
  ['winding', 'Inside by', [['evenodd', 'even-odd'], ['nonzero', 'nonzero']], ''],
  ['lock', 'Lock edges', [['false', 'no'], ['true', 'yes']], ''],
];

export function pointTable(draft: Draft): HTMLElement {
  const body = h('tbody');
  const table = h('table', {class: 'points'}, h('thead', {}, h('tr', {}, h('th', {scope: 'col'}, 'x'), h('th', {scope: 'col'}, 'y'), h('td'))), body);
  let shown = '';
  const render = () => {
    const state = JSON.stringify(draft.points);
    if (state === shown) return;
    shown = state;
    body.replaceChildren(...draft.points.map((point, i) => {
      const edit = (k: 0 | 1) => {
        const control = input(String(point[k]), () => {}, {'aria-label': `${'xy'[k]} of corner ${i + 1}`, onchange: () => {
          const value = Number(control.value);
          if (control.value.trim() === '' || !Number.isFinite(value)) { control.value = String(point[k]); return; }
          draft.points[i][k] = value;
          shown = JSON.stringify(draft.points);
          draft.forget();
          draft.changed();
        }});
        return control;
      };
      return h('tr', {}, h('td', {}, edit(0)), h('td', {}, edit(1)), h('td', {},
        button('×', () => { draft.points.splice(i, 1); draft.forget(); draft.changed(); }, {class: 'small', 'aria-label': `Remove corner ${i + 1}`})));
    }));
  };
  draft.onChange(render);
  const xy = input('', () => {}, {placeholder: 'x, y', 'aria-label': 'New corner: x, y', inputmode: 'text', onkeydown: (event: KeyboardEvent) => {
    if (event.key === 'Enter') { event.preventDefault(); event.stopPropagation(); add(); }
  }});
  const add = () => {
    const [x, y] = xy.value.split(/[\s,;]+/).filter(Boolean).map(Number);
    if (!Number.isFinite(x) || !Number.isFinite(y)) { xy.setAttribute('aria-invalid', 'true'); return; }
    xy.removeAttribute('aria-invalid');
    xy.value = '';
    draft.add(x, y);
    xy.focus();
  };
  return h('div', {}, table, h('div', {class: 'inline'}, xy, button('Add corner', add, {class: 'small'})));
}

export function buildDraw(app: App, draft: Draft, take: (file: File) => void): HTMLElement {
  const kinds: [Kind, HTMLButtonElement][] = (['Polygon', 'LineString'] as Kind[]).map((kind) => [kind,
    button(kind === 'Polygon' ? 'Polygon' : 'Line', () => { draft.begin(kind); }, {'aria-pressed': 'false', 'aria-label': kind === 'Polygon' ? 'Draw polygon' : 'Draw line', id: `draw-${kind}`})]);
  const file = h('input', {type: 'file', hidden: true, id: 'geojson', accept: '.geojson,.json', onchange: () => {
    if (file.files?.[0]) take(file.files[0]);
    file.value = '';
  }});
  const pasted = h('textarea', {rows: 4, 'aria-label': 'GeoJSON text', placeholder: '{"type": "Polygon", "coordinates": …}', spellcheck: 'false'});
  const paste = h('details', {}, h('summary', {}, 'Paste GeoJSON'), pasted, button('Take it', () => {
    void app.attempt(async () => {
      try { draft.take('', pasted.value); } catch { throw new Said('This is not JSON.'); }
      await draft.dryRun();
    });
  }, {class: 'small'}));
  const state = h('p', {class: 'soft'});
  const points = h('details', {id: 'points'}, h('summary', {}, 'Corners'), pointTable(draft));
  const dry = button('Dry run', () => { void app.attempt(() => draft.dryRun()); }, {id: 'dry'});
  const integrate = () => { void app.attempt(() => draft.integrate(), integrate); };
  const go = button('Integrate', integrate, {id: 'integrate', class: 'main'});
  const finish = button('Finish', () => { if (draft.finish()) void app.attempt(() => draft.dryRun()); }, {class: 'small'});
  const cancel = button('Cancel', () => { draft.cancel(); }, {class: 'small'});
  draft.onChange(() => {
    for (const [kind, element] of kinds) element.setAttribute('aria-pressed', String(draft.kind === kind && draft.drawing));
    const n = draft.points.length;
    state.textContent = app.isReadOnly ? 'This terrain takes no changes; what would come of a shape can be asked.'
      : draft.imported ? `${draft.imported.name || 'What was pasted'}, as it is.`
      : draft.kind === 'Profile' ? 'Draw a shape, or drop a GeoJSON file on the map.'
      : draft.drawing ? `${number(n)} ${n === 1 ? 'corner' : 'corners'}. Click to add; double-click or Enter finishes, Backspace takes back, Escape cancels.`
      : n > 0 ? `${draft.kind === 'Polygon' ? 'Polygon' : 'Line'} of ${number(n)} corners.` : 'Draw a shape, or drop a GeoJSON file on the map.';
    const isOurs = draft.kind !== 'Profile';
    dry.disabled = !draft.isComplete || !isOurs || !app.session;
    finish.hidden = !draft.drawing || !isOurs;
    cancel.hidden = !isOurs || (!draft.drawing && n === 0 && !draft.imported);
    points.hidden = !isOurs || draft.imported !== null;
  });
  // Nothing is done of which there was no report.
  const lock = () => { go.disabled = dry.disabled || draft.promised === null || draft.stale || draft.drawing || app.editing || app.isReadOnly; };
  app.on(['draft', 'report', 'session', 'mesh', 'progress'], lock);
  app.on(['session'], () => { draft.changed(); });
  return h('div', {}, h('div', {class: 'buttons'}, h('span', {class: 'soft'}, 'Draw'), ...kinds.map(([, element]) => element), h('span', {class: 'soft'}, 'or'), button('GeoJSON…', () => { file.click(); }), file),
    paste, state, points, h('div', {class: 'buttons'}, finish, cancel), buildOptions(app, draft),
    h('div', {class: 'buttons go'}, dry, go), buildReport(app, draft));
}

function buildOptions(app: App, draft: Draft): HTMLElement {
  const changed = (name: string) => (value: string) => {
    draft.options[name] = value;
    deviation.hidden = draft.options.improve !== 'bounded';
    crossing.hidden = draft.options.elevation !== 'own';
    tell();
    // What was promised was promised for other options.
    if (draft.promised && draft.isComplete) {
      draft.stale = true;
      void app.attempt(() => draft.dryRun());
    }
  };
  const tell = () => {
    const {defaults} = draft;
    const others = Object.keys(defaults).filter((key) => draft.options[key] !== defaults[key]);
    summary.textContent = others.length ? `Options: ${others.map((key) => `${key} ${draft.options[key]}`).join(', ')}` : 'Options';
  };
  const rows = new Map(CHOICES.map(([name, label, options, hint]) => [name, field(label, select(options, draft.options[name], changed(name)), hint)]));
  const typed = (name: string, label: string, hint: string, attributes = {}) => {
    const control = input(draft.options[name], () => {}, {id: `option-${name}`, ...attributes, onchange: () => { changed(name)(control.value.trim()); }});
    app.on(['options'], () => { control.value = draft.options[name]; tell(); });
    return field(label, control, hint);
  };
  const deviation = typed('max_deviation', 'Deviation', 'at most');
  const crossing = rows.get('on_crossing')!;
  deviation.hidden = crossing.hidden = true;
  const summary = h('summary', {}, 'Options');
  const snap = typed('snap', 'Snap', '');
  const reach = h('small');
  snap.append(reach);
  app.on(['session'], () => { reach.textContent = `${shortUnit(app.session?.unit ?? 'metre')}, to corners and edges this near`; });
  return h('details', {id: 'options'}, summary, h('div', {class: 'fields'}, rows.get('elevation')!, crossing, rows.get('improve')!, deviation,
    snap, rows.get('outside')!, rows.get('winding')!, rows.get('lock')!,
    typed('crs', 'System', 'of the GeoJSON, east before north; empty: the terrain’s', {placeholder: 'EPSG:4326', inputmode: 'text'})));
}
