// SPDX-License-Identifier: Apache-2.0
// A server of pages on loopback: what npm installed here, the pages below, and files as given.

import {once} from 'node:events';
import {existsSync, readFileSync} from 'node:fs';
import {createServer} from 'node:http';
import {dirname, extname, join, normalize} from 'node:path';
import {fileURLToPath} from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const TYPES = {
  '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.json': 'application/json',
  '.css': 'text/css', '.wasm': 'application/wasm', '.glb': 'model/gltf-binary', '.gltf': 'model/gltf+json',
};

/** {origin, close}; `files` are bytes by path. */
export async function servePages(files) {
  const server = createServer((request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, 'http://x').pathname));
    const disk = join(here, path.startsWith('/node_modules/') ? path : join('pages', path));
    const body = files[path] ?? (existsSync(disk) && extname(disk) ? readFileSync(disk) : undefined);
    response.writeHead(body ? 200 : 404, {'Content-Type': TYPES[extname(path)] ?? 'application/octet-stream'});
    response.end(body);
  });
  server.listen(0, '127.0.0.1');
  await once(server, 'listening');
  return {
    origin: `http://127.0.0.1:${server.address().port}`,
    close: async () => {
      server.closeAllConnections();
      server.close();
      await once(server, 'close');
    },
  };
}
