// SPDX-License-Identifier: Apache-2.0
// The page of /docs: its own script, run over the real description with no browser. Whatever the
// description has stands on the page, and the page's curl lines work when pasted.

import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, test} from 'node:test';
import {parseHTML} from 'linkedom';
import {ask, project, startServer} from '../support/program.mjs';
import {Description} from './description.mjs';
import {Client, successOf} from './requests.mjs';

const server = await startServer();
const folder = mkdtempSync(join(tmpdir(), 'tinsmith-docs-'));
after(async () => {
  rmSync(folder, {recursive: true});
  await server.stop();
});

const text = async (path) => (await ask(server.origin + path)).text();
const description = await Description.of(server.origin);
const client = new Client(server.origin, description);
writeFileSync(join(folder, 'page.mjs'), await text('/docs/page.mjs'));
const {filter, render} = await import(join(folder, 'page.mjs'));

const html = await text('/docs');
function page(document = description.document) {
  const {document: dom} = parseHTML(html);
  dom.location = {origin: server.origin};
  render(dom, document);
  return dom;
}
const dom = page();
const said = dom.querySelector('main').textContent;

test('nothing is loaded from elsewhere, and the policy forbids it', async () => {
  const policy = (await ask(`${server.origin}/docs`)).headers.get('content-security-policy');
  assert.match(policy, /^default-src 'none'; script-src 'self'; style-src 'self';/);
  assert.doesNotMatch(policy, /unsafe|\*|https?:/);
  for (const element of parseHTML(html).document.querySelectorAll('[src], link[href]')) {
    const target = element.getAttribute('src') ?? element.getAttribute('href');
    assert.match(target, /^(docs\/page\.|data:,$)/);
    if (!target.startsWith('data:')) assert.equal((await ask(`${server.origin}/${target}`)).status, 200);
  }
  assert.doesNotMatch(html, /<script[^>]*>[^<]|style=|onload=/, 'no script and no style in the page itself');
  assert.equal(dom.querySelectorAll('[style]').length, 0);
});

test('every operation stands there whole', () => {
  for (const operation of description.operations) {
    const card = dom.getElementById(operation.operationId);
    assert.ok(card, operation.operationId);
    assert.ok(dom.querySelector(`#contents a[href="#${operation.operationId}"]`));
    const wanted = [operation.path, operation.summary, ...Object.keys(operation.responses),
      ...operation.parameters.map((p) => description.resolve(p).name),
      ...Object.values(operation.responses).flatMap((answer) => Object.keys(answer.headers ?? {})),
      ...Object.entries(operation.responses).filter(([status]) => status < 400)
        .flatMap(([, answer]) => Object.keys(answer.content ?? {})),
      ...description.bodies(operation).map(({type}) => type).filter(Boolean)];
    for (const word of wanted) assert.ok(card.textContent.includes(word), `${operation.operationId}: ${word}`);
  }
});

test('every schema and every problem stands there', () => {
  for (const [name, schema] of Object.entries(description.document.components.schemas)) {
    const card = dom.getElementById(`schema-${name}`);
    for (const property of Object.keys(schema.properties ?? {}))
      assert.ok(card.textContent.includes(property), `${name}.${property}`);
  }
  for (const {const: type, title} of description.document.components.schemas.ProblemType.oneOf) {
    assert.ok(dom.getElementById(`problem-${type.split(':').pop()}`), type);
    assert.ok(said.includes(title));
  }
  assert.doesNotMatch(said, /undefined|\[object|NaN/);
});

test('links within the page lead somewhere', () => {
  for (const link of dom.querySelectorAll('a[href^="#"]'))
    assert.ok(dom.getElementById(link.getAttribute('href').slice(1)), link.getAttribute('href'));
});

test('text is never taken for markup', () => {
  const hostile = structuredClone(description.document);
  hostile.info.description = '<img src=x onerror=alert(1)> `<b>`';
  const {document: shown} = {document: page(hostile)};
  assert.equal(shown.querySelectorAll('main img, main b').length, 0);
  assert.ok(shown.querySelector('main').textContent.includes('<img src=x'));
});

test('the filter hides what has not all the words', () => {
  const shown = page();
  const visible = () => [...shown.querySelectorAll('article[data-words]')].filter((one) => !one.hasAttribute('hidden'));
  filter(shown, 'mesh GET');
  assert.deepEqual(visible().map((one) => one.id).sort(), ['getMesh', 'getMeshGlb', 'getMeshGltf', 'getMeshJson', 'getMeshObj', 'getMeshXml']);
  assert.ok(shown.getElementById('tag-Questions').hasAttribute('hidden'));
  filter(shown, '');
  assert.equal(visible().length, description.operations.length);
});

test('the curl lines work when pasted', async (t) => {
  for (const card of dom.querySelectorAll('article[data-words]')) {
    for (const line of card.querySelectorAll('pre.curl')) {
      const command = line.textContent;
      // What has no example is for people to fill in.
      if (/\{id\}/.test(command)) continue;
      await t.test(command, async () => {
        await client.prepare(card.id);
        const status = execFileSync('bash', ['-c', `${command} --silent --output /dev/null --write-out '%{http_code}'`],
          {cwd: project, encoding: 'utf8'});
        assert.equal(status, successOf(description.operation(card.id)));
      });
    }
  }
});
