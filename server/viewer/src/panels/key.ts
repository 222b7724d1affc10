// SPDX-License-Identifier: Apache-2.0
// Asks for the key of a server that wants one, and forgets it.
import {access, isPossibleKey} from '../access';
import {button, byId, h} from '../ui';

export function buildKey() {
  const key = h('input', {type: 'password', id: 'key', autocomplete: 'off', spellcheck: 'false', 'aria-describedby': 'key-why'});
  const why = h('p', {id: 'key-why'});
  const dialog = h('dialog', {id: 'ask-key', 'aria-labelledby': 'key-title'});
  let answer: (isGiven: boolean) => void = () => {};
  const form = h('form', {onsubmit: (event: Event) => {
    event.preventDefault();
    const given = key.value.trim();
    if (!isPossibleKey(given)) {
      key.setAttribute('aria-invalid', 'true');
      why.textContent = given ? 'That is no key: a key has letters, digits and signs, and no blanks.' : 'Type or paste the key.';
      key.focus();
      return;
    }
    access.keep(given);
    end(true);
  }}, h('h2', {id: 'key-title'}, 'This server asks for a key'), why,
  h('label', {class: 'field'}, h('span', {}, 'Key'), key),
  h('p', {class: 'soft'}, 'It is kept for this tab until you close it or forget it, and is sent to this server alone.'),
  h('div', {class: 'buttons'}, h('button', {type: 'submit', class: 'main'}, 'Use the key'), button('Cancel', () => { end(false); })));
  dialog.append(form);
  document.body.append(dialog);

  const end = (isGiven: boolean) => {
    // Nothing of it stays in the page.
    key.value = '';
    dialog.close();
    answer(isGiven);
  };
  dialog.addEventListener('cancel', (event) => { event.preventDefault(); end(false); });

  access.ask = (wasRefused) => new Promise((resolve) => {
    answer = resolve;
    key.removeAttribute('aria-invalid');
    why.textContent = wasRefused ? 'It does not take the key that it was given. Is it whole, and still valid?' : 'Whoever runs the server gives you one.';
    dialog.showModal();
    key.focus();
  });

  const forget = byId<HTMLButtonElement>('forget');
  forget.addEventListener('click', () => {
    access.keep('');
    // With all that it has shown.
    location.reload();
  });
  access.changed = () => { forget.hidden = access.key === ''; };
  access.changed();
}
