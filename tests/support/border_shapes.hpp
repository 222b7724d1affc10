// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/integrate/shape.hpp"
#include "core/types/mesh_data.hpp"

namespace tinsmith::test {

/// A mesh, and a request whose work is about linear in the case's size.
struct BorderCase {
    core::MeshData mesh;
    std::vector<core::Shape> before;  ///< integrated first, not timed
    std::vector<core::Shape> shapes;
};

struct BorderShape {
    const char* name;
    BorderCase (*make)(std::size_t size);
};

/// All of them, the same every time.
std::span<const BorderShape> border_shapes();

}  // namespace tinsmith::test
