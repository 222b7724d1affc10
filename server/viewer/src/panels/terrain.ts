// SPDX-License-Identifier: Apache-2.0
// Which terrain: choose, load, copy, delete.
import type {Session} from '../api';
import type {App} from '../app';
import {TERRAIN_ENDINGS, type Upload} from '../upload';
import {areaText, brief, button, bytesText, byId, field, figures, h, input, number, select, shortUnit} from '../ui';

export function buildTerrain(app: App, upload: Upload, take: (file: File) => void): HTMLElement {
  const file = h('input', {type: 'file', hidden: true, id: 'file', accept: `${TERRAIN_ENDINGS},.geojson`, onchange: () => {
    if (file.files?.[0]) take(file.files[0]);
    file.value = '';
  }});
  const bar = h('progress', {max: 1, 'aria-label': 'Progress'});
  const told = h('span');
  const progress = h('div', {class: 'progress', hidden: true}, told, bar, button('Stop', () => { void app.attempt(() => upload.stop()); }, {class: 'small'}));
  const facts = h('div');
  const title = h('h2', {}, 'Sessions');
  const list = h('ul', {class: 'sessions'});
  const sure = h('div', {class: 'buttons', hidden: true, role: 'group', 'aria-label': 'Delete'});
  const askDelete = (id: string) => {
    sure.hidden = false;
    sure.replaceChildren(`Delete ${id} for good?`,
      button('Delete', () => { sure.hidden = true; void app.attempt(() => upload.remove(id)); }, {class: 'danger'}),
      button('Keep', () => { sure.hidden = true; }));
    sure.querySelector('button')!.focus();
  };
  const actions = h('div', {class: 'buttons'},
    button('Fork', () => { void app.attempt(() => upload.fork()); }, {title: 'A copy that goes its own way'}),
    button('Delete…', () => { if (app.session) askDelete(app.session.id); }));
  app.on(['progress'], () => {
    progress.hidden = upload.progress === null;
    if (upload.progress) {
      told.textContent = upload.progress.text;
      bar.value = upload.progress.part;
    }
  });
  app.on(['session'], () => {
    const s = app.session;
    actions.hidden = !s;
    facts.replaceChildren();
    if (!s) return;
    const [x0, y0, z0, x1, y1, z1] = s.bounds;
    const u = shortUnit(s.unit);
    facts.append(figures(s.name || s.id, [], [
      ['Vertices', number(s.vertices)], ['Triangles', number(s.triangles)], ['System', s.crs || 'none given'], ['Unit', s.unit],
      ['Extent', `${brief(x1 - x0)} × ${brief(y1 - y0)} ${u}`], ['Plan area', `${areaText((x1 - x0) * (y1 - y0), s.unit)} (box)`],
      ['Elevations', `${brief(z0)} to ${brief(z1)} ${u}`], ['In memory', bytesText(s.memory_bytes)],
      ...(s.expires ? [['Kept until', `${moment(s.expires)}, later if used`] as [string, string]] : [])]));
    const said = [...(s.repairs ?? []).map(({code, count}) => `${code.toLowerCase().replaceAll('_', ' ')}: ${number(count)}`), ...(s.notes ?? [])];
    if (said.length) facts.append(h('ul', {class: 'notes', 'aria-label': 'Said of the file'}, ...said.map((text) => h('li', {}, text))));
  });
  app.on(['sessions', 'session'], () => {
    title.hidden = app.sessions.length === 0;
    list.replaceChildren(...app.sessions.map((s) => h('li', {}, h('button', {type: 'button', class: 'row', title: s.id, 'aria-current': s.id === app.session?.id ? 'true' : false,
      onclick: () => { void app.attempt(() => app.open(s.id)); }}, h('span', {}, s.name ? `${s.name} – ${s.id}` : s.id)),
      isOutOfService(s) && button('Delete…', () => { askDelete(s.id); }, {class: 'small', 'aria-label': `Delete ${s.id}…`}),
      h('small', {}, isOutOfService(s) ? 'out of service' : `${number(s.triangles)} triangles`, s.expires && h('br'), s.expires && `until ${moment(s.expires)}`))));
  });
  return h('div', {}, h('div', {class: 'buttons'},
    button('Load a terrain…', () => { byId('file').click(); }, {class: 'main'}), file),
    h('p', {class: 'soft'}, 'Or drop a file on this page: GeoTIFF, ESRI grid, GLB or glTF, LandXML, OBJ, CSV points, JSON.'),
    buildLoading(upload), progress, title, list, actions, sure, facts);
}

/** Its bytes on the server's disk are damaged: it can be deleted, and no more. */
export const isOutOfService = ({notes}: Session) => (notes ?? []).some((note) => note.startsWith('Out of service'));

/** As a clock on the wall here has it; without the day where that is today. */
function moment(utc: string): string {
  const time = new Date(utc);
  const isToday = time.toDateString() === new Date().toDateString();
  return time.toLocaleString('en-GB', {...(!isToday && {day: 'numeric', month: 'short'}), hour: '2-digit', minute: '2-digit'});
}

/** What the bytes of a file do not say. */
function buildLoading(upload: Upload): HTMLElement {
  const {options} = upload;
  const set = (name: keyof Upload['options']) => (value: string) => { options[name] = value.trim(); };
  return h('details', {id: 'loading'}, h('summary', {}, 'Options of loading'), h('div', {class: 'fields'},
    field('System', input('', set('crs'), {placeholder: 'EPSG:32616', inputmode: 'text'}), 'where the file names none'),
    field('Degrees', select([['', 'refuse'], ['auto', 'project to UTM']], '', set('project'))),
    field('Unit', select([['', 'as the file says'], ['metre', 'metre'], ['foot', 'foot'], ['US survey foot', 'US survey foot']], '', set('unit'))),
    field('Faults', select([['', 'refuse'], ['true', 'repair what can be']], '', set('repair')))));
}
