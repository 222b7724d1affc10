// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace tinsmith::api {

/// Edges joined to lines, each by its vertices in turn; a closed one ends where it began.
///
/// Laws: every edge is in one line, once; a line ends at a vertex where not just two edges meet,
/// or where `group_of` differs on its two sides; all edges of a line are of one group. The order of
/// the lines is that of their first edges.
/// Requires: no edge is given twice. Cost: n log n in the edges.
std::vector<std::vector<std::uint32_t>> chain_edges(
    std::span<const std::array<std::uint32_t, 2>> edges,
    const std::function<std::uint32_t(std::size_t edge)>& group_of = {});

}  // namespace tinsmith::api
