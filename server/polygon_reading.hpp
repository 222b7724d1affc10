// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/fault.hpp"
#include "api/formats/geojson.hpp"
#include "api/formats/shape_crs.hpp"
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
    api::CrsClaim claim;                      ///< what system its positions are in
};

/// The system that a request says its positions are in, by an option or in its GeoJSON; where both
/// speak they must say the same. Requires: the options have been read without fault.
api::Parsed<api::CrsClaim> claim_of(const api::PolygonRequest& request,
                                    std::span<const api::NamedOption> options);

/// Reads body and options, the same for requests and the command line. `given` are the options
/// from outside of the body.
api::Parsed<PolygonWork> read_polygon_work(std::string_view body,
                                           std::vector<api::NamedOption> given,
                                           const api::ReadLimits& limits);

/// Brings the polygons into the session's system, so that the edit is one of its coordinates from
/// here on: in the history, in replays and in what is told of it. Or says why that cannot be.
api::Faults bring_into(PolygonWork& work, const std::string& session_crs);

/// What the core refused, in the places of the body. One fault for each error.
api::Faults faults_of(const core::Errors& errors, const std::vector<api::RequestedShape>& shapes);

/// Of operations that are run again: a clock, progress and an end, which is a deadline from now, or
/// `stopping`; but no budget that could refuse what was granted once.
/// Requires: `stopping` outlives the work.
RunLimits rerun_limits(const Limits& limits, const std::atomic<bool>& stopping);

/// Gives the edit the same, and its budgets.
void set_budgets(PolygonEdit& edit, const Limits& limits, const std::atomic<bool>& stopping);

}  // namespace tinsmith::server
