// SPDX-License-Identifier: Apache-2.0
// The requests of the description, ready to be sent: its examples, each to a session of its own, and
// one request for each way to be refused.

import {readFileSync} from 'node:fs';
import {join} from 'node:path';
import {setTimeout} from 'node:timers/promises';
import {ask, project} from '../support/program.mjs';

/** What a case needs to have been done before, by operation; others: a session with one polygon. */
const BEFORE = {
  createSession: [],
  putSession: [],
  integratePolygons: ['putSession'],
  integrateOnce: [],
  redo: ['putSession', 'integratePolygons', 'undo'],
  getLocks: ['putSession', 'integratePolygons', 'putLocks'],
};
const USUAL = ['putSession', 'integratePolygons'];
const FORM = 'multipart/form-data';
const ABOUT_A_JOB = ['getJob', 'getJobResult', 'deleteJob', 'listJobs'];

const JSON_TYPE = 'application/json';
const parcel = {type: JSON_TYPE, schema: {$ref: '#/components/schemas/GeoJson'}, example: {value: {type: 'Polygon', coordinates: [[[2, 2], [5, 2], [5, 5], [2, 2]]]}}};

/** What the examples of parameters do not say: [operation, query or path, media type that comes, body]. */
const MORE = [
  ['integratePolygons', {angles: true}, 'application/json', parcel],
  ['getMesh', {since: 1}, 'application/json'],
  ['getMesh', {since: 1}, 'application/vnd.tinsmith.delta'],
  ['getChange', {version: 1}, 'application/json'],
  ['getMesh', {version: 1}, 'model/gltf-binary'],
  ['getMeshJson', {version: 1}, 'application/json'],
  ['getDocsFile', {file: 'page.mjs'}, 'text/javascript; charset=utf-8'],
  ['getDocsFile', {file: 'page.css'}, 'text/css; charset=utf-8'],
];

export class Client {
  constructor(origin, description) {
    this.origin = origin;
    this.description = description;
  }

  /** Sends one operation. `values` are of path and query, over the examples of the parameters. */
  async send(id, {values = {}, headers = {}, body = {}, raw} = {}) {
    const operation = this.description.operation(id);
    if (ABOUT_A_JOB.includes(id)) values = {...this.job, ...values};
    const value = (parameter) => values[parameter.name] ?? parameter.example;
    const path = this.description.parameters(operation, 'path').reduce(
      (filled, p) => filled.replace(`{${p.name}}`, encodeURIComponent(value(p))), operation.path);
    const query = new URLSearchParams();
    for (const p of this.description.parameters(operation, 'query'))
      if (p.required || p.name in values) query.set(p.name, value(p));
    for (const name of Object.keys(values).filter((name) => !(name in (this.job ?? {}))))
      if (!operation.parameters.some((p) => this.description.resolve(p).name === name)) query.set(name, values[name]);
    // Of a form the library says the type, with its boundary.
    if (body.type && body.type !== FORM) headers = {'Content-Type': body.type, ...headers};
    const response = await ask(`${this.origin}${path}${query.size > 0 ? `?${query}` : ''}`, {
      method: operation.method.toUpperCase(),
      headers: {'X-Request-Id': 'example', ...headers},
      ...(raw ?? {body: contentOf(body)}),
    });
    return answerOf(operation, response);
  }

  /** Nothing but what the case needs. */
  async prepare(id) {
    for (const session of ['square', 'other']) await ask(`${this.origin}/v1/sessions/${session}`, {method: 'DELETE'});
    for (const step of BEFORE[id] ?? USUAL) await this.example(step);
    if (id === 'askVolume') await this.example('putSession', {id: 'other'});
    if (!ABOUT_A_JOB.includes(id)) return;
    const body = this.description.bodies(this.description.operation('askElevations'))[0];
    const accepted = await this.send('askElevations', {body, headers: {Prefer: 'respond-async'}});
    await this.end(accepted);
    this.job = {id: accepted.json.id};
  }

  /** Waits for a job's end; what it was then. */
  async end(accepted) {
    for (;;) {
      const job = await (await ask(this.origin + accepted.headers.get('location'))).json();
      if (!['queued', 'running'].includes(job.state)) return job;
      await setTimeout(5);
    }
  }

  /** The first example of an operation. */
  example(id, values = {}) {
    return this.send(id, {values, body: this.description.bodies(this.description.operation(id))[0]});
  }
}

/** Every request that the description has an example of, by each media type that it may come back as. */
export function exampleCases(description) {
  return description.operations.flatMap((operation) => {
    const status = successOf(operation);
    // Of a job's result no more is described than that it is the answer of its request.
    const types = Object.keys(operation.responses[status]?.content ?? {'application/json': {}});
    const own = MORE.filter(([id]) => id === operation.operationId)
      .map(([id, values, type, body = {}]) => ({id, values, type, name: Object.entries(values)[0].join('_'), body}));
    const plain = description.bodies(operation).flatMap((body) => types
      .filter((type) => id(operation) !== 'getDocsFile' && !own.some((one) => one.type === type && type.includes('delta')))
      .map((type) => ({id: id(operation), values: {}, type, name: body.name ?? id(operation), body})));
    return [...plain, ...own].map((one) => ({...one, status, operation}));
  });
}

export const successOf = (operation) => Object.keys(operation.responses).find((status) => status < '3').replace('XX', '00');
const id = (operation) => operation.operationId;

function contentOf({type, example}) {
  if (!example) return undefined;
  if (type === FORM) {
    const form = new FormData();
    for (const [name, value] of Object.entries(example.value))
      form.append(name, new Blob([JSON.stringify(value)], {type: 'application/json'}));
    return form;
  }
  if (example.externalValue) return readFileSync(join(project, example.externalValue));
  return typeof example.value === 'string' ? example.value : JSON.stringify(example.value);
}

async function answerOf(operation, response) {
  const bytes = Buffer.from(await response.arrayBuffer());
  const type = response.headers.get('content-type') ?? '';
  const isJson = /[/+]json/.test(type);
  return {operation, status: String(response.status), type, bytes, headers: response.headers,
    json: isJson ? JSON.parse(bytes.toString('utf8')) : undefined};
}

const broken = (text) => ({raw: {body: text}, headers: {'Content-Type': JSON_TYPE}});

/** [problem, operation, request]: sent in order to a session with one polygon, which they leave as it is. */
export const REFUSALS = [
  ['bad-request', 'getSession', {headers: {'If-None-Match': 'no-quotes'}}],
  ['malformed-body', 'createSession', broken('{"mesh": ')],
  ['invalid-content', 'createSession', broken('{"mesh": {"vertices": [[0, 0]], "faces": []}}')],
  ['not-available', 'integrateOnce', {body: {type: FORM, example: {value: {
    terrain: {mesh: {vertices: [[0, 0, 0], [9, 0, 0], [0, 9, 0]], triangles: [[0, 1, 2]]}},
    polygons: {type: 'Point', coordinates: [1, 1]}, options: {version: '3'},
  }}}}],
  ['unknown-parameter', 'getSession', {values: {colour: 'red'}}],
  ['invalid-parameter', 'integratePolygons', {values: {snap: -1, lock: 'maybe'}, body: parcel}],
  ['unsupported-media-type', 'integratePolygons', {raw: {body: 'x,y'}, headers: {'Content-Type': 'text/csv'}}],
  ['unsupported-encoding', 'askVolume', {...broken('{}'), headers: {'Content-Encoding': 'br'}}],
  ['not-acceptable', 'getMesh', {headers: {Accept: 'text/html'}}],
  ['length-required', 'askProfile', {raw: {body: new Blob(['{}']).stream(), duplex: 'half'}}],
  ['path-too-long', 'getSession', {values: {id: 'x'.repeat(600)}}],
  ['too-many-headers', 'getSession', {headers: Object.fromEntries([...Array(95).keys()].map((i) => [`X-${i}`, '1']))}],
  ['range-refused', 'getMeshGlb', {headers: {Range: 'bytes=0-1,4-5'}}],
  ['no-such-path', 'getDocsFile', {values: {file: 'none'}}],
  ['no-such-session', 'getSession', {values: {id: 'none'}}],
  ['no-such-polygon', 'getPolygon', {values: {pid: 'p99'}}],
  ['no-such-job', 'getJob', {values: {id: 'none'}}],
  ['no-such-version', 'getChange', {values: {version: 99}}],
  ['outside-mesh', 'getElevation', {values: {x: 99, y: 99}}],
  ['version-mismatch', 'undo', {headers: {'If-Match': '"none-1"'}}],
  ['edit-refused', 'integratePolygons', {
    values: {outside: 'reject'},
    body: {type: JSON_TYPE, example: {value: {type: 'LineString', coordinates: [[5, 5], [20, 5]]}}},
  }],
  ['id-taken', 'putSession', {...broken('{}')}],
  ['nothing-to-redo', 'redo', {}],
];

/** The same to a server that allows little: see `STRICT`. */
export const STRICT = ['--max-body-bytes', '3MB', '--require-if-match', '--max-crossings', '0', '--max-sessions', '1', '--max-history', '1'];
export const STRICT_REFUSALS = [
  ['too-large', 'createSession', {raw: {body: Buffer.alloc(4_000_000)}, headers: {'Content-Type': 'image/tiff'}}],
  ['precondition-required', 'undo', {}],
  ['budget-exceeded', 'integratePolygons', {
    headers: {'If-Match': '*'},
    body: {type: JSON_TYPE, example: {value: {type: 'LineString', coordinates: [[9, 1], [1, 9]]}}},
  }],
  ['too-many-sessions', 'forkSession', {}],
  ['nothing-to-undo', 'undo', {headers: {'If-Match': '*'}}],
  ['polygon-settled', 'deletePolygon', {headers: {'If-Match': '*'}}],
  ['version-gone', 'getChange', {values: {version: 1}}],
];

/** Not to be had by one polite client; the name of the test that has them. */
export const ELSEWHERE = {
  'api-key-required': 'KeyRoutes.AreWantedByEveryRouteUnderV1',
  'too-many-requests': 'KeyGate.CountsRequestsInFlight',
  'expectation-failed': 'Guard.RefusesExpectationsItDoesNotKnow',
  'request-timeout': 'ProblemOfStatus.FindsAProblemForWhatTheTransportRefuses',
  'method-not-allowed': 'Router.NamesTheMethodsOfAPath',
  'key-reused': 'Retries.AreRefusedWhereTheRequestIsAnother',
  'key-in-use': 'Manners.ApplyARetryOnceThoughManyRace',
  'answer-not-kept': 'KeptAnswers.RememberWhatWasTooLargeToKeep',
  'polygon-in-use': 'EditRoutes.GoWithTheirPolygonOrKeepIt',
  'replay-failed': 'HistoryRoutes.SayWhichOperationCannotBeDoneAgain',
  'out-of-memory': 'SessionStore.RefusesBeyondItsLimits',
  'storage-unavailable': 'StoredSessions.RefuseEditsWhileTheDiskIsFullAndGoOnAfter',
  'session-out-of-service': 'StoredSessions.ThatAreDamagedAreOutOfServiceAlone',
  'session-read-only': 'StoredSessions.OfAnotherAlgorithmAreReadOnly',
  'job-unfinished': 'JobRoutes.AnswerAtOnceAndLater',
  'too-many-jobs': 'FewJobs.SayWhenToComeAgain',
  'busy': 'Turnstile.LetsSoManyInAtATime',
  'not-ready': 'ServiceRoutes.SayNotReadyWhileTheServerStarts',
  'stopped': 'SessionHistory.WorkThatIsStoppedChangesNothing',
  'internal': 'Router.TellsNothingOfAnException',
};
