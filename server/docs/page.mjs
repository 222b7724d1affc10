// SPDX-License-Identifier: Apache-2.0
// Shows an OpenAPI 3.1 description. Text goes in as text, never as markup; nothing is loaded but
// openapi.json. `render` needs a document and the description only, so that it runs in a test too.

const METHODS = ['get', 'post', 'put', 'patch', 'delete'];
const FIRST_REFUSAL = 400;

/** Renders `api` into #contents and main of `dom`. */
export function render(dom, api) {
  const page = new Page(dom, api);
  dom.querySelector('#contents').replaceChildren(...page.contents());
  dom.querySelector('main').replaceChildren(page.intro(), ...page.sections(), page.problems(), page.schemas());
  dom.querySelector('#filter').addEventListener('input', (event) => filter(dom, event.target.value));
}

/** Hides what does not have all the words. */
export function filter(dom, text) {
  const words = text.toLowerCase().split(/\s+/).filter(Boolean);
  const has = (element) => words.every((word) => element.getAttribute('data-words').includes(word));
  for (const element of dom.querySelectorAll('[data-words]')) element.toggleAttribute('hidden', !has(element));
  for (const group of dom.querySelectorAll('[data-group]')) {
    const rest = [...group.querySelectorAll('[data-words]')].some((element) => !element.hasAttribute('hidden'));
    group.toggleAttribute('hidden', !rest);
  }
}

/** A curl line for one request; `content` is an example of its body. */
export function curlLine(origin, path, method, parameters, body, content) {
  const value = (p) => p.example ?? p.schema?.examples?.[0];
  const filled = path.replace(/\{(\w+)\}/g, (all, name) => {
    const example = value(parameters.find((p) => p.in === 'path' && p.name === name) ?? {});
    return example === undefined ? all : encodeURIComponent(example);
  });
  const query = parameters.filter((p) => p.in === 'query' && p.required).map((p) => `${p.name}=${value(p)}`).join('&');
  const words = ['curl'];
  // A POST has a length, be it that of nothing.
  if (method === 'post' && !content) words.push('-d', "''");
  else if (method !== 'get' && method !== 'post') words.push('-X', method.toUpperCase());
  const isForm = body === 'multipart/form-data';
  if (body && !isForm) words.push('-H', `'Content-Type: ${body}'`);
  if (isForm) {
    for (const [name, value] of Object.entries(content.value))
      words.push('-F', `'${name}=${JSON.stringify(value)};type=application/json'`);
  } else if (content?.externalValue) {
    words.push('--data-binary', `@${content.externalValue}`);
  } else if (content) {
    const text = typeof content.value === 'string' ? content.value : JSON.stringify(content.value);
    words.push('-d', `'${text}'`);
  }
  words.push(`'${origin}${filled}${query && '?' + query}'`);
  return words.join(' ');
}

class Page {
  constructor(dom, api) {
    this.dom = dom;
    this.api = api;
    this.origin = dom.location?.origin?.startsWith('http') ? dom.location.origin : 'http://127.0.0.1:8080';
    this.operations = Object.entries(api.paths).flatMap(([path, item]) =>
      METHODS.filter((method) => item[method]).map((method) => ({path, method, ...item[method]})));
  }

  /** An element. Children are elements or text; null and false are left out. */
  make(name, attributes, ...children) {
    const element = this.dom.createElement(name);
    for (const [key, value] of Object.entries(attributes ?? {})) element.setAttribute(key, value);
    element.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== false));
    return element;
  }

  /** Paragraphs, with `code`. */
  text(source) {
    return (source ?? '').split('\n\n').filter(Boolean).map((paragraph) => this.make('p', null, this.inline(paragraph)));
  }
  inline(source) {
    return (source ?? '').split('`').map((part, i) => (i % 2 ? this.make('code', null, part) : part));
  }

  /** What a "$ref" means, with what stands beside it. */
  resolve(value) {
    if (!value?.$ref) return value;
    const {$ref, ...beside} = value;
    const steps = $ref.slice(2).split('/').map((step) => step.replaceAll('~1', '/').replaceAll('~0', '~'));
    return {...this.resolve(steps.reduce((at, step) => at?.[step], this.api)), ...beside};
  }

  contents() {
    const group = (title, items) =>
      this.make('div', {'data-group': ''}, this.make('h2', null, title), this.make('ul', null, items));
    const entry = (operation) => this.make('li', {'data-words': words(operation)},
      this.make('a', {href: `#${operation.operationId}`}, this.method(operation.method), operation.summary));
    const plain = (href, title) => this.make('li', null, this.make('a', {href}, title));
    return [
      ...this.api.tags.map((tag) => group(tag.name, this.operations.filter((o) => o.tags?.includes(tag.name)).map(entry))),
      this.make('div', null, this.make('h2', null, 'Reference'),
        this.make('ul', null, plain('#problems', 'Problems'), plain('#schemas', 'Schemas'))),
    ];
  }

  intro() {
    const {title, version, summary, description, license} = this.api.info;
    return this.make('header', null, this.make('h1', null, title),
      this.make('p', {class: 'lead'}, summary), this.text(description),
      this.make('p', {class: 'soft'}, `Version ${version} of the interface, `, license && `${license.name}, `,
        this.make('a', {href: 'openapi.json'}, 'openapi.json'), ` (OpenAPI ${this.api.openapi})`));
  }

  sections() {
    return this.api.tags.map((tag) => this.make('section', {id: `tag-${tag.name}`, 'data-group': ''},
      this.make('h2', null, tag.name), this.text(tag.description),
      this.operations.filter((o) => o.tags?.includes(tag.name)).map((operation) => this.operation(operation))));
  }

  method(method) {
    return this.make('span', {class: `method ${method}`}, method === 'delete' ? 'DEL' : method.toUpperCase());
  }

  operation(operation) {
    const parameters = (operation.parameters ?? []).map((parameter) => this.resolve(parameter));
    const answers = Object.entries(operation.responses).map(([status, answer]) => [status, this.resolve(answer)]);
    const refused = answers.filter(([status]) => Number(status) >= FIRST_REFUSAL);
    const usual = Object.keys(answers[0][1].headers ?? {});
    return this.make('article', {class: 'card', id: operation.operationId, 'data-words': words(operation)},
      this.make('div', {class: 'target'}, this.method(operation.method),
        this.make('a', {class: 'path', href: `#${operation.operationId}`}, operation.path)),
      this.make('h3', null, operation.summary), this.text(operation.description),
      this.parameters(parameters), this.body(operation, parameters),
      this.make('h4', null, 'Answers'),
      answers.filter((answer) => !refused.includes(answer)).map(([status, answer]) => this.answer(status, answer)),
      refused.length > 0 && this.make('details', {class: 'refusals'},
        this.make('summary', null, `Refusals: ${refused.map(([status]) => status).join(', ')}`),
        this.table(refused.map(([status, answer]) => [
          this.make('span', {class: 'status refused'}, status), this.refusal(answer, usual)]))));
  }

  parameters(parameters) {
    if (parameters.length === 0) return null;
    const row = (p) => [
      [this.make('code', null, p.name), p.required && this.make('span', {class: 'must'}, ' required'),
        this.make('div', {class: 'soft'}, p.in)],
      [this.make('span', {class: 'type'}, this.type(p.schema)), this.text(p.description)]];
    // What every operation has, and headers, are looked up less often than the rest.
    const [asked, headers] = [parameters.filter((p) => p.in !== 'header'), parameters.filter((p) => p.in === 'header')];
    return [
      asked.length > 0 && [this.make('h4', null, 'Parameters'), this.table(asked.map(row))],
      headers.length > 0 && this.make('details', null,
        this.make('summary', null, `Headers: ${headers.map((p) => p.name).join(', ')}`), this.table(headers.map(row))),
    ];
  }

  body(operation, parameters) {
    const body = this.resolve(operation.requestBody);
    const curl = (type, example) => this.make('pre', {class: 'curl'},
      curlLine(this.origin, operation.path, operation.method, parameters, type, example));
    if (!body) return curl();
    return [this.make('h4', null, 'Body', body.required && this.make('span', {class: 'must'}, ' required')),
      this.text(body.description),
      Object.entries(body.content).map(([type, media]) => [
        this.media(type, media),
        Object.values(media.examples ?? {}).map((example) => this.make('details', null,
          this.make('summary', null, `Example: ${example.summary ?? type}`),
          curl(type, example), example.value !== undefined && this.json(example.value)))])];
  }

  answer(status, answer) {
    const headers = Object.keys(answer.headers ?? {});
    return [
      this.make('p', null, this.make('span', {class: 'status'}, `${status} `), this.inline(answer.description)),
      Object.entries(answer.content ?? {}).map(([type, media]) => [
        this.media(type, media),
        Object.entries(media.examples ?? {}).map(([name, example]) => this.make('details', null,
          this.make('summary', null, `Example: ${name}`), this.json(example.value)))]),
      headers.length > 0 && this.make('details', null,
        this.make('summary', null, `Headers of the answer: ${headers.join(', ')}`),
        this.table(headers.map((name) => [this.make('code', null, name),
          this.inline(this.resolve(answer.headers[name]).description)])))];
  }

  /** `usual` are the headers of the other answers. */
  refusal(answer, usual) {
    const headers = Object.keys(answer.headers ?? {}).filter((name) => !usual.includes(name));
    const media = answer.content?.['application/problem+json'];
    const types = media?.schema?.properties?.type?.enum ?? [];
    return [this.make('p', null, this.inline(answer.description)),
      this.make('p', {class: 'soft'}, types.map((type) => [
        this.make('a', {href: `#problem-${wordOf(type)}`}, this.make('code', null, wordOf(type))), ' ']),
        headers.length > 0 && `with ${headers.join(', ')}`),
      Object.entries(media?.examples ?? {}).map(([name, example]) => this.make('details', null,
        this.make('summary', null, `Example: ${name}`), this.json(example.value)))];
  }

  media(type, media) {
    return this.make('p', null, this.make('code', null, type), ' ',
      this.make('span', {class: 'type'}, this.type(media.schema)),
      !media.schema?.$ref && media.schema?.description && [' ', this.inline(media.schema.description)]);
  }

  /** A schema in a line. Named ones are links. */
  type(schema) {
    if (!schema) return 'anything';
    const named = /^#\/components\/schemas\/([^/]+)$/.exec(schema.$ref ?? '');
    if (named) return this.make('a', {href: `#schema-${named[1]}`}, named[1]);
    const s = this.resolve(schema);
    const joined = (list) => list.flatMap((one, i) => (i ? [' or ', this.type(one)] : [this.type(one)]));
    const basic = s.const !== undefined ? JSON.stringify(s.const)
      : s.enum ? s.enum.map((value) => JSON.stringify(value)).join(' | ')
      : s.oneOf && !s.properties && s.oneOf.every((one) => one.$ref || one.type) ? joined(s.oneOf)
      : s.type === 'array' ? ['array of ', this.type(s.items)]
      : [s.type ?? 'bytes'].flat().join(' or ');
    return [basic, bounds(s)];
  }

  /** The properties of a schema, those within them too. */
  properties(schema) {
    const s = this.resolve(schema);
    const inner = s?.type === 'array' ? s.items : s;
    const own = inner?.$ref ? null : inner;
    const rows = Object.entries(own?.properties ?? {}).map(([name, property]) => [
      [this.make('code', null, name), own.required?.includes(name) && this.make('span', {class: 'must'}, ' required')],
      [this.make('span', {class: 'type'}, this.type(property)), this.text(property.description),
        property.$ref ? null : this.properties(property)]]);
    const choices = own?.oneOf?.filter((one) => one.properties).map((one) => this.properties(one));
    if (rows.length === 0 && !choices?.length) return null;
    return [rows.length > 0 && this.table(rows),
      choices?.length > 0 && [this.make('p', {class: 'soft'}, 'One of:'), choices]];
  }

  problems() {
    const all = this.resolve(this.api.components.schemas.ProblemType)?.oneOf ?? [];
    return this.make('section', {id: 'problems'}, this.make('h2', null, 'Problems'),
      this.make('p', null, 'The ', this.make('code', null, 'type'), ' of a refusal is ',
        this.make('code', null, 'urn:tinsmith:problem:'), ' and one of these words.'),
      this.table(all.map((type) => [
        this.make('code', {id: `problem-${wordOf(type.const)}`}, wordOf(type.const)),
        [this.make('span', {class: 'status refused'}, `${type['x-status']} `), type.title]])));
  }

  schemas() {
    return this.make('section', {id: 'schemas'}, this.make('h2', null, 'Schemas'),
      Object.entries(this.api.components.schemas).map(([name, schema]) => this.make('article', {class: 'card', id: `schema-${name}`},
        this.make('h3', null, name, ' ', this.make('span', {class: 'type'}, this.type(schema))),
        this.text(schema.description), this.properties(schema),
        schema.additionalProperties === false && this.make('p', {class: 'soft'}, 'No other members.'))));
  }

  table(rows) {
    return this.make('table', null, rows.map((cells) => this.make('tr', null, cells.map((cell) => this.make('td', null, cell)))));
  }

  json(value) {
    return this.make('pre', null, JSON.stringify(value, null, 1)
      // Positions and other lists of numbers stand in one line.
      .replace(/\[\s+(-?[\d.eE+-]+(?:,\s+-?[\d.eE+-]+)*)\s+\]/g, (all, list) => `[${list.replace(/\s+/g, ' ')}]`));
  }
}

function words(operation) {
  return `${operation.method} ${operation.path} ${operation.operationId} ${operation.summary}`.toLowerCase();
}

function wordOf(type) {
  return type.slice(type.lastIndexOf(':') + 1);
}

/** What a value may be beside its type. */
function bounds(s) {
  const told = [
    s.minimum !== undefined && `from ${s.minimum}`, s.exclusiveMinimum !== undefined && `above ${s.exclusiveMinimum}`,
    s.maximum !== undefined && `up to ${s.maximum}`, s.maxLength !== undefined && `at most ${s.maxLength} characters`,
    s.minItems !== undefined && s.minItems === s.maxItems && `of ${s.minItems}`,
    s.default !== undefined && `default ${JSON.stringify(s.default)}`,
  ].filter(Boolean);
  return told.length > 0 ? `, ${told.join(', ')}` : '';
}

async function start(dom) {
  try {
    const answer = await fetch('openapi.json');
    if (!answer.ok) throw new Error(`openapi.json: status ${answer.status}`);
    render(dom, await answer.json());
    // The fragment was there before its target: go there again.
    if (dom.location.hash) dom.location.replace(dom.location.hash);
  } catch (error) {
    dom.querySelector('#status').textContent = `The description could not be shown: ${error.message}`;
  }
}

if (globalThis.document) start(globalThis.document);
