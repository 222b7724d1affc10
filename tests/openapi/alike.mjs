// SPDX-License-Identifier: Apache-2.0
// Whether an answer is the one that is shown, but for what differs from one time to the next.

const OF_THE_MOMENT = new Set(['memory_bytes', 'locate', 'integrate', 'improve', 'apply', 'request_id']);
/** Ids of the server's choice, births in tags. */
const RANDOM = /[0-9a-f]{8}-[0-9a-f]{4}-4[0-9a-f]{3}-[0-9a-f]{4}-[0-9a-f]{12}|[0-9a-f]{12}-[0-9a-f]{16}|[0-9a-f]{16}(?=-\d)/g;
/** Angles and areas may differ in their last digits from one library of mathematics to another. */
const ROUNDING = 1e-9;

/** The first difference, with its place; empty: none. */
export function alike(shown, real, at = '', name = '') {
  if (OF_THE_MOMENT.has(name)) return typeof shown === typeof real ? '' : `${at}: another type`;
  if (typeof shown === 'number' && typeof real === 'number')
    return Math.abs(shown - real) <= ROUNDING * Math.max(1, Math.abs(real)) ? '' : `${at}: shown is ${shown}, real ${real}`;
  if (typeof shown === 'string' && typeof real === 'string')
    return shown.replace(RANDOM, '') === real.replace(RANDOM, '') ? '' : `${at}: shown is ${shown}, real ${real}`;
  if (shown === null || real === null || typeof shown !== 'object' || typeof real !== 'object')
    return Object.is(shown, real) ? '' : `${at}: shown is ${JSON.stringify(shown)}, real ${JSON.stringify(real)}`;
  const [a, b] = [Object.keys(shown), Object.keys(real)];
  if (a.join() !== b.join()) return `${at}: shown has ${a}, the real one ${b}`;
  for (const key of a) {
    const found = alike(shown[key], real[key], `${at}/${key}`, key);
    if (found) return found;
  }
  return '';
}
