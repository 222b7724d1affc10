// SPDX-License-Identifier: Apache-2.0
// Every example of /openapi.json, sent to the program: the status, the media type and the headers are
// those described, the body is what its schema says, and the answer that is shown is the real one.

import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {ask, startServer} from '../support/program.mjs';
import {Description} from './description.mjs';
import {alike} from './alike.mjs';
import {Client, ELSEWHERE, exampleCases, REFUSALS, STRICT, STRICT_REFUSALS} from './requests.mjs';

const server = await startServer();
const strict = await startServer(...STRICT);
const description = await Description.of(server.origin);
const client = new Client(server.origin, description);
const seen = new Set();
/** Work that does not stop within the server's patience is not to be had here. */
const TOO_QUICK = 'deleteJob 202';

after(async () => {
  await server.stop();
  await strict.stop();
});

/** Fails unless the answer is as described; remembers that there was one. */
function check(answer) {
  const {operation, status, type, json} = answer;
  const told = operation.responses[status] ?? operation.responses[`${status[0]}XX`];
  assert.ok(told, `${operation.operationId}: status ${status} is not described: ${answer.bytes}`);
  // Of a job's result no more is described.
  if (!operation.responses[status]) return void seen.add(`${operation.operationId} ${status[0]}XX`);
  for (const name of ['x-request-id', 'vary', 'etag', 'location', 'link'])
    if (answer.headers.has(name))
      assert.ok(Object.keys(told.headers).some((known) => known.toLowerCase() === name), `${operation.operationId}: ${name}`);
  if (answer.bytes.length === 0) return void seen.add(`${operation.operationId} ${status}`);
  const media = told.content[type];
  assert.ok(media, `${operation.operationId} ${status}: ${type} is not described`);
  if (json !== undefined) assert.equal(description.faults(media.schema, json), '', JSON.stringify(json).slice(0, 2000));
  seen.add(`${operation.operationId} ${status} ${type}`);
}

for (const {id, values, type, name, body, status, operation} of exampleCases(description)) {
  test(`${id} ${name} as ${type}`, async () => {
    if (body.example?.value) assert.equal(description.faults(body.schema, body.example.value), '');
    await client.prepare(id);
    const headers = operation.responses['406'] ? {Accept: type} : {};
    const answer = await client.send(id, {values, headers, body});
    assert.equal(answer.status, status, answer.bytes.toString('utf8'));
    assert.equal(answer.type, type);
    check(answer);
    const shown = operation.responses[status]?.content[type].examples?.[name];
    if (shown) assert.equal(alike(shown.value, answer.json), '');
    if (operation.responses['202'] && id !== 'deleteJob') await later(id, {values, headers, body}, answer);
    const etag = answer.headers.get('etag');
    if (!operation.responses['304'] || !etag) return;
    const again = await client.send(id, {values, headers: {...headers, 'If-None-Match': etag}});
    if ('since' in values) return check(again);
    assert.equal(again.status, '304');
    check(again);
  });
}

/** The same as a job, whose result is the same answer. */
async function later(id, {values, headers, body}, first) {
  await client.prepare(id);
  const accepted = await client.send(id, {values, headers: {...headers, Prefer: 'respond-async'}, body});
  assert.equal(accepted.status, '202');
  check(accepted);
  const job = await client.end(accepted);
  assert.equal(description.faults({$ref: '#/components/schemas/Job'}, job), '');
  assert.equal(job.state, 'done', JSON.stringify(job));
  assert.equal(String(job.status), first.status);
  const result = await ask(server.origin + job.result);
  assert.equal(String(result.status), first.status);
  assert.equal(result.headers.get('content-type'), first.type);
  if (first.json) assert.equal(alike(first.json, await result.json()), '');
}

async function refused(to, [word, id, request]) {
  const answer = await to.send(id, request);
  assert.equal(answer.json?.type, `urn:tinsmith:problem:${word}`, answer.bytes.toString('utf8'));
  check(answer);
  const shown = answer.operation.responses[answer.status].content[answer.type].examples?.[word];
  if (shown) assert.equal(alike(shown.value, answer.json), '');
}

test('refusals are as described', async (t) => {
  await client.prepare('getSession');
  for (const refusal of REFUSALS) await t.test(refusal[0], () => refused(client, refusal));
});

test('refusals of a server that allows little are as described', async (t) => {
  const other = new Client(strict.origin, description);
  await other.example('putSession');
  const point = (at) => ({type: 'application/json', example: {value: {type: 'Point', coordinates: at}}});
  for (const at of [[5, 4], [7, 4]])
    assert.equal((await other.send('integratePolygons', {headers: {'If-Match': '*'}, body: point(at)})).status, '200');
  for (const refusal of STRICT_REFUSALS) {
    await t.test(refusal[0], async () => {
      if (refusal[0] === 'nothing-to-undo') await other.send('undo', {headers: {'If-Match': '*'}});
      await refused(other, refusal);
    });
  }
});

test('every problem is provoked here or elsewhere', () => {
  const here = [...REFUSALS, ...STRICT_REFUSALS].map(([word]) => word);
  const all = description.document.components.schemas.ProblemType.oneOf.map((type) => type.const.split(':').pop());
  assert.deepEqual(all.filter((word) => !here.includes(word) && !(word in ELSEWHERE)), []);
  assert.deepEqual([...here, ...Object.keys(ELSEWHERE)].filter((word) => !all.includes(word)), []);
});

test('everything that is described was seen, but refusals', () => {
  const wanted = description.operations.flatMap((operation) => Object.entries(operation.responses)
    .filter(([status]) => status < '4' && !`${operation.operationId} ${status}`.startsWith(TOO_QUICK))
    .flatMap(([status, answer]) => {
      const types = Object.keys(answer.content ?? {});
      return types.length > 0 ? types.map((type) => `${operation.operationId} ${status} ${type}`) : [`${operation.operationId} ${status}`];
    }));
  assert.deepEqual(wanted.filter((one) => !seen.has(one)), []);
});

test('the validator finds what is wrong', () => {
  const schema = {$ref: '#/components/schemas/Session'};
  assert.match(description.faults(schema, {id: 'x', colour: 'red'}), /additional properties/);
  assert.match(description.faults({$ref: '#/components/schemas/GeoJson'}, {type: 'Polygon', coordinates: [[[1, 2]]]}), /fewer/);
});
