// SPDX-License-Identifier: Apache-2.0
// The built program for the Node checks. TINSMITH names it where it is not that of the release build.

import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {once} from 'node:events';
import {existsSync, mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {dirname, join} from 'node:path';
import {setTimeout} from 'node:timers/promises';
import {fileURLToPath} from 'node:url';

export const project = join(dirname(fileURLToPath(import.meta.url)), '../..');
export const program = process.env.TINSMITH ?? join(project, 'build/release/tinsmith');

/** fetch on a connection of its own: one that is kept may be closed by the server while nobody looks. */
export function ask(url, options = {}) {
  return fetch(url, {...options, headers: {Connection: 'close', ...options.headers}});
}

/** Serves on a free port: {origin, stop}. `stop` fails unless the program ends well. */
export async function startServer(...options) {
  const folder = mkdtempSync(join(tmpdir(), 'tinsmith-'));
  const portFile = join(folder, 'port');
  const server = spawn(program, ['serve', ...options, '--port', '0', '--port-file', portFile], {stdio: 'ignore'});
  // The file appears whole or not at all, and the server listens by then.
  for (let tries = 0; !existsSync(portFile); ++tries) {
    assert.ok(tries < 600 && server.exitCode === null, 'the server did not start');
    await setTimeout(50);
  }
  const origin = `http://127.0.0.1:${readFileSync(portFile, 'utf8').trim()}`;
  const stop = async () => {
    server.kill('SIGTERM');
    const [code] = server.exitCode === null ? await once(server, 'exit') : [server.exitCode];
    rmSync(folder, {recursive: true});
    assert.equal(code, 0);
  };
  return {origin, stop};
}
