// SPDX-License-Identifier: Apache-2.0
// /openapi.json as the checks read it.

import Ajv from 'ajv/dist/2020.js';
import {ask} from '../support/program.mjs';

const METHODS = ['get', 'post', 'put', 'delete'];

export class Description {
  static async of(origin) {
    return new Description(await (await ask(`${origin}/openapi.json`)).json());
  }

  constructor(document) {
    this.document = document;
    this.operations = Object.entries(document.paths).flatMap(([path, item]) =>
      METHODS.filter((method) => item[method]).map((method) => ({path, method, ...item[method]})));
    // "example", "x-…" and the like are no business of the validator; everything else is.
    this.ajv = new Ajv({strict: true, strictTypes: false, strictRequired: false, allErrors: true});
    this.ajv.addVocabulary(['example', 'x-status', 'x-not-yet']);
    this.ajv.addVocabulary(['openapi', 'info', 'servers', 'tags', 'paths', 'components']);
    this.ajv.addSchema({...document, $id: 'api'});
  }

  /** What a "$ref" means, or the value itself. */
  resolve(value) {
    if (!value?.$ref) return value;
    return this.resolve(value.$ref.slice(2).split('/').reduce((at, step) => at[step], this.document));
  }

  operation(id) {
    return this.operations.find((operation) => operation.operationId === id);
  }

  parameters(operation, where) {
    return operation.parameters.map((parameter) => this.resolve(parameter)).filter((p) => p.in === where);
  }

  /** [{type, name, example}] of the body; none: [{}]. */
  bodies(operation) {
    const body = this.resolve(operation.requestBody);
    if (!body) return [{}];
    return Object.entries(body.content).flatMap(([type, media]) =>
      Object.entries(media.examples ?? {}).map(([name, example]) => ({type, name, example, schema: media.schema})));
  }

  /** What is wrong with a value by a schema of the description; empty: nothing. */
  faults(schema, value) {
    const validate = this.compiled(schema);
    if (validate(value)) return '';
    return validate.errors.map((e) => `${e.instancePath || '/'} ${e.message} ${JSON.stringify(e.params)}`).join('\n');
  }

  compiled(schema) {
    this.validators ??= new Map();
    if (!this.validators.has(schema)) {
      // References lead into the document, wherever the schema stands.
      const placed = JSON.parse(JSON.stringify(schema).replaceAll('"#/components/', '"api#/components/'));
      this.validators.set(schema, this.ajv.compile(placed));
    }
    return this.validators.get(schema);
  }
}
