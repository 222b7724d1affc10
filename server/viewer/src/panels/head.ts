// SPDX-License-Identifier: Apache-2.0
// The page's head: which terrain, which version, downloads; and the tabs below it.
import {base, json} from '../api';
import type {App} from '../app';
import {byId, h} from '../ui';

const FILES: [string, string, string][] = [
  ['mesh.glb', '/mesh.glb', 'GLB with Draco, for viewers'],
  ['mesh.glb?compression=none&up=z', '/mesh.glb', 'GLB, plain, z up'],
  ['mesh.json', '/mesh.json', 'JSON, full doubles'],
  ['polygons', '/polygons', 'GeoJSON of the polygons, on the ground'],
  ['mesh.obj', '/mesh.obj', 'OBJ'],
  ['mesh.xml', '/mesh.xml', 'LandXML'],
  ['mesh.gltf', '/mesh.gltf', 'glTF'],
];

export function buildHead(app: App) {
  const select = byId<HTMLSelectElement>('session');
  select.addEventListener('change', () => { void app.attempt(() => app.open(select.value)); });
  app.on(['sessions', 'session'], () => {
    select.replaceChildren(...app.sessions.map((s) => h('option', {value: s.id}, s.name ? `${s.id} – ${s.name}` : s.id)));
    if (!app.session) select.prepend(h('option', {value: ''}, 'No terrain'));
    select.value = app.session?.id ?? '';
    byId('version').textContent = app.session ? `version ${app.session.version}` : '';
    document.title = app.session ? `${app.session.name || app.session.id} – Tinsmith` : 'Tinsmith';
  });
  const menu = byId<HTMLDetailsElement>('download');
  let served: Set<string> | null = null;
  app.on(['session'], () => { menu.hidden = !app.session; });
  menu.addEventListener('toggle', () => {
    if (!menu.open || !app.session) return;
    void app.attempt(async () => {
      served ??= new Set(Object.keys((await json<{paths: object}>({method: 'GET', path: '/openapi.json'})).paths));
      const {id} = app.session!;
      menu.lastElementChild!.replaceChildren(...FILES.filter(([, path]) => served!.has(`/v1/sessions/{id}${path}`)).map(([file, path, text]) =>
        h('a', {href: `${base}/v1/sessions/${encodeURIComponent(id)}/${file}`, download: `${id}${path === '/polygons' ? '.geojson' : path.slice(path.lastIndexOf('.'))}`}, text)));
    });
  });
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
