// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/fault.hpp"
#include "api/formats/geojson.hpp"
#include "api/requests.hpp"
#include "core/types/result.hpp"
#include "server/limits.hpp"
#include "server/operation.hpp"
#include "server/polygon.hpp"

namespace tinsmith::server {

/// A polygons request, read and checked, on its way into a session.
struct PolygonWork {
    PolygonEdit edit;
    std::vector<api::RequestedShape> shapes;  ///< the way back to the body; their paths are gone
    std::string crs;                          ///< that the polygons claim; empty: none
    std::string crs_pointer;                  ///< where they claim it; empty: in the query
};

/// Reads body and options, the same for requests and the command line. `given` are the options
/// from outside of the body.
api::Parsed<PolygonWork> read_polygon_work(std::string_view body,
                                           std::vector<api::NamedOption> given,
                                           const api::ReadLimits& limits);

/// What is wrong with the polygons' own system for a session in `session_crs`; nothing: it is the
/// same, or they claim none.
std::optional<api::Fault> crs_fault(const PolygonWork& work, const std::string& session_crs);

/// What the core refused, in the places of the body. One fault for each error.
api::Faults faults_of(const core::Errors& errors, const std::vector<api::RequestedShape>& shapes);

/// Of operations that are run again: a clock, progress and an end, which is a deadline from now, or
/// `stopping`; but no budget that could refuse what was granted once.
/// Requires: `stopping` outlives the work.
RunLimits rerun_limits(const Limits& limits, const std::atomic<bool>& stopping);

/// Gives the edit the same, and its budgets.
void set_budgets(PolygonEdit& edit, const Limits& limits, const std::atomic<bool>& stopping);

}  // namespace tinsmith::server
