// SPDX-License-Identifier: Apache-2.0
// How many position bits survive Draco bit for bit? Encodes known points on a grid of 2^-7 m with
// explicit quantization at 16 to 30 bits and compares every decoded float32 with the expected one.
// The answer is api/formats/quantization.hpp's kDracoBits; this script exits 1 when a decoder
// disagrees with it.
//
//   node decoder_bits.mjs                    npm's draco3d (encoder and decoder)
//   node decoder_bits.mjs DECODER.js [WASM]  another Draco decoder module, for instance
//                                            three/examples/jsm/libs/draco/gltf/draco_decoder.js

import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {resolve} from 'node:path';
import draco3d from 'draco3d';

const kDracoBits = 23; // what the writer uses at most
const step = 2 ** -7;

/// A strip of triangles whose x counts up to the largest quantized value: low, middle and high
/// values, odd and even.
function steps(bits) {
  const top = 2 ** bits - 1;
  const picked = new Set();
  for (const base of [0, top / 3, top / 2, (2 * top) / 3, 0.9 * top, top - 400]) {
    for (let i = 0; i < 400; ++i) picked.add(Math.floor(base) + i);
  }
  return [...picked].filter((q) => q >= 0 && q <= top).sort((a, b) => a - b);
}

function encode(encoderModule, xs, originStep, bits) {
  const encoder = new encoderModule.Encoder();
  const builder = new encoderModule.MeshBuilder();
  const mesh = new encoderModule.Mesh();
  const positions = new Float32Array(xs.length * 3);
  xs.forEach((q, i) => positions.set([(originStep + q) * step, (originStep + (i % 2)) * step, originStep * step], 3 * i));
  const faces = new Uint32Array((xs.length - 2) * 3);
  for (let i = 0; i + 2 < xs.length; ++i) faces.set(i % 2 ? [i + 1, i, i + 2] : [i, i + 1, i + 2], 3 * i);
  builder.AddFacesToMesh(mesh, xs.length - 2, faces);
  builder.AddFloatAttributeToMesh(mesh, encoderModule.POSITION, xs.length, 3, positions);
  encoder.SetSpeedOptions(7, 7);
  encoder.SetAttributeExplicitQuantization(
      encoderModule.POSITION, bits, 3, new Array(3).fill(originStep * step), step * (2 ** bits - 1));
  const out = new encoderModule.DracoInt8Array();
  const length = encoder.EncodeMeshToDracoBuffer(mesh, out);
  const bytes = new Int8Array(length);
  for (let i = 0; i < length; ++i) bytes[i] = out.GetValue(i);
  for (const object of [out, mesh, builder, encoder]) encoderModule.destroy(object);
  return bytes;
}

function decode(module, bytes) {
  const decoder = new module.Decoder();
  const buffer = new module.DecoderBuffer();
  buffer.Init(bytes, bytes.length);
  const mesh = new module.Mesh();
  const status = decoder.DecodeBufferToMesh(buffer, mesh);
  if (!status.ok()) throw new Error(status.error_msg());
  const attribute = decoder.GetAttribute(mesh, decoder.GetAttributeId(mesh, module.POSITION));
  const size = mesh.num_points() * 3 * 4;
  const pointer = module._malloc(size);
  decoder.GetAttributeDataArrayForAllPoints(mesh, attribute, module.DT_FLOAT32, size, pointer);
  const values = new Float32Array(module.HEAPF32.buffer, pointer, size / 4).slice();
  module._free(pointer);
  for (const object of [mesh, buffer, decoder]) module.destroy(object);
  return values.filter((_, i) => i % 3 === 0).sort();
}

async function loadDecoder() {
  const [script, wasm] = process.argv.slice(2);
  if (!script) return draco3d.createDecoderModule({});
  // The files for browsers end in a module.exports that only CommonJS sees.
  const module = {exports: {}};
  new Function('module', 'exports', 'require', '__dirname', '__filename', readFileSync(script, 'utf8'))(
      module, module.exports, createRequire(resolve(script)), resolve(script, '..'), resolve(script));
  return module.exports(wasm ? {wasmBinary: readFileSync(wasm)} : {});
}

const encoderModule = await draco3d.createEncoderModule({});
const decoderModule = await loadDecoder();
console.log('bits  origin/steps  values  wrong  largest error in steps');
let exactBits = 15;
// Beyond 28 bits npm's encoder aborts on the same overflow.
for (let bits = 16; bits <= 28; ++bits) {
  let allExact = true;
  // From zero, and from far below zero as in a mesh centred on its node.
  for (const originStep of [0, -(2 ** (Math.min(bits, 24) - 1))]) {
    const xs = steps(bits);
    const expected = xs.map((q) => (originStep + q) * step);
    const decoded = decode(decoderModule, encode(encoderModule, xs, originStep, bits));
    const wrong = expected.filter((x, i) => decoded[i] !== x).length;
    // Values that fell together in float32 are one decoded point: then no error can be told.
    const worst = decoded.length === xs.length ?
        Math.max(...expected.map((x, i) => Math.abs(decoded[i] - x) / step)) : 'points merged';
    console.log(`${bits}`.padEnd(6) + `${originStep}`.padEnd(14) + `${xs.length}`.padEnd(8) +
                `${wrong}`.padEnd(7) + worst);
    allExact &&= wrong === 0;
  }
  if (allExact && exactBits === bits - 1) exactBits = bits;
}
console.log(`exact up to ${exactBits} bits`);
process.exitCode = exactBits === kDracoBits ? 0 : 1;
