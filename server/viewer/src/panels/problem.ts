// SPDX-License-Identifier: Apache-2.0
// What was refused: its words, and each fault with its place on the terrain.
import type {App} from '../app';
import {button, byId, h, number} from '../ui';
import type {View} from '../view';

export function buildProblem(app: App, view: View) {
  const box = byId('problem');
  app.on(['problem'], () => {
    const {problem} = app;
    box.replaceChildren();
    if (!problem) return;
    const faults = problem.errors.slice(0, 20).map((fault) => {
      const at = fault.coordinate;
      return h('li', {}, h('code', {}, fault.code), ' ', fault.detail === problem.detail ? null : fault.detail, ' ',
        fault.pointer && h('code', {class: 'soft'}, fault.pointer), ' ',
        at && button(`Show ${number(at[0], 2)}, ${number(at[1], 2)}`, () => {
          const b = app.session!.bounds;
          view.goTo(at[0], at[1], Math.max(b[3] - b[0], b[4] - b[1]) / 6);
        }, {class: 'small'}));
    });
    const {retry, retryText} = problem;
    box.append(h('div', {class: problem.conflict ? 'told conflict' : 'told'},
      h('b', {}, problem.title), h('p', {}, problem.detail), faults.length > 0 && h('ul', {}, ...faults),
      h('div', {class: 'buttons'}, retry && button(retryText, retry, {class: 'main'}),
        button('Dismiss', () => { app.problem = null; app.tell('problem'); }))));
    box.scrollIntoView({block: 'nearest'});
  });
}
