// SPDX-License-Identifier: Apache-2.0
// The triangles and edges inside polygons: what selects them in a client's own mesh.
#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "server/region_shapes.hpp"
#include "server/regions.hpp"
#include "server/reply.hpp"
#include "server/routes/handlers.hpp"
#include "server/routes/paging.hpp"
#include "server/routes/route_support.hpp"
#include "server/work.hpp"

namespace tinsmith::server {

namespace {

constexpr std::string_view kCursorKind = "region";
/// The triangles to select, or the polygons that they make; their tags differ.
constexpr std::array<std::string_view, 2> kTypes{kJson, kGeoJson};
constexpr std::array<std::string_view, 2> kSuffixes{"-regions", "-regions-geojson"};

/// What a session has under its lock of the regions asked for.
struct RegionsCopy {
    std::optional<RegionGround> ground;     ///< none where no region is asked for
    std::optional<PartitionGround> shapes;  ///< in its place, where polygons are
    std::uint64_t version = 0;
    bool more = false;     ///< others follow these
    bool is_there = true;  ///< the polygon asked for, inside or not
};

void copy_ground(RegionsCopy& copy, const core::Tin& tin, const std::vector<Polygon>& polygons,
                 std::span<const std::size_t> wanted, bool as_shapes) {
    if (wanted.empty()) return;
    if (!as_shapes) {
        copy.ground = region_ground(tin, polygons, wanted);
        return;
    }
    std::vector<Polygon> some;
    for (const std::size_t i : wanted)
        some.push_back(polygons[i]);
    copy.shapes = partition_ground(tin, some);
}

/// At most `limit` regions, of those that came after p`number`.
RegionsCopy regions_after(const Session& session, std::uint64_t number, std::size_t limit,
                          bool as_shapes) {
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
            copy_ground(copy, tin, polygons, wanted, as_shapes);
            return copy;
        });
}

RegionsCopy region_of(const Session& session, const std::string& id, bool as_shapes) {
    return session.look(
        [&](const core::Tin& tin, const std::vector<Polygon>& polygons, std::uint64_t version) {
            RegionsCopy copy;
            copy.version = version;
            std::size_t i = 0;
            while (i < polygons.size() && polygons[i].id() != id)
                ++i;
            copy.is_there = i < polygons.size();
            if (copy.is_there && polygons[i].has_inside()) {
                copy_ground(copy, tin, polygons, {&i, 1}, as_shapes);
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

RegionLimits limits_of(const Services& services, const Request& request) {
    const Limits limits = services.limits_of(request.asker);
    return {limits.max_crossings, deadline(limits, services.stopping)};
}

}  // namespace

Response list_regions(Services& services, const Request& request, const PathArguments& arguments) {
    const auto found = require_session(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    const auto type = require_media_type(request, kTypes);
    if (const auto* refusal = std::get_if<Response>(&type)) return *refusal;
    const auto page = require_page(request, kCursorKind);
    if (const auto* refusal = std::get_if<Response>(&page)) return *refusal;
    const Session& session = *std::get<0>(found);
    const std::string_view suffix = kSuffixes[std::get<0>(type)];
    const std::uint64_t now = session.view().version;
    if (auto answer = answer_to_conditions(request, session, now, suffix))
        return answer->with("Vary", "Accept");
    const RegionLimits limits = limits_of(services, request);
    const auto memory = require_room(services, request, session);
    if (const auto* refusal = std::get_if<Response>(&memory)) return *refusal;
    const auto& [limit, after] = std::get<0>(page);
    RegionsCopy copy = regions_after(session, polygon_number(after), limit, std::get<0>(type) == 1);
    Response response;
    std::string last;
    if (std::get<0>(type) == 1) {
        std::vector<api::RegionShape> shapes;
        if (copy.shapes) {
            auto told = find_shapes(*std::move(copy.shapes), limits);
            if (!told) return refuse_question(request, told.errors());
            shapes = std::move(*told);
        }
        if (!shapes.empty()) last = shapes.back().feature.id;
        response = ok(kGeoJson, api::write_region_features(shapes, session.facts().crs));
    } else {
        std::vector<api::RegionView> regions;
        if (copy.ground) {
            auto told = find_regions(*copy.ground, limits);
            if (!told) return refuse_question(request, told.errors());
            regions = std::move(*told);
        }
        if (!regions.empty()) last = regions.back().polygon;
        response = ok(kJson, api::write_regions(session.facts().id, copy.version,
                                                session.facts().unit, regions));
    }
    if (copy.more) response.with("Link", next_link(request, kCursorKind, limit, last));
    return response.with("ETag", etag_of(session, copy.version, suffix)).with("Vary", "Accept");
}

Response get_region(Services& services, const Request& request, const PathArguments& arguments) {
    const auto found = require_session(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    const auto type = require_media_type(request, kTypes);
    if (const auto* refusal = std::get_if<Response>(&type)) return *refusal;
    const Session& session = *std::get<0>(found);
    const std::string_view suffix = kSuffixes[std::get<0>(type)];
    const RegionLimits limits = limits_of(services, request);
    const auto memory = require_room(services, request, session);
    if (const auto* refusal = std::get_if<Response>(&memory)) return *refusal;
    RegionsCopy copy = region_of(session, arguments[1], std::get<0>(type) == 1);
    if (!copy.is_there) return no_such_polygon(request, session, arguments[1]);
    if (!copy.ground && !copy.shapes) {
        return refuse(request, api::ProblemType::NoSuchPolygon,
                      "\"" + arguments[1].substr(0, 64) +
                          "\" is a line or a point and has no inside. GET /v1/sessions/" +
                          session.facts().id + "/regions lists those that have one.");
    }
    if (auto answer = answer_to_conditions(request, session, copy.version, suffix))
        return answer->with("Vary", "Accept");
    Response response;
    if (copy.shapes) {
        const auto told = find_shapes(*std::move(copy.shapes), limits);
        if (!told) return refuse_question(request, told.errors());
        response = ok(kGeoJson, api::write_region_feature(told->front(), session.facts().crs));
    } else {
        const auto told = find_regions(*copy.ground, limits);
        if (!told) return refuse_question(request, told.errors());
        response = ok(kJson, api::write_region(session.facts().id, copy.version,
                                               session.facts().unit, told->front()));
    }
    return response.with("ETag", etag_of(session, copy.version, suffix)).with("Vary", "Accept");
}

}  // namespace tinsmith::server
