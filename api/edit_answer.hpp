// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "api/formats/edit_json.hpp"
#include "core/edit/region_edit.hpp"

namespace tinsmith::api {

/// What is told of an edit: what was asked, and what came of it.
struct EditAnswer {
    EditKind kind = EditKind::Set;
    std::string polygon;
    bool moves_border = false;
    std::optional<double> rim = {};
    std::optional<double> taper = {};
    core::EditReport report = {};
};

/// {"session", "version", "dry_run", "operation", "polygon", "border"?, "rim"?, "taper"?, counts,
/// "cut", "fill", "area_affected", "max_elevation_change", "time_ms"}
std::string write_edit(std::string_view session, std::uint64_t version, bool dry_run,
                       const EditAnswer& edit);

}  // namespace tinsmith::api
