// SPDX-License-Identifier: Apache-2.0
// Reads a GLB into plain arrays: the container by hand, compressed primitives with npm's draco3d.

import draco3d from 'draco3d';

let dracoModule;

function decodeDraco(module, bytes, ids) {
  const decoder = new module.Decoder();
  const buffer = new module.DecoderBuffer();
  const mesh = new module.Mesh();
  const take = (count, Type, fill) => {
    const size = count * 4;
    const pointer = module._malloc(size);
    fill(size, pointer);
    const values = new Type(module.HEAPF32.buffer, pointer, count).slice();
    module._free(pointer);
    return values;
  };
  try {
    buffer.Init(new Int8Array(bytes.buffer, bytes.byteOffset, bytes.byteLength), bytes.byteLength);
    const status = decoder.DecodeBufferToMesh(buffer, mesh);
    if (!status.ok()) throw new Error(`Draco: ${status.error_msg()}`);
    const vectors = (id) => {
      const attribute = decoder.GetAttributeByUniqueId(mesh, id);
      return take(mesh.num_points() * 3, Float32Array, (size, pointer) =>
          decoder.GetAttributeDataArrayForAllPoints(mesh, attribute, module.DT_FLOAT32, size, pointer));
    };
    return {
      draco: true,
      positions: vectors(ids.POSITION),
      normals: 'NORMAL' in ids ? vectors(ids.NORMAL) : undefined,
      indices: take(mesh.num_faces() * 3, Uint32Array, (size, pointer) =>
          decoder.GetTrianglesUInt32Array(mesh, size, pointer)),
    };
  } finally {
    for (const object of [mesh, buffer, decoder]) module.destroy(object);
  }
}

/// The JSON and the BIN chunk, with every length checked.
function readContainer(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const word = (offset) => view.getUint32(offset, true);
  if (word(0) !== 0x46546c67 || word(4) !== 2) throw new Error('not a GLB 2.0 header');
  if (word(8) !== bytes.byteLength) throw new Error(`length says ${word(8)}, the file has ${bytes.byteLength}`);
  const chunks = [];
  for (let at = 12; at < bytes.byteLength; at += 8 + word(at)) {
    if (at % 4 !== 0 || at + 8 + word(at) > bytes.byteLength) throw new Error(`a chunk at ${at} does not fit`);
    chunks.push({type: word(at + 4), data: bytes.subarray(at + 8, at + 8 + word(at))});
  }
  const [json, bin] = chunks;
  if (chunks.length !== 2 || json.type !== 0x4e4f534a || bin.type !== 0x004e4942) throw new Error('chunks are not JSON, BIN');
  return {gltf: JSON.parse(new TextDecoder().decode(json.data)), bin: bin.data};
}

/// {gltf, primitives: [{mode, draco, translation, positions, normals, indices, accessors}]}
export async function readGlb(file) {
  // A plain Uint8Array: the slice of Node's Buffer would not copy.
  const bytes = new Uint8Array(file.buffer, file.byteOffset, file.byteLength);
  dracoModule ??= await draco3d.createDecoderModule({});
  const {gltf, bin} = readContainer(bytes);
  const viewBytes = (index) => {
    const {byteOffset = 0, byteLength} = gltf.bufferViews[index];
    return bin.subarray(byteOffset, byteOffset + byteLength);
  };
  const plain = (index, Type) => {
    const {bufferView, byteOffset = 0, count, type} = gltf.accessors[index];
    const data = viewBytes(bufferView).slice(byteOffset);  // a copy, so that it is aligned
    return new Type(data.buffer, 0, count * (type === 'VEC3' ? 3 : 1));
  };
  const decode = ({attributes, indices, extensions}) => {
    const draco = extensions?.KHR_draco_mesh_compression;
    if (draco) return decodeDraco(dracoModule, viewBytes(draco.bufferView), draco.attributes);
    return {
      draco: false,
      positions: plain(attributes.POSITION, Float32Array),
      normals: 'NORMAL' in attributes ? plain(attributes.NORMAL, Float32Array) : undefined,
      indices: plain(indices, Uint32Array),
    };
  };
  const primitives = gltf.nodes.flatMap(({mesh, translation = [0, 0, 0]}) =>
      gltf.meshes[mesh].primitives.map((primitive) => ({
        ...decode(primitive),
        mode: primitive.mode ?? 4,
        translation,
        accessors: {
          position: gltf.accessors[primitive.attributes.POSITION],
          indices: gltf.accessors[primitive.indices],
        },
      })));
  return {gltf, primitives};
}
