// SPDX-License-Identifier: Apache-2.0
// The page's head: which terrain, which version, downloads; and the tabs below it.
import {access} from '../access';
import {bytesOf, type Call, GEOJSON, pages, send, sessionPath, urlOf} from '../api';
import type {App} from '../app';
import {byId, h} from '../ui';

interface Download { text: string; path: string; query?: Record<string, string>; ending: string; accept?: string }

const FILES: Download[] = [
  {text: 'GLB with Draco', path: '/mesh.glb', ending: 'glb'},
  {text: 'GLB, regions as primitives', path: '/mesh.glb', query: {regions: 'true'}, ending: 'regions.glb'},
  {text: 'GLB, plain, z up', path: '/mesh.glb', query: {compression: 'none', up: 'z'}, ending: 'plain.glb'},
  {text: 'LandXML', path: '/mesh.xml', ending: 'xml'},
  {text: 'OBJ', path: '/mesh.obj', ending: 'obj'},
  {text: 'JSON, full doubles', path: '/mesh.json', ending: 'json'},
  {text: 'Polygons on the ground, GeoJSON', path: '/polygons', ending: 'polygons.geojson', accept: GEOJSON},
  {text: 'Regions with areas, GeoJSON', path: '/regions', ending: 'regions.geojson', accept: GEOJSON},
  {text: 'Constrained edges, GeoJSON', path: '/constraints', ending: 'constraints.geojson', accept: GEOJSON},
];

function save(blob: Blob, name: string) {
  const address = URL.createObjectURL(blob);
  h('a', {href: address, download: name}).click();
  setTimeout(() => { URL.revokeObjectURL(address); }, 60_000);
}

/** A list that comes by pages becomes one file. */
async function saveList(path: string, accept: string, name: string) {
  const features = await pages(path, 'features', {Accept: accept});
  save(new Blob([JSON.stringify({type: 'FeatureCollection', features})], {type: accept}), name);
}

/** A link sends no key. */
async function saveWithKey(call: Call, name: string) {
  save(new Blob([await bytesOf(await send(call))]), name);
}

function buildDownloads(app: App, menu: HTMLDetailsElement) {
  app.on(['session'], () => { menu.hidden = !app.session; });
  menu.addEventListener('toggle', () => {
    if (!menu.open || !app.session) return;
    const {id} = app.session;
    menu.lastElementChild!.replaceChildren(...FILES.map(({text, path, query, ending, accept}) => {
      const name = `${id}.${ending}`;
      const call: Call = {method: 'GET', path: sessionPath(id, path), query, out: name, ...(accept && {headers: {Accept: accept}})};
      return h('a', {href: urlOf(call), download: name, onclick: (event: Event) => {
        app.note(call);
        menu.open = false;
        if (!accept && !access.key) return;
        event.preventDefault();
        void app.attempt(() => (accept ? saveList(call.path, accept, name) : saveWithKey(call, name)));
      }}, text);
    }));
  });
}

export function buildHead(app: App) {
  const select = byId<HTMLSelectElement>('session');
  select.addEventListener('change', () => { void app.attempt(() => app.open(select.value)); });
  app.on(['sessions', 'session'], () => {
    select.replaceChildren(...app.sessions.map((s) => h('option', {value: s.id}, s.name ? `${s.name} – ${s.id}` : s.id)));
    if (!app.session) select.prepend(h('option', {value: ''}, 'No terrain'));
    select.value = app.session?.id ?? '';
    byId('version').textContent = app.session ? `version ${app.session.version}${app.isReadOnly ? ', read-only' : ''}` : '';
    document.title = app.session ? `${app.session.name || app.session.id} – Tinsmith` : 'Tinsmith';
  });
  buildDownloads(app, byId<HTMLDetailsElement>('download'));
  document.addEventListener('click', (event) => {
    for (const open of document.querySelectorAll<HTMLDetailsElement>('details.menu[open]')) if (!open.contains(event.target as Node)) open.open = false;
  });
  document.addEventListener('keydown', (event) => {
    if (event.key !== 'Escape') return;
    for (const open of document.querySelectorAll<HTMLDetailsElement>('details.menu[open]')) { open.open = false; open.querySelector('summary')!.focus(); }
  });
}

/** Tabs as the ARIA practices have them: arrows go from one to the next. */
export function buildTabs(app: App, tabs: [string, string, HTMLElement][]) {
  const list = byId('tabs'), bodies = byId('bodies');
  const heads = tabs.map(([name, title, body]) => {
    const head = h('button', {type: 'button', role: 'tab', id: `tab-${name}`, 'aria-controls': `body-${name}`, onclick: () => { app.openTab(name); }}, title);
    bodies.append(h('div', {role: 'tabpanel', id: `body-${name}`, 'aria-labelledby': `tab-${name}`}, body));
    return head;
  });
  list.append(...heads);
  list.addEventListener('keydown', (event) => {
    const step = {ArrowRight: 1, ArrowLeft: -1}[event.key];
    if (!step) return;
    const next = (tabs.findIndex(([name]) => name === app.tab) + step + tabs.length) % tabs.length;
    app.openTab(tabs[next][0]);
    heads[next].focus();
  });
  app.on(['tab'], () => {
    tabs.forEach(([name], i) => {
      const on = name === app.tab;
      heads[i].setAttribute('aria-selected', String(on));
      heads[i].tabIndex = on ? 0 : -1;
      byId(`body-${name}`).hidden = !on;
    });
  });
  app.tell('tab');
}
