// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "api/formats/gltf_model.hpp"

namespace tinsmith::api {

/// The bytes of a view that EXT_meshopt_compression packed, or what is wrong with them. What is
/// promised is held against the packed bytes, and `most`, before it is reserved.
/// Costs: linear; exponential filters are undone, others are refused, for no position has them.
std::variant<std::string, Fault> decode_meshopt(const GltfMeshopt& view, std::string_view packed,
                                                std::size_t most);

}  // namespace tinsmith::api
