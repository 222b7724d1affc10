// SPDX-License-Identifier: Apache-2.0
// The constrained edges as lines, for GIS programs.
#include <algorithm>
#include <array>
#include <charconv>
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

/// How many lines the pages before had; the order of the lines is that of one version's mesh.
std::size_t lines_before(const std::string& after) {
    std::size_t count = 0;
    std::from_chars(after.data(), after.data() + after.size(), count);
    return count;
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
    const RegionLimits limits{services.limits.max_crossings,
                              deadline(services.limits, services.stopping)};
    const auto lines =
        find_constraint_lines(ground, limits_for_all(limits, ground.tin.triangle_count()));
    if (!lines) return refuse_question(request, lines.errors());
    const auto& [limit, after] = std::get<0>(page);
    const std::size_t first = std::min(lines_before(after), lines->size());
    const std::size_t count = std::min(limit, lines->size() - first);
    Response response = ok(
        std::string(kTypes[std::get<0>(type)]),
        api::write_constraint_lines(std::span(*lines).subspan(first, count), session.facts().crs));
    if (first + count < lines->size()) {
        response.with("Link",
                      next_link(request, kCursorKind, limit, std::to_string(first + count)));
    }
    return response.with("ETag", etag_of(session, version, suffix)).with("Vary", "Accept");
}

}  // namespace tinsmith::server
