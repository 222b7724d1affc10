// SPDX-License-Identifier: Apache-2.0
// How each version came about; back, forth, and what was there before.
import {json} from '../api';
import type {App} from '../app';
import type {Compare} from '../compare';
import {button, byId, h, number} from '../ui';

const WORDS: Record<string, string> = {
  created: 'loaded', polygons: 'integrated', edit: 'ground edited', locks: 'edges locked', undo: 'undone', redo: 'redone',
  polygon_removed: 'taken out',
};

export function buildHistory(app: App, compare: Compare): HTMLElement {
  const list = h('ol', {class: 'history', reversed: true});
  const stop = button('End the comparison', () => { void app.attempt(() => compare.load(null)); }, {class: 'small', hidden: true});
  const report = h('pre', {tabindex: 0, 'aria-label': 'Report', hidden: true});
  app.on(['history', 'compare'], () => {
    stop.hidden = compare.version === null;
    const changes = app.history?.changes ?? [];
    list.replaceChildren(...[...changes].reverse().map((change) => {
      const isNow = change.version === app.session?.version;
      const isBefore = change.version === compare.version;
      return h('li', {class: isNow ? 'now' : isBefore ? 'before' : ''},
        h('div', {}, h('b', {}, `v${change.version}`), ` ${WORDS[change.change] ?? change.change}`,
          change.of ? ` v${change.of}` : '', change.polygons.length ? `: ${change.polygons.join(', ')}` : '', isNow && h('em', {}, 'now')),
        h('small', {}, `${number(change.triangles)} triangles`),
        h('span', {class: 'buttons'}, !isNow && button('Compare', () => {
          void app.attempt(async () => {
            await compare.load(change.version);
            compare.swipe = true;
            app.tell('compare');
            app.say(`Version ${change.version} on the left, now on the right.`);
          });
        }, {class: 'small', 'aria-label': `Compare with version ${change.version}`, 'aria-pressed': String(isBefore)}),
        change.change !== 'created' && button('Report', () => {
          void app.attempt(async () => {
            const call = {method: 'GET', path: app.path(`/history/${change.version}`)};
            app.note(call);
            report.hidden = false;
            report.textContent = JSON.stringify(await json(call), null, 1);
          });
        }, {class: 'small', 'aria-label': `Report of version ${change.version}`})));
    }));
  });
  return h('div', {}, h('p', {class: 'soft'}, 'Every change has a version; undo and redo make new ones.'), stop, list, report);
}

/** Undo and redo of the page's head. */
export function buildUndo(app: App) {
  for (const name of ['undo', 'redo'] as const) {
    const element = byId<HTMLButtonElement>(name);
    const act = () => {
      void app.attempt(async () => {
        const {cost} = await app.edit({method: 'POST', path: app.path(`/${name}`)});
        app.say(`${name === 'undo' ? 'Undone' : 'Redone'} in ${Math.round(cost.ms)} milliseconds: version ${app.session?.version}.`);
      }, act);
    };
    element.addEventListener('click', act);
    app.on(['history', 'progress', 'session'], () => {
      const of = app.history?.[name] ?? null;
      element.disabled = of === null || app.busy > 0 || app.editing || app.isReadOnly;
      element.title = of === null ? `Nothing to ${name}` : `${name === 'undo' ? 'Undo' : 'Redo'} version ${of} (Ctrl+${name === 'undo' ? '' : 'Shift+'}Z)`;
    });
  }
}
