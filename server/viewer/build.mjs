// SPDX-License-Identifier: Apache-2.0
// node build.mjs FOLDER: the page in a few files. All but index.html are named by their content, so
// that browsers keep them for good.

import {createHash} from 'node:crypto';
import {readFileSync, readdirSync, rmSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {build} from 'esbuild';

const out = process.argv[2] ?? '../../build/viewer';
const three = 'node_modules/three';

// Of an earlier build; nothing else that may stand there.
for (const name of readdirSync(out))
  if (/^(index\.html|(main|page|draco|notices)-[0-9a-f]{12}\.\w+)$/.test(name)) rmSync(join(out, name));

/** Writes a file whose name tells its content; its address on the page. */
function put(stem, ending, content) {
  const name = `${stem}-${createHash('sha256').update(content).digest('hex').slice(0, 12)}.${ending}`;
  writeFileSync(join(out, name), content);
  return `viewer/${name}`;
}

const draco = join(three, 'examples/jsm/libs/draco/gltf');
const decoder = {
  js: put('draco', 'js', readFileSync(join(draco, 'draco_wasm_wrapper.js'))),
  wasm: put('draco', 'wasm', readFileSync(join(draco, 'draco_decoder.wasm'))),
};
const style = await build({entryPoints: ['src/page.css'], bundle: true, minify: true, write: false});
const script = await build({
  entryPoints: ['src/main.ts'], bundle: true, minify: true, write: false, format: 'esm', target: 'es2022',
  define: {DRACO_JS: JSON.stringify(decoder.js), DRACO_WASM: JSON.stringify(decoder.wasm)},
  legalComments: 'inline', logLevel: 'warning',
});
const notices = `This page holds three.js (MIT):\n\n${readFileSync(join(three, 'LICENSE'), 'utf8')}
and Draco's decoder, Copyright The Draco Authors, under the Apache License 2.0:
http://www.apache.org/licenses/LICENSE-2.0\n`;
const page = readFileSync('index.html', 'utf8')
  .replace('src/page.css', put('page', 'css', style.outputFiles[0].contents))
  .replace('src/main.ts', put('main', 'js', script.outputFiles[0].contents))
  .replace('NOTICES', put('notices', 'txt', notices));
writeFileSync(join(out, 'index.html'), page);
