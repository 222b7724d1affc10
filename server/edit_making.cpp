// SPDX-License-Identifier: Apache-2.0
#include "server/edit_making.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "api/ring_offset.hpp"
#include "core/edit/cutout.hpp"
#include "server/polygon_reading.hpp"

namespace tinsmith::server {

namespace {

/// A polygon of the session, copied out.
struct Drawn {
    core::Shape shape;
    core::Winding winding = core::Winding::EvenOdd;
    double snap = 0.0;
};

std::optional<Drawn> copy_polygon(const Session& session, const std::string& id) {
    return session.look([&id](const core::Tin&, const std::vector<Polygon>& polygons,
                              std::uint64_t) -> std::optional<Drawn> {
        for (const Polygon& polygon : polygons) {
            if (polygon.id() != id) continue;
            return Drawn{polygon.outline(), polygon.request.winding, polygon.request.options.snap};
        }
        return std::nullopt;
    });
}

std::string text_of(double value) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    return {digits.data(), end};
}

/// A fault of the member that gives the width, or of the body where it is the default.
api::Fault width_fault(const api::EditRequest& request, std::string_view code,
                       const std::string& rest) {
    const bool is_taper = request.taper.has_value();
    const std::string name = is_taper ? "taper" : "rim";
    const double width = is_taper ? *request.taper : *request.rim;
    const bool is_given = is_taper || request.rim_is_given;
    return {
        std::string(is_taper ? "TAPER_" : "RIM_") + std::string(code),
        "A " + name + " of " + text_of(width) + (is_given ? "" : ", which is the default,") + rest,
        is_given ? "/" + name : std::string()};
}

NoEdit no_ring(const api::EditRequest& request, const api::NoRing& no) {
    switch (no.reason) {
        case api::NoRing::Reason::Empty:
            return PolygonFault::NoInside;
        case api::NoRing::Reason::TooThin:
            return width_fault(
                request, "TOO_WIDE",
                " leaves nothing of the polygon, or of a part of it: give a rim of " +
                    text_of(no.limit) + " at most, or \"border\": \"new\", which needs none.");
        case api::NoRing::Reason::TooSmall:
            return width_fault(request, "TOO_SMALL",
                               " is lost in the rounding of coordinates as large as these: give "
                               "at least " +
                                   text_of(no.limit) + ".");
        case api::NoRing::Reason::Stopped:
            return core::Errors{core::Error{
                core::ErrorCode::Cancelled, "the request was cancelled; nothing was changed", {}}};
        case api::NoRing::Reason::Failed:
            break;
    }
    return width_fault(request, "FAILED",
                       " cannot be drawn around this polygon: give another width, or \"border\": "
                       "\"new\", which needs none.");
}

std::variant<core::Strip, NoEdit> make_strip(const Drawn& polygon, const api::EditRequest& request,
                                             const core::CutoutLimits& limits) {
    const double width = request.taper ? *request.taper : *request.rim;
    if (width <= polygon.snap) {
        return NoEdit(width_fault(request, "TOO_SMALL",
                                  " is no wider than the polygon's snap: its border may lie " +
                                      text_of(polygon.snap) +
                                      " beside its line. Give more than that, or \"border\": "
                                      "\"new\"."));
    }
    const auto area = core::triangles_inside(polygon.shape, polygon.winding, limits);
    if (!area) return NoEdit(area.errors());
    auto made = request.taper ? api::ring_outside(*area, width, limits.cancelled)
                              : api::ring_inside(*area, width, limits.cancelled);
    if (const auto* no = std::get_if<api::NoRing>(&made)) return no_ring(request, *no);
    auto& [ring, border] = std::get<api::RingOffset>(made);
    if (request.taper)
        return core::Strip{core::Strip::Kind::Taper, width, std::move(ring), std::move(border)};
    return core::Strip{core::Strip::Kind::Rim, width, std::move(ring), {}};
}

std::variant<core::RegionEdit, NoEdit> make_change(const Drawn& polygon,
                                                   const api::EditRequest& request,
                                                   const core::CutoutLimits& limits) {
    core::ElevationEdit raised;
    switch (request.operation) {
        case api::EditKind::Smooth:
            return core::SmoothEdit{static_cast<std::uint32_t>(request.passes),
                                    request.moves_border};
        case api::EditKind::Remove:
        case api::EditKind::Keep:
            return core::TrimEdit{request.operation == api::EditKind::Keep};
        case api::EditKind::Set:
            raised.change = request.plane;
            break;
        case api::EditKind::Offset:
            raised.change = core::ElevationEdit::Offset{request.by};
            break;
    }
    if (request.rim || request.taper) {
        auto strip = make_strip(polygon, request, limits);
        if (auto* no = std::get_if<NoEdit>(&strip)) return std::move(*no);
        raised.strip = std::move(std::get<core::Strip>(strip));
    }
    return raised;
}

}  // namespace

std::variant<PendingEdit, NoEdit> make_edit(const Session& session, const api::EditRequest& request,
                                            const Limits& limits,
                                            const std::atomic<bool>& stopping) {
    PendingEdit edit;
    edit.limits = rerun_limits(limits, stopping);
    edit.limits.max_crossings = limits.max_crossings;
    edit.most = {limits.max_triangles, limits.max_session_bytes};

    const auto polygon = copy_polygon(session, request.polygon);
    if (!polygon) return NoEdit(PolygonFault::NotThere);
    if (std::ranges::none_of(polygon->shape.paths, &core::Path::closed))
        return NoEdit(PolygonFault::NoInside);
    auto change = make_change(*polygon, request,
                              {limits.max_crossings, limits.max_triangles, edit.limits.cancelled});
    if (auto* no = std::get_if<NoEdit>(&change)) return std::move(*no);
    edit.operation.edit = std::move(std::get<core::RegionEdit>(change));
    edit.operation.asked = {request.operation, request.polygon, request.moves_border,
                            request.rim,       request.taper,   {}};
    edit.operation.asked.report.apply_ms = edit.limits.clock_ms();
    return edit;
}

}  // namespace tinsmith::server
