// SPDX-License-Identifier: Apache-2.0
// Elements and numbers. Text goes in as text, never as markup.

type Child = Node | string | null | undefined | false;
type Attributes = Record<string, string | number | boolean | ((event: any) => void) | null | undefined>;

export function h<K extends keyof HTMLElementTagNameMap>(name: K, attributes: Attributes = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (typeof value === 'function') element.addEventListener(key.slice(2), value);
    else if (value === true) element.setAttribute(key, '');
    else if (value !== false && value !== null && value !== undefined) element.setAttribute(key, String(value));
  }
  element.append(...children.filter((child): child is Node | string => child !== null && child !== undefined && child !== false));
  return element;
}

export function svg(name: string, attributes: Record<string, string | number>, ...children: (Node | string)[]): SVGElement {
  const element = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
  element.append(...children);
  return element;
}

export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
  return document.getElementById(id) as T;
}

export function button(text: string, onclick: () => void, attributes: Attributes = {}) {
  return h('button', {type: 'button', onclick, ...attributes}, text);
}

/** A labelled control; `hint` stands behind it. */
export function field(label: string, control: HTMLElement, hint = '') {
  return h('label', {class: 'field'}, h('span', {}, label), control, hint ? h('small', {}, hint) : null);
}

export function select(options: [string, string][], value: string, onchange: (value: string) => void, attributes: Attributes = {}) {
  const element = h('select', {onchange: () => { onchange(element.value); }, ...attributes}, ...options.map(([key, text]) => h('option', {value: key}, text)));
  element.value = value;
  return element;
}

export function input(value: string, oninput: (value: string) => void, attributes: Attributes = {}) {
  const element = h('input', {type: 'text', inputmode: 'decimal', autocomplete: 'off', spellcheck: 'false', oninput: () => { oninput(element.value); }, ...attributes});
  element.value = value;
  return element;
}

/** Rows of a table of figures: title, then a value for each column. */
export function figures(caption: string, columns: string[], rows: [string, ...(string | null)[]][]) {
  return h('table', {class: 'figures'}, h('caption', {}, caption),
    columns.length > 0 && h('thead', {}, h('tr', {}, h('td'), ...columns.map((column) => h('th', {scope: 'col'}, column)))),
    h('tbody', {}, ...rows.map(([title, ...cells]) => h('tr', {}, h('th', {scope: 'row'}, title), ...cells.map((cell) => h('td', {}, cell ?? '–'))))));
}

/** 12345.6 as "12,345.6". */
export function number(value: number, digits = 0): string {
  return value.toLocaleString('en', {minimumFractionDigits: digits, maximumFractionDigits: digits});
}

/** With as many digits as say something. */
export function brief(value: number): string {
  const size = Math.abs(value);
  if (size === 0) return '0';
  if (!Number.isFinite(value)) return '–';
  if (size < 1e-3 || size >= 1e12) {
    const [digits, power] = value.toExponential(1).split('e');
    return `${digits}·10${[...power.replace('+', '')].map((c) => (c === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'[Number(c)])).join('')}`;
  }
  return number(value, size >= 1000 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : 3);
}

export function shortUnit(unit: string): string {
  return unit.startsWith('met') ? 'm' : /foot|feet/.test(unit) ? 'ft' : unit;
}

/** A millimetre in the session's unit, to five digits. */
export function millimetre(unit: string): string {
  const metres = unit === 'foot' ? 0.3048 : unit === 'US survey foot' ? 1200 / 3937 : 1;
  return String(Number((0.001 / metres).toPrecision(5)));
}

export function areaText(area: number, unit: string): string {
  const u = shortUnit(unit);
  return u === 'm' && area >= 1e5 ? `${number(area / 1e6, 3)} km²` : `${brief(area)} ${u}²`;
}

export function bytesText(bytes: number): string {
  return bytes < 1000 ? `${bytes} B` : bytes < 1e6 ? `${number(bytes / 1000, 1)} kB` : `${number(bytes / 1e6, 1)} MB`;
}
