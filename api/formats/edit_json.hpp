// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "api/fault.hpp"
#include "api/formats/read_limits.hpp"
#include "core/edit/plane.hpp"

namespace tinsmith::api {

enum class EditKind { Set, Offset, Smooth, Remove, Keep };

/// The word on the wire: "smooth".
std::string_view edit_name(EditKind operation);

/// An edit as its body states it, contradictions ruled out. Lengths in the session's unit.
struct EditRequest {
    EditKind operation = EditKind::Set;
    std::string polygon;       ///< id of one of the session's
    core::Plane plane;         ///< Set
    double by = 0.0;           ///< Offset
    std::uint64_t passes = 1;  ///< Smooth
    /// Whether the border's vertices move; where there is a taper they do.
    bool moves_border = false;
    std::optional<double> rim;  ///< Set and Offset of what leaves the border alone
    bool rim_is_given = false;  ///< and not the default
    std::optional<double> taper;
};

inline constexpr double kDefaultRim = 0.05;
inline constexpr std::uint64_t kMostPasses = 1000;

/// Reads {"operation", "polygon", ...}: "set" with one of "elevation", "plane", and "slope" with
/// "azimuth" and "point"; "offset" with "by"; "smooth" with "passes"; "remove"; "keep". The first
/// three take "border", the first two "rim" or "taper" as well. Names every fault; what has no
/// meaning with the operation is one.
Parsed<EditRequest> read_edit_request(std::string_view body, const ReadLimits& limits);

}  // namespace tinsmith::api
