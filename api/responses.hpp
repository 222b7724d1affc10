// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/integrate/angle_counts.hpp"
#include "core/integrate/report.hpp"
#include "core/mesh/repair.hpp"
#include "core/mesh/tin.hpp"
#include "core/types/mesh_data.hpp"

namespace tinsmith::api {

/// What is told of a session. Lengths are in `unit`.
struct SessionView {
    std::string id;
    std::string name;
    std::string crs;  ///< empty: unknown, written as null
    std::string unit;
    std::uint64_t version = 0;
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    core::Bounds bounds;
    std::size_t polygons = 0;
    std::size_t memory_bytes = 0;
    std::optional<std::vector<core::Repair>> repairs = std::nullopt;  ///< left out without
    std::vector<std::string> notes = {};                              ///< left out when empty
    /// When it ends if nobody asks for it, Unix seconds; left out without.
    std::optional<std::int64_t> expires = std::nullopt;
};

/// What is told of an edit. `polygon_ids` and `report.shapes` go together, one for one.
struct ReportView {
    std::string_view session;  ///< empty: none is kept, written as null
    std::uint64_t version = 0;
    bool dry_run = false;
    std::span<const std::string> polygon_ids;
    const core::Report& report;
    /// Of the terrain, where it came with the request and mending was asked for.
    std::optional<std::vector<core::Repair>> repairs = std::nullopt;
    std::optional<core::AngleCounts> angles = std::nullopt;  ///< where they were asked for
};

/// All bodies are JSON texts that end with a newline. Numbers read back to the same double.
std::string write_session(const SessionView& session);
std::string write_session_list(std::span<const SessionView> sessions);
std::string write_report(const ReportView& view);

/// What the key that asks is allowed; quotas that are not set are not there.
struct KeyView {
    std::string_view name;
    std::string_view id;
    std::vector<std::pair<std::string_view, double>> quotas;
};

/// An object of numbers, in the order given, and last "key" where one asks.
std::string write_limits(std::span<const std::pair<std::string_view, double>> limits,
                         const std::optional<KeyView>& key = {});

/// {"vertices": [[x,y,z],...], "triangles": [[a,b,c],...]} in slot order. No document tree is
/// built: the text is the only memory taken. Requires: finite coordinates. Cost: linear.
std::string write_mesh_json(const core::MeshData& mesh);

}  // namespace tinsmith::api
