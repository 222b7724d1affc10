// SPDX-License-Identifier: Apache-2.0
// Edits whose answer is lost on its way may be made or not. What is sent again carries the key of the
// first time, so that the server makes it once and answers as it did.
import {type Call, Problem, send} from './api';

function randomKey(): string {
  // Not randomUUID, which pages without TLS do not have.
  return [...crypto.getRandomValues(new Uint8Array(16))].map((byte) => byte.toString(16).padStart(2, '0')).join('');
}

export class Once {
  private last: {call: string; key: string} | null = null;

  /** The answer has come whole: the same again is another edit. */
  isAnswered() {
    this.last = null;
  }

  async send(call: Call): Promise<Response> {
    // Others are refused by their If-Match where they were made.
    if (call.method !== 'POST') return send(call);
    const text = JSON.stringify(call);
    if (this.last?.call !== text) this.last = {call: text, key: randomKey()};
    try {
      return await send({...call, headers: {...call.headers, 'Idempotency-Key': this.last.key}});
    } catch (error) {
      // Refused: nothing was made of it. Without a status nobody knows.
      if (error instanceof Problem && error.status !== 0) this.last = null;
      throw error;
    }
  }
}
