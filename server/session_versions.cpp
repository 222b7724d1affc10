// SPDX-License-Identifier: Apache-2.0
// A session's mesh as it was.
#include <algorithm>
#include <utility>

#include "core/integrate/integrator.hpp"
#include "server/replay.hpp"
#include "server/session.hpp"

namespace tinsmith::server {

VersionOutcome Session::tin_at(std::uint64_t wanted, const RunLimits& limits) const {
    auto state = state_at(wanted, limits);
    if (auto* found = std::get_if<SessionState>(&state)) return std::move(found->tin);
    if (const auto* gone = std::get_if<VersionGone>(&state)) return *gone;
    if (const auto* ahead = std::get_if<VersionAhead>(&state)) return *ahead;
    return std::get<core::Errors>(std::move(state));
}

StateOutcome Session::state_at(std::uint64_t wanted, const RunLimits& limits) const {
    auto lock = lock_to_read();
    if (wanted == 0 || wanted > version()) return VersionAhead{version()};
    auto way = history_.way_to(wanted);
    if (const auto* gone = std::get_if<VersionGone>(&way)) return *gone;
    core::Tin tin = tin_;
    // Views, of operations that a later change may drop: held while they are looked at.
    std::vector<AppliedPtr> held = history_.applied();
    const auto polygons = history_.polygons();
    lock.unlock();
    const auto& [taken, again] = std::get<WayBack>(way);
    for (auto applied = taken.rbegin(); applied != taken.rend(); ++applied)
        core::take_back(tin, (*applied)->undo);
    const PolygonFinder find = [&polygons](std::string_view id) {
        const auto found = std::ranges::find(polygons, id, &Polygon::id);
        return found == polygons.end() ? std::optional<Polygon>() : *found;
    };
    auto done = run_all(tin, again, limits, find);
    if (auto* failure = std::get_if<ReplayFailure>(&done)) return std::move(failure->errors);
    // What was taken back brought the newest polygons; what was run again brings its own.
    std::size_t stay = polygons.size();
    for (const AppliedPtr& applied : taken)
        stay -= polygon_ids(*applied->operation).size();
    SessionState state{std::move(tin), {}, std::move(held)};
    for (std::size_t i = 0; i < stay; ++i)
        state.polygons.push_back(polygons[i]);
    for (AppliedPtr& applied : std::get<std::vector<AppliedPtr>>(done)) {
        const auto* request = std::get_if<PolygonsOperation>(applied->operation.get());
        for (std::size_t i = 0; request != nullptr && i < request->shapes.size(); ++i)
            state.polygons.push_back({*request, *applied->report, i});
        state.held.push_back(std::move(applied));
    }
    return state;
}

std::size_t Session::mesh_bytes_since(std::uint64_t wanted) const {
    const auto lock = lock_to_read();
    std::size_t most = tin_.memory_bytes();
    for (const Change& change : history_.changes()) {
        if (change.version < wanted) continue;
        const std::size_t vertices = sizeof(core::Tin::Vertex) + sizeof(core::VertexId);
        most = std::max(
            most, change.vertices * vertices + change.triangles * sizeof(core::Tin::Triangle));
    }
    return most;
}

std::variant<std::monostate, VersionGone, VersionAhead> Session::missing(
    std::uint64_t wanted) const {
    const auto lock = lock_to_read();
    if (wanted == 0 || wanted > version()) return VersionAhead{version()};
    const auto way = history_.way_to(wanted);
    if (const auto* gone = std::get_if<VersionGone>(&way)) return *gone;
    return std::monostate{};
}

}  // namespace tinsmith::server
