// SPDX-License-Identifier: Apache-2.0
// What is served as /openapi.json, by a linter that others use too: no error, no warning.

import assert from 'node:assert/strict';
import {spawnSync} from 'node:child_process';
import {mkdtempSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {dirname, join} from 'node:path';
import {after, before, test} from 'node:test';
import {fileURLToPath} from 'node:url';
import {ask, startServer} from '../support/program.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const folder = mkdtempSync(join(tmpdir(), 'tinsmith-openapi-'));
let server, text;

before(async () => {
  server = await startServer();
  text = JSON.stringify(await (await ask(`${server.origin}/openapi.json`)).json(), null, 1);
});
after(async () => {
  rmSync(folder, {recursive: true});
  await server.stop();
});

function lint(content) {
  const file = join(folder, 'openapi.json');
  writeFileSync(file, content);
  const run = spawnSync(process.execPath,
    [join(here, 'node_modules/@redocly/cli/bin/cli.js'), 'lint', '--config', join(here, 'redocly.yaml'), file],
    {encoding: 'utf8', env: {...process.env, REDOCLY_TELEMETRY: 'off', REDOCLY_SUPPRESS_UPDATE_NOTICE: 'true', CI: 'true'}});
  return {status: run.status, said: run.stdout + run.stderr};
}

test('the description is good OpenAPI 3.1', () => {
  const {status, said} = lint(text);
  assert.equal(status, 0, said);
  assert.match(said, /Your API description is valid/, said);
  assert.doesNotMatch(said, /warning/i, said);
});

test('every component is used', () => {
  const references = new Set([...text.matchAll(/"#\/components\/(\w+\/\w+)/g)].map((match) => match[1]));
  const description = JSON.parse(text);
  // These are named, not referred to.
  for (const of of [description, ...Object.values(description.paths).flatMap((path) => Object.values(path))]) {
    for (const scheme of (of.security ?? []).flatMap(Object.keys)) references.add(`securitySchemes/${scheme}`);
  }
  const components = Object.entries(description.components)
    .flatMap(([kind, named]) => Object.keys(named).map((name) => `${kind}/${name}`));
  assert.deepEqual(components.filter((name) => !references.has(name)), []);
});

test('a reference to nowhere is found', () => {
  const {status, said} = lint(text.replaceAll('#/components/schemas/Report"', '#/components/schemas/Raport"'));
  assert.equal(status, 1);
  assert.match(said, /Can't resolve \$ref/);
});
