#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// Checks a GLB the way other people's clients read it.
//
//   node check_glb.mjs FILE.glb [MESH.json] [--tolerance METRES] [--unit METRES]
//
// Khronos' validator must find no error; every primitive must decode with npm's draco3d; what the
// accessors say must be what was decoded. With MESH.json, the session's mesh as
// {"vertices": [[x, y, z], ...], "triangles": [[a, b, c], ...]}, every decoded triangle must be one
// of the mesh, turned the same way, each exactly once, every corner within the tolerance (0.005)
// on each axis. --unit is the length of the mesh's unit. One closing line; exits 1 on a failure.

import {readFileSync} from 'node:fs';
import {pathToFileURL} from 'node:url';
import {compareWithMesh} from './mesh_match.mjs';
import {readGlb} from './read_glb.mjs';
import validator from 'gltf-validator';

const MODES = {1: 'LINES', 4: 'TRIANGLES'};

/// Bounds and counts in the accessors against the decoded values; throws at the first difference.
function checkAccessors(primitive, where) {
  const {positions, normals, indices, accessors} = primitive;
  const count = positions.length / 3;
  if (!(primitive.mode in MODES)) throw new Error(`${where}: mode ${primitive.mode}`);
  if (accessors.position.count !== count) throw new Error(`${where}: POSITION count is not ${count}`);
  if (accessors.indices.count !== indices.length) throw new Error(`${where}: index count is not ${indices.length}`);
  if (normals && normals.length !== positions.length) throw new Error(`${where}: NORMAL count`);
  if (indices.some((index) => index >= count)) throw new Error(`${where}: an index beyond ${count}`);
  for (let axis = 0; axis < 3; ++axis) {
    let low = Infinity, high = -Infinity;
    for (let i = axis; i < positions.length; i += 3) {
      low = Math.min(low, positions[i]);
      high = Math.max(high, positions[i]);
    }
    if (accessors.position.min[axis] !== low || accessors.position.max[axis] !== high) {
      throw new Error(`${where}: POSITION bounds are not [${low}, ${high}] on axis ${axis}`);
    }
  }
}

/// glTF's default material is a metal, which is black where there is nothing to mirror.
function checkMaterials(gltf) {
  for (const {mode = 4, material} of gltf.meshes.flatMap((mesh) => mesh.primitives)) {
    const {name, doubleSided, pbrMetallicRoughness} = gltf.materials?.[material] ?? {};
    const looksRight = doubleSided && pbrMetallicRoughness?.metallicFactor === 0;
    if (!looksRight || name !== (mode === 4 ? 'terrain' : 'constraints'))
      throw new Error(`a primitive of mode ${mode} has the material ${name}`);
  }
}

/// Checks one file; returns a line of what was found, throws an Error on a failure.
export async function checkGlb(bytes, {mesh, tolerance = 0.005, unit = 1} = {}) {
  const report = await validator.validateBytes(new Uint8Array(bytes), {maxIssues: 20});
  if (report.issues.numErrors > 0) {
    const first = report.issues.messages.find((message) => message.severity === 0);
    throw new Error(`${report.issues.numErrors} validator errors, first: ${first.code} ${first.pointer}: ${first.message}`);
  }
  const {gltf, primitives} = await readGlb(bytes);
  checkMaterials(gltf);
  primitives.forEach((primitive, i) => checkAccessors(primitive, `primitive ${i}`));
  const triangles = primitives.filter((primitive) => primitive.mode === 4);
  const lines = primitives.filter((primitive) => primitive.mode === 1);
  const sum = (list, each) => list.reduce((total, item) => total + item.indices.length / each, 0);
  const parts = [
    `${sum(triangles, 3)} triangles in ${triangles.length} primitives`,
    `${triangles.filter((primitive) => primitive.draco).length} with Draco`,
    `${sum(lines, 2)} lines`,
    `${report.issues.numWarnings} validator warnings`,
  ];
  if (mesh) {
    const up = gltf.scenes?.[gltf.scene ?? 0]?.extras?.up ?? 'y';
    const error = compareWithMesh(primitives, mesh, {tolerance, unit, up});
    parts.push(`every triangle matched, largest error ${error} m`);
  }
  return parts.join(', ');
}

function readArguments(words) {
  const options = {files: []};
  for (let i = 0; i < words.length; ++i) {
    const flag = /^--(tolerance|unit)$/.exec(words[i]);
    if (!flag) {
      options.files.push(words[i]);
      continue;
    }
    options[flag[1]] = Number(words[++i]);
    if (!(options[flag[1]] > 0)) throw new Error(`${words[i - 1]} wants a positive number`);
  }
  if (options.files.length < 1 || options.files.length > 2) {
    throw new Error('usage: check_glb.mjs FILE.glb [MESH.json] [--tolerance METRES] [--unit METRES]');
  }
  return options;
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) {
  try {
    const {files: [file, meshFile], ...options} = readArguments(process.argv.slice(2));
    if (meshFile) options.mesh = JSON.parse(readFileSync(meshFile, 'utf8'));
    console.log(`ok ${file}: ${await checkGlb(readFileSync(file), options)}`);
  } catch (error) {
    console.log(`FAILED ${process.argv[2] ?? ''}: ${error.message}`);
    process.exitCode = 1;
  }
}
