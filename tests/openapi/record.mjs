// SPDX-License-Identifier: Apache-2.0
// "npm run record": writes the answers that the description shows, api/openapi/answers.json and
// refusals.json, as the program gives them now. The tests fail when they are others.

import {writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {project, startServer} from '../support/program.mjs';
import {alike} from './alike.mjs';
import {Description} from './description.mjs';
import {Client, exampleCases, REFUSALS, STRICT, STRICT_REFUSALS} from './requests.mjs';

/** Longer ones say nothing more; what is shown is for people. */
const LONGEST = 1400;
const WIDTH = 116;
/** One is what it stands in, the other depends on what was done before. */
const NOT_SHOWN = ['getDescription', 'listJobs'];

/** JSON with short things in one line. */
function text(value, indent = '') {
  const short = JSON.stringify(value, null, 1).replace(/\n\s*/g, ' ').replace(/([[{]) /g, '$1').replace(/ ([\]}])/g, '$1');
  if (value === null || typeof value !== 'object' || indent.length + short.length <= WIDTH) return short;
  const inner = indent + '  ';
  const [open, close, items] = Array.isArray(value)
    ? ['[', ']', value.map((one) => text(one, inner))]
    : ['{', '}', Object.entries(value).map(([key, one]) => `${JSON.stringify(key)}: ${text(one, inner)}`)];
  return `${open}\n${items.map((item) => inner + item).join(',\n')}\n${indent}${close}`;
}

/** What is shown already stays where it differs by times and ids alone. */
function put(part, {operation, status, type, json}, name) {
  const shown = operation.responses[status]?.content[type].examples?.[name]?.value;
  ((part[operation.operationId] ??= {})[status] ??= {})[name] = shown && alike(shown, json) === '' ? shown : json;
}

function write(name, part) {
  writeFileSync(join(project, 'api/openapi', name), text({'x-recorded': part}) + '\n');
}

const server = await startServer();
const strict = await startServer(...STRICT);
const description = await Description.of(server.origin);
const client = new Client(server.origin, description);

const answers = {};
for (const {id, values, type, name, body, operation} of exampleCases(description)) {
  await client.prepare(id);
  const answer = await client.send(id, {values, body, headers: operation.responses['406'] ? {Accept: type} : {}});
  const isShown = answer.json !== undefined && answer.bytes.length <= LONGEST && !NOT_SHOWN.includes(id);
  // The same answer by another name of its type is not shown twice.
  const isFirst = Object.keys(operation.responses[answer.status]?.content ?? {}).find((one) => one.includes('json')) === answer.type;
  if (isShown && isFirst) put(answers, answer, name);
}
write('answers.json', answers);

const refusals = {};
await client.prepare('getSession');
for (const [word, id, request] of REFUSALS) put(refusals, await client.send(id, request), word);
const other = new Client(strict.origin, description);
await other.example('putSession');
for (const at of [[5, 4], [7, 4]])
  await other.send('integratePolygons', {
    headers: {'If-Match': '*'}, body: {type: 'application/json', example: {value: {type: 'Point', coordinates: at}}}});
for (const [word, id, request] of STRICT_REFUSALS) {
  if (word === 'nothing-to-undo') await other.send('undo', {headers: {'If-Match': '*'}});
  put(refusals, await other.send(id, request), word);
}
write('refusals.json', refusals);
await server.stop();
await strict.stop();
