// SPDX-License-Identifier: Apache-2.0
// The last request as a line for the shell, and those before it.
import {curlLine} from '../api';
import type {App} from '../app';
import {button, byId, h} from '../ui';

export function buildCalls(app: App) {
  const line = h('code', {tabindex: 0, 'aria-label': 'curl line of the last request'});
  const copy = button('Copy', () => { void put(line.textContent ?? ''); });
  const older = h('details', {class: 'menu up'}, h('summary', {}, 'Earlier'), h('div', {class: 'sheet'}));
  byId('calls').append(h('span', {class: 'prompt', 'aria-hidden': 'true'}, '$'), line, copy, older);

  async function put(text: string) {
    try {
      await navigator.clipboard.writeText(text);
      app.say('Copied.');
      copy.textContent = 'Copied';
    } catch {
      // Pages that are not secure may not write there: the line is selected for the reader.
      getSelection()?.selectAllChildren(line);
      copy.textContent = 'Selected';
    }
    setTimeout(() => { copy.textContent = 'Copy'; }, 1500);
  }
  older.hidden = true;
  app.on(['calls'], () => {
    line.textContent = app.calls[0] ? curlLine(app.calls[0]) : '';
    older.lastElementChild!.replaceChildren(...app.calls.slice(1).map((call) => h('div', {class: 'old'},
      h('code', {}, curlLine(call)), button('Copy', () => { void put(curlLine(call)); }, {'aria-label': `Copy ${call.method} ${call.path}`}))));
    older.hidden = app.calls.length < 2;
  });
}
