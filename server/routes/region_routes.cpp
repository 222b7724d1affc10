// SPDX-License-Identifier: Apache-2.0
// The triangles and edges inside polygons: what selects them in a client's own mesh.
#include <optional>
#include <utility>
#include <vector>

#include "server/regions.hpp"
#include "server/reply.hpp"
#include "server/routes/handlers.hpp"
#include "server/routes/paging.hpp"
#include "server/routes/route_support.hpp"
#include "server/work.hpp"

namespace tinsmith::server {

namespace {

constexpr std::string_view kCursorKind = "region";
constexpr std::string_view kSuffix = "-regions";

/// What a session has under its lock of the regions asked for.
struct RegionsCopy {
    std::optional<RegionGround> ground;  ///< none where no region is asked for
    std::uint64_t version = 0;
    bool more = false;     ///< others follow these
    bool is_there = true;  ///< the polygon asked for, inside or not
};

/// At most `limit` regions, of those that came after p`number`.
RegionsCopy regions_after(const Session& session, std::uint64_t number, std::size_t limit) {
    return session.look(
        [&](const core::Tin& tin, const std::vector<Polygon>& polygons, std::uint64_t version) {
            RegionsCopy copy;
            copy.version = version;
            std::vector<std::size_t> wanted;
            for (std::size_t i = 0; i < polygons.size(); ++i) {
                if (!polygons[i].has_inside() || polygons[i].number() <= number) continue;
                copy.more = wanted.size() == limit;
                if (copy.more) break;
                wanted.push_back(i);
            }
            if (!wanted.empty()) copy.ground = region_ground(tin, polygons, wanted);
            return copy;
        });
}

RegionsCopy region_of(const Session& session, const std::string& id) {
    return session.look(
        [&](const core::Tin& tin, const std::vector<Polygon>& polygons, std::uint64_t version) {
            RegionsCopy copy;
            copy.version = version;
            std::size_t i = 0;
            while (i < polygons.size() && polygons[i].id() != id)
                ++i;
            copy.is_there = i < polygons.size();
            if (copy.is_there && polygons[i].has_inside()) {
                copy.ground = region_ground(tin, polygons, {&i, 1});
            }
            return copy;
        });
}

/// Memory for the copy and what is noted of it; or 507.
Step<BorrowedMemory> require_room(Services& services, const Request& request,
                                  const Session& session) {
    const std::size_t bytes =
        session.look([](const core::Tin& tin, const std::vector<Polygon>& polygons, std::uint64_t) {
            return region_bytes(tin, polygons);
        });
    return require_memory(services, request, session.mesh_bytes() + bytes);
}

RegionLimits limits_of(const Services& services) {
    return {services.limits.max_crossings, deadline(services.limits, services.stopping)};
}

}  // namespace

Response list_regions(Services& services, const Request& request, const PathArguments& arguments) {
    const auto found = require_session(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    const auto page = require_page(request, kCursorKind);
    if (const auto* refusal = std::get_if<Response>(&page)) return *refusal;
    const Session& session = *std::get<0>(found);
    const std::uint64_t now = session.view().version;
    if (auto answer = answer_to_conditions(request, session, now, kSuffix)) return *answer;
    const RegionLimits limits = limits_of(services);
    const auto memory = require_room(services, request, session);
    if (const auto* refusal = std::get_if<Response>(&memory)) return *refusal;
    const auto& [limit, after] = std::get<0>(page);
    const RegionsCopy copy = regions_after(session, polygon_number(after), limit);
    std::vector<api::RegionView> regions;
    if (copy.ground) {
        auto told = find_regions(*copy.ground, limits);
        if (!told) return refuse_question(request, told.errors());
        regions = std::move(*told);
    }
    Response response = ok(
        kJson, api::write_regions(session.facts().id, copy.version, session.facts().unit, regions));
    if (copy.more) {
        response.with("Link", next_link(request, kCursorKind, limit, regions.back().polygon));
    }
    return response.with("ETag", etag_of(session, copy.version, kSuffix));
}

Response get_region(Services& services, const Request& request, const PathArguments& arguments) {
    const auto found = require_session(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    const Session& session = *std::get<0>(found);
    const RegionLimits limits = limits_of(services);
    const auto memory = require_room(services, request, session);
    if (const auto* refusal = std::get_if<Response>(&memory)) return *refusal;
    const RegionsCopy copy = region_of(session, arguments[1]);
    if (!copy.is_there) return no_such_polygon(request, session, arguments[1]);
    if (!copy.ground) {
        return refuse(request, api::ProblemType::NoSuchPolygon,
                      "\"" + arguments[1].substr(0, 64) +
                          "\" is a line or a point and has no inside. GET /v1/sessions/" +
                          session.facts().id + "/regions lists those that have one.");
    }
    if (auto answer = answer_to_conditions(request, session, copy.version, kSuffix)) return *answer;
    const auto told = find_regions(*copy.ground, limits);
    if (!told) return refuse_question(request, told.errors());
    return ok(kJson, api::write_region(session.facts().id, copy.version, session.facts().unit,
                                       told->front()))
        .with("ETag", etag_of(session, copy.version, kSuffix));
}

}  // namespace tinsmith::server
