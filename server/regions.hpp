// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "api/regions.hpp"
#include "core/mesh/tin.hpp"
#include "server/polygon.hpp"

namespace tinsmith::server {

/// The regions of some polygons, with what other polygons have to do with their triangles and
/// edges. Requires: `all` lie in `tin` as it is; `wanted` are indices of polygons with an inside.
/// Cost: the regions and chains of those wanted and of all others whose boxes touch theirs.
std::vector<api::RegionView> find_regions(const core::Tin& tin, std::span<const Polygon> all,
                                          std::span<const std::size_t> wanted);

}  // namespace tinsmith::server
