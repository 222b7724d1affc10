// SPDX-License-Identifier: Apache-2.0
#include "server/questions.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/edit/cutout.hpp"
#include "core/regions/winding_number.hpp"

namespace tinsmith::server {

namespace {

/// A polygon of a session, copied out: what outlives the lock.
struct Outline {
    core::Shape shape;
    core::Winding winding = core::Winding::EvenOdd;
    std::vector<core::Chain> chains;
    std::vector<core::OutsidePart> outside;
};

/// The mesh at one version, and what of a polygon finds its region there.
struct Ground {
    core::Tin tin;
    std::uint64_t version = 0;
    std::optional<Outline> polygon = {};
};

/// The triangles asked for, and the area asked for, on the mesh or not.
struct Part {
    core::Tin tin;
    std::vector<core::TriangleId> triangles;
    double area = 0.0;
};
using PartOutcome = std::variant<Part, core::Errors, PolygonFault>;

bool is_around(const Polygon& polygon, core::Point2 p) {
    std::vector<core::DirectedSegment> segments;
    for (const core::Path& path : polygon.outline().paths) {
        if (!path.closed) continue;
        for (std::size_t i = 0; i < path.points.size(); ++i)
            segments.push_back({path.points[i], path.points[(i + 1) % path.points.size()]});
    }
    if (segments.empty()) return false;
    const int times = core::WindingNumber(segments).around(p);
    return polygon.request.winding == core::Winding::EvenOdd ? times % 2 != 0 : times != 0;
}

Ground copy_ground(const Session& session, const std::string& polygon_id = {}) {
    return session.look([&](const core::Tin& tin, const std::vector<Polygon>& polygons,
                            std::uint64_t version) {
        Ground ground{tin, version};
        for (const Polygon& polygon : polygons) {
            if (polygon_id.empty() || polygon.id() != polygon_id) continue;
            const core::ShapeReport& report = polygon.own_report();
            ground.polygon =
                Outline{polygon.outline(), polygon.request.winding, report.chains, report.outside};
        }
        return ground;
    });
}

double plan_area(const core::Tin& tin, std::span<const core::TriangleId> triangles) {
    return core::volume_against(tin, triangles, core::level_plane(0.0)).area;
}

PartOutcome whole_of(core::Tin tin) {
    auto all = core::all_triangles(tin);
    const double area = plan_area(tin, all);
    return Part{std::move(tin), std::move(all), area};
}

PartOutcome inside_of_own(Ground ground, const core::CutoutLimits& limits) {
    if (!ground.polygon) return PolygonFault::NotThere;
    const Outline& polygon = *ground.polygon;
    if (std::ranges::none_of(polygon.shape.paths, &core::Path::closed))
        return PolygonFault::NoInside;
    core::Region region =
        core::find_region(ground.tin, core::ConstraintHistory(ground.tin),
                          {polygon.shape, polygon.chains, polygon.outside}, polygon.winding);
    auto area = core::area_inside(polygon.shape, polygon.winding, limits);
    if (!area) return std::move(area.errors());
    return Part{std::move(ground.tin), std::move(region.triangles), *area};
}

PartOutcome part_of(Ground ground, const api::VolumeRequest& request,
                    const core::CutoutLimits& limits) {
    if (!request.polygon_id.empty()) return inside_of_own(std::move(ground), limits);
    if (!request.shape) return whole_of(std::move(ground.tin));
    auto cutout =
        core::cut_out(std::move(ground.tin), request.shape->shape, core::Winding::EvenOdd, limits);
    if (!cutout) return std::move(cutout.errors());
    return Part{std::move(cutout->tin), std::move(cutout->region.triangles), cutout->shape_area};
}

/// What is compared with, where it is no plane.
struct Surface {
    core::Tin tin;
    std::uint64_t version = 0;
};
using SurfaceOutcome = std::variant<Surface, VersionGone, VersionAhead, core::Errors>;

SurfaceOutcome surface_of(const Session& session, const api::Against& against, const Session* other,
                          const std::function<bool()>& cancelled) {
    const auto* earlier = std::get_if<api::EarlierVersion>(&against);
    if (earlier == nullptr) {
        Ground ground = copy_ground(*other);
        return Surface{std::move(ground.tin), ground.version};
    }
    RunLimits limits;
    limits.cancelled = cancelled;
    limits.progress = stage_progress();
    auto tin = session.tin_at(earlier->version, limits);
    if (const auto* gone = std::get_if<VersionGone>(&tin)) return *gone;
    if (const auto* ahead = std::get_if<VersionAhead>(&tin)) return *ahead;
    if (auto* errors = std::get_if<core::Errors>(&tin)) return std::move(*errors);
    return Surface{std::move(std::get<core::Tin>(tin)), earlier->version};
}

/// What rounding leaves of two equal areas counts as nothing.
double left_out(double asked, double compared) {
    constexpr double kRounding = 1e-10;
    const double rest = asked - compared;
    return rest > kRounding * asked ? rest : 0.0;
}

}  // namespace

SpotAnswer spot_in(const Session& session, core::Point2 p) {
    return session.look(
        [&](const core::Tin& tin, const std::vector<Polygon>& polygons, std::uint64_t version) {
            SpotAnswer answer{core::spot_at(tin, p), {}, version};
            if (!answer.spot) return answer;
            for (const Polygon& polygon : polygons) {
                if (is_around(polygon, p)) answer.polygons.push_back(polygon.id());
            }
            return answer;
        });
}

SpotsAnswer spots_in(const Session& session, std::span<const core::Point2> points) {
    SpotsAnswer answer;
    answer.spots.reserve(points.size());
    answer.version =
        session.look([&](const core::Tin& tin, const std::vector<Polygon>&, std::uint64_t version) {
            for (const core::Point2& p : points)
                answer.spots.push_back(core::spot_at(tin, p));
            return version;
        });
    return answer;
}

ProfileOutcome profile_in(const Session& session, std::span<const core::Point2> line,
                          const core::ProfileLimits& limits) {
    return session.look([&](const core::Tin& tin, const std::vector<Polygon>&,
                            std::uint64_t version) -> ProfileOutcome {
        auto profile = core::profile_along(tin, line, limits);
        if (!profile) return std::move(profile.errors());
        return ProfileAnswer{std::move(*profile), version};
    });
}

VolumeOutcome volume_in(const Session& session, const api::VolumeRequest& request,
                        const Session* other, const Limits& limits,
                        const std::atomic<bool>& stopping) {
    const auto cancelled = deadline(limits, stopping);
    Ground ground = copy_ground(session, request.polygon_id);
    VolumeAnswer answer;
    answer.version = ground.version;
    begin_stage(0.5);
    auto found = part_of(std::move(ground), request,
                         {limits.max_crossings, limits.max_triangles, cancelled, stage_progress()});
    if (auto* errors = std::get_if<core::Errors>(&found)) return std::move(*errors);
    if (const auto* fault = std::get_if<PolygonFault>(&found)) return *fault;
    const Part& part = std::get<Part>(found);
    if (const auto* plane = std::get_if<core::Plane>(&request.against)) {
        answer.volume = core::volume_against(part.tin, part.triangles, *plane);
    } else {
        begin_stage(0.2);
        auto theirs = surface_of(session, request.against, other, cancelled);
        if (const auto* gone = std::get_if<VersionGone>(&theirs)) return *gone;
        if (const auto* ahead = std::get_if<VersionAhead>(&theirs)) return *ahead;
        if (auto* errors = std::get_if<core::Errors>(&theirs)) return std::move(*errors);
        const Surface& surface = std::get<Surface>(theirs);
        answer.other_version = surface.version;
        begin_stage(1.0);
        auto volume = core::volume_between(part.tin, part.triangles, surface.tin, cancelled,
                                           stage_progress());
        if (!volume) return std::move(volume.errors());
        answer.volume = *volume;
        if (request.polygon_id.empty() && !request.shape) {
            // Asked for is all that either covers.
            const double area = plan_area(surface.tin, core::all_triangles(surface.tin));
            answer.area_left_out = left_out(area, answer.volume.area);
        }
    }
    answer.area_left_out += left_out(part.area, answer.volume.area);
    return answer;
}

std::size_t volume_bytes(const Session& session, const api::VolumeRequest& request,
                         const Session* other) {
    std::size_t bytes = session.mesh_bytes();
    if (other != nullptr) bytes += other->mesh_bytes();
    if (const auto* earlier = std::get_if<api::EarlierVersion>(&request.against))
        bytes += session.mesh_bytes_since(earlier->version);
    return bytes;
}

}  // namespace tinsmith::server
