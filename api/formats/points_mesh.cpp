// SPDX-License-Identifier: Apache-2.0
#include "api/formats/points_mesh.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "api/side_by_side.hpp"
#include "core/mesh/delaunay.hpp"

namespace tinsmith::api {

namespace {

Parsed<Terrain> refusal(const core::Errors& errors, const ReadLimits& limits,
                        const PointsPlace& place) {
    Faults faults;
    auto kind = FaultKind::Invalid;
    for (const core::Error& error : errors) {
        if (error.code == core::ErrorCode::Cancelled)
            return {FaultKind::Stopped, reading_stopped()};
        if (error.code == core::ErrorCode::MeshTooLarge) kind = FaultKind::TooLarge;
        if (faults.size() == limits.max_faults) break;
        Fault fault{std::string(core::code_name(error.code)), error.detail, place.pointer};
        if (error.place.position) {
            fault.coordinate = {error.place.position->x, error.place.position->y};
        }
        if (error.place.vertex) {
            fault.index = *error.place.vertex;
            place.of_point(fault, *error.place.vertex, error.place.earlier);
        }
        faults.push_back(std::move(fault));
    }
    return {kind, std::move(faults)};
}

/// Which of the points each vertex is. What was left out is equal to one before it, and no vertex
/// is there twice.
std::vector<std::uint32_t> names_of(std::span<const core::Point3> vertices,
                                    std::span<const core::Point3> points) {
    std::vector<std::uint32_t> names;
    names.reserve(vertices.size());
    for (std::uint32_t i = 0; i < points.size() && names.size() < vertices.size(); ++i)
        if (points[i] == vertices[names.size()]) names.push_back(i);
    return names;
}

}  // namespace

Parsed<Terrain> triangulated(Terrain terrain, const ReadLimits& limits) {
    if (!terrain.points) return terrain;
    core::DelaunayOptions options;
    if (limits.progress)
        options.progress = [&limits](double share) { return limits.progress(0.5 + 0.5 * share); };
    options.executor = side_by_side;
    auto mesh = core::delaunay(terrain.mesh.vertices, options);
    if (!mesh) return refusal(mesh.errors(), limits, *terrain.points);
    if (mesh->triangles.size() > limits.max_triangles) {
        return {
            FaultKind::TooLarge,
            {"TOO_MANY_TRIANGLES",
             "The points make " + std::to_string(mesh->triangles.size()) + " triangles; at most " +
                 std::to_string(limits.max_triangles) + " are taken here.",
             terrain.points->pointer}};
    }
    if (mesh->vertices.size() < terrain.mesh.vertices.size())
        terrain.vertex_names = names_of(mesh->vertices, terrain.mesh.vertices);
    terrain.mesh = std::move(*mesh);
    terrain.triangles_are_made = true;
    terrain.points.reset();
    return terrain;
}

}  // namespace tinsmith::api
