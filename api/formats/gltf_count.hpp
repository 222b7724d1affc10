// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "api/formats/gltf_model.hpp"

namespace tinsmith::api {

/// How many triangles the scene says that it shows, each mesh in each of its places; where they are
/// more than `most`, some number above that. A small file can show one mesh in very many places:
/// this is known before any is made. Numbers that no bytes stand behind are for others to find, and
/// count as none where one alone is above `most`.
std::size_t told_triangles(const GltfModel& model, std::size_t most);

}  // namespace tinsmith::api
