// SPDX-License-Identifier: Apache-2.0
#include "server/polygon_reading.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "api/crs.hpp"
#include "api/formats/geojson_elevations.hpp"
#include "server/work.hpp"

namespace tinsmith::server {

namespace {

using Clock = std::chrono::steady_clock;

/// The options of the body stand after those from outside; the parser refuses contradictions.
std::vector<api::NamedOption> all_options(std::vector<api::NamedOption> given,
                                          const api::PolygonRequest& request) {
    for (const auto& [name, value] : request.options) {
        given.push_back({name, value, "/tinsmith/" + name});
    }
    return given;
}

/// The edit takes over all but what leads back into the body.
PolygonEdit edit_of(std::vector<api::RequestedShape>& shapes, const api::PolygonOptions& options) {
    PolygonEdit edit;
    edit.dry_run = options.dry_run;
    edit.want_angles = options.angles;
    edit.winding = options.winding;
    edit.options = options.integrate;
    for (api::RequestedShape& shape : shapes) {
        edit.origins.push_back({std::move(shape.id), std::move(shape.properties), shape.type,
                                shape.shape.paths.size(), shape.polygon_starts});
        edit.shapes.push_back(std::move(shape.shape));
    }
    return edit;
}

/// As near as the place is known. A body that is a geometry has no pointer of its own.
std::string pointer_of(const core::ErrorPlace& place,
                       const std::vector<api::RequestedShape>& shapes) {
    if (!place.shape || *place.shape >= shapes.size()) return {};
    const api::RequestedShape& shape = shapes[*place.shape];
    if (!place.path) return shape.pointer;
    return place.point ? api::coordinate_pointer(shape, *place.path, *place.point)
                       : api::path_pointer(shape, *place.path);
}

}  // namespace

api::Parsed<api::CrsClaim> claim_of(const api::PolygonRequest& request,
                                    std::span<const api::NamedOption> options) {
    api::CrsClaim claim{request.crs, request.crs_pointer};
    const auto option = std::ranges::find(options, "crs", &api::NamedOption::name);
    if (option == options.end()) return claim;
    const std::string wanted = api::normalise_crs(option->value).value_or(option->value);
    if (claim.crs.empty()) return api::CrsClaim{wanted, option->pointer};
    if (api::same_crs(claim.crs, wanted)) return claim;
    return {api::FaultKind::Invalid,
            api::Fault{"CONTRADICTION",
                       "The body's crs is " + claim.crs + ", the option crs is " + wanted +
                           ": give one, or the same twice.",
                       claim.pointer}};
}

api::Parsed<PolygonWork> read_polygon_work(std::string_view body,
                                           std::vector<api::NamedOption> given,
                                           const api::ReadLimits& limits) {
    auto request = api::read_geojson(body, limits);
    if (!request) return {request.kind(), std::move(request.faults())};
    const auto named = all_options(std::move(given), *request);
    auto options = api::parse_polygon_options(named);
    if (!options) return {options.kind(), std::move(options.faults())};

    if (options->own_elevations) {
        auto faults = api::elevation_faults(request->shapes, limits.max_faults);
        if (!faults.empty()) return {api::FaultKind::Invalid, std::move(faults)};
    } else {
        api::drop_elevations(request->shapes);
    }

    auto claim = claim_of(*request, named);
    if (!claim) return {claim.kind(), std::move(claim.faults())};
    PolygonWork work;
    work.edit = edit_of(request->shapes, *options);
    work.shapes = std::move(request->shapes);
    work.claim = *std::move(claim);
    work.claim.heights = options->own_elevations;
    return work;
}

api::Faults bring_into(PolygonWork& work, const std::string& session_crs) {
    return api::bring_into(session_crs, work.claim, work.edit.shapes, work.shapes, api::kMaxFaults);
}

api::Faults faults_of(const core::Errors& errors, const std::vector<api::RequestedShape>& shapes) {
    api::Faults faults;
    for (const core::Error& error : errors) {
        api::Fault fault{std::string(core::code_name(error.code)), error.detail,
                         pointer_of(error.place, shapes)};
        if (error.place.position) {
            fault.coordinate = {error.place.position->x, error.place.position->y};
        }
        faults.push_back(std::move(fault));
    }
    return faults;
}

RunLimits rerun_limits(const Limits& limits, const std::atomic<bool>& stopping) {
    const auto start = Clock::now();
    RunLimits run;
    run.cancelled = deadline(limits, stopping);
    run.clock_ms = [start] {
        return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    };
    run.progress = stage_progress();
    return run;
}

void set_budgets(PolygonEdit& edit, const Limits& limits, const std::atomic<bool>& stopping) {
    RunLimits run = rerun_limits(limits, stopping);
    edit.most = {limits.max_triangles, limits.max_session_bytes};
    edit.options.max_crossings = limits.max_crossings;
    edit.options.clock_ms = std::move(run.clock_ms);
    edit.options.cancelled = std::move(run.cancelled);
    edit.options.progress = std::move(run.progress);
}

}  // namespace tinsmith::server
