// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/types/mesh_data.hpp"

namespace tinsmith::test {

/// The mesh without the vertices that no triangle uses, the rest in their order, and without
/// constraints on edges that are not there.
core::MeshData compact(const core::MeshData& full);

}  // namespace tinsmith::test
