// SPDX-License-Identifier: Apache-2.0
// The constrained edges as lines, for GIS programs.
#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <span>
#include <utility>

#include "server/region_shapes.hpp"
#include "server/reply.hpp"
#include "server/routes/handlers.hpp"
#include "server/routes/paging.hpp"
#include "server/routes/route_support.hpp"
#include "server/work.hpp"

namespace tinsmith::server {

namespace {

constexpr std::string_view kCursorKind = "constraint";
constexpr std::array<std::string_view, 2> kTypes{kGeoJson, kJson};

/// How many lines the pages before had, at a version: the order of the lines is that of its mesh.
struct Place {
    std::uint64_t version = 0;
    std::size_t lines = 0;
};

/// Nothing where it is none of ours.
std::optional<Place> place_in(const std::string& after) {
    Place place;
    const char* const end = after.data() + after.size();
    const auto [dash, error] = std::from_chars(after.data(), end, place.version);
    if (error != std::errc() || dash == end || *dash != '-') return std::nullopt;
    const auto [stop, other] = std::from_chars(dash + 1, end, place.lines);
    return other == std::errc() && stop == end ? std::optional(place) : std::nullopt;
}

Response refuse_cursor(const Request& request, std::uint64_t version) {
    std::string detail = "The session has changed since that page, and is at version " +
                         std::to_string(version) + " now: begin again, without cursor.";
    return refuse(request, {api::ProblemType::InvalidParameter,
                            detail,
                            {{"CURSOR_OUTDATED", detail, {}, {}, {}, "cursor"}}});
}

}  // namespace

Response list_constraints(Services& services, const Request& request,
                          const PathArguments& arguments) {
    const auto found = require_session(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    const auto type = require_media_type(request, kTypes);
    if (const auto* refusal = std::get_if<Response>(&type)) return *refusal;
    const auto page = require_page(request, kCursorKind);
    if (const auto* refusal = std::get_if<Response>(&page)) return *refusal;
    const Session& session = *std::get<0>(found);
    const std::string_view suffix =
        std::get<0>(type) == 0 ? "-constraints-geojson" : "-constraints-json";
    if (auto answer = answer_to_conditions(request, session, session.view().version, suffix))
        return answer->with("Vary", "Accept");
    const std::size_t bytes =
        session.mesh_bytes() +
        session.look([](const core::Tin& tin, const std::vector<Polygon>& polygons, std::uint64_t) {
            return region_bytes(tin, polygons);
        });
    const auto memory = require_memory(services, request, bytes);
    if (const auto* refusal = std::get_if<Response>(&memory)) return *refusal;
    const auto [ground, version] = session.look(
        [](const core::Tin& tin, const std::vector<Polygon>& polygons, std::uint64_t now) {
            return std::pair(constraint_ground(tin, polygons), now);
        });
    const auto& [limit, after] = std::get<0>(page);
    const auto place = after.empty() ? Place{version, 0} : place_in(after).value_or(Place{});
    if (place.version != version) return refuse_cursor(request, version);
    const Limits all = services.limits_of(request.asker);
    const RegionLimits limits{all.max_crossings, deadline(all, services.stopping)};
    const auto lines =
        find_constraint_lines(ground, limits_for_all(limits, ground.tin.triangle_count()));
    if (!lines) return refuse_question(request, lines.errors());
    const std::size_t first = std::min(place.lines, lines->size());
    const std::size_t count = std::min(limit, lines->size() - first);
    Response response = ok(
        std::string(kTypes[std::get<0>(type)]),
        api::write_constraint_lines(std::span(*lines).subspan(first, count), session.facts().crs));
    if (first + count < lines->size()) {
        response.with("Link",
                      next_link(request, kCursorKind, limit,
                                std::to_string(version) + "-" + std::to_string(first + count)));
    }
    return response.with("ETag", etag_of(session, version, suffix)).with("Vary", "Accept");
}

}  // namespace tinsmith::server
