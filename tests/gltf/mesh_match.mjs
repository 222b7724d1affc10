// SPDX-License-Identifier: Apache-2.0
// Finds every decoded triangle in the session's mesh.

/// Session vertices by the cell of a grid in plan, to be looked up by decoded position.
class VertexFinder {
  constructor(vertices, tolerance) {
    this.vertices = vertices;
    this.tolerance = tolerance;
    this.cell = Math.max(4 * tolerance, 0.01);
    this.cells = new Map();
    vertices.forEach(([x, y], i) => {
      const key = this.key(Math.floor(x / this.cell), Math.floor(y / this.cell));
      const cell = this.cells.get(key);
      if (cell) cell.push(i);
      else this.cells.set(key, [i]);
    });
  }

  key(column, row) { return `${column},${row}`; }

  /// The vertices within the tolerance on each axis, nearest first.
  near(p) {
    const found = [];
    const range = (value) => [Math.floor((value - this.tolerance) / this.cell), Math.floor((value + this.tolerance) / this.cell)];
    const [c0, c1] = range(p[0]), [r0, r1] = range(p[1]);
    for (let column = c0; column <= c1; ++column) {
      for (let row = r0; row <= r1; ++row) {
        for (const i of this.cells.get(this.key(column, row)) ?? []) {
          const v = this.vertices[i];
          const error = Math.max(Math.abs(v[0] - p[0]), Math.abs(v[1] - p[1]), Math.abs(v[2] - p[2]));
          if (error <= this.tolerance) found.push({i, error});
        }
      }
    }
    found.sort((a, b) => a.error - b.error || a.i - b.i);
    return found;
  }
}

/// A triangle's name whatever corner it begins with; the way it turns stays in it.
function name(a, b, c) {
  if (a < b && a < c) return `${a},${b},${c}`;
  return b < c ? `${b},${c},${a}` : `${c},${a},${b}`;
}

/// Takes away one triangle of the mesh that these corners can be; vertices may lie closer together
/// than the tolerance, so each corner has candidates.
function takeTriangle(left, [as, bs, cs]) {
  for (const a of as) {
    for (const b of bs) {
      for (const c of cs) {
        const count = left.get(name(a.i, b.i, c.i));
        if (!count) continue;
        left.set(name(a.i, b.i, c.i), count - 1);
        return Math.max(a.error, b.error, c.error);
      }
    }
  }
  return undefined;
}

/// Throws at the first triangle that the mesh does not have, or has not so often; returns the
/// largest error on any axis, in metres.
export function compareWithMesh(primitives, mesh, {tolerance, unit, up}) {
  const finder = new VertexFinder(mesh.vertices.map((v) => v.map((x) => x * unit)), tolerance);
  const left = new Map();
  for (const triangle of mesh.triangles) left.set(name(...triangle), (left.get(name(...triangle)) ?? 0) + 1);
  let largest = 0, count = 0;
  for (const {mode, positions, indices, translation} of primitives) {
    const candidates = new Map();
    const corner = (index) => {
      if (!candidates.has(index)) {
        const [x, y, z] = translation.map((metre, axis) => metre + positions[3 * index + axis]);
        const place = up === 'y' ? [x, -z, y] : [x, y, z];
        const near = finder.near(place);
        if (near.length === 0) throw new Error(`no vertex of the mesh within ${tolerance} m of ${place}`);
        candidates.set(index, near);
      }
      return candidates.get(index);
    };
    if (mode === 1) indices.forEach(corner);
    for (let i = 0; mode === 4 && i < indices.length; i += 3, ++count) {
      const error = takeTriangle(left, [corner(indices[i]), corner(indices[i + 1]), corner(indices[i + 2])]);
      if (error === undefined) throw new Error(`triangle ${i / 3} is not one of the mesh, or turns the other way`);
      largest = Math.max(largest, error);
    }
  }
  if (count !== mesh.triangles.length) throw new Error(`${count} triangles, the mesh has ${mesh.triangles.length}`);
  return largest;
}
