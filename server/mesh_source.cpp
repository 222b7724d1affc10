// SPDX-License-Identifier: Apache-2.0
#include "server/mesh_source.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>

#include "api/formats/json_writer.hpp"

namespace tinsmith::server {

namespace {

/// "1,2,3,4", as bbox takes it.
std::string bounds_of(const core::MeshData& mesh) {
    double low_x = HUGE_VAL, low_y = HUGE_VAL, high_x = -HUGE_VAL, high_y = -HUGE_VAL;
    for (const core::Point3& p : mesh.vertices) {
        low_x = std::min(low_x, p.x);
        low_y = std::min(low_y, p.y);
        high_x = std::max(high_x, p.x);
        high_y = std::max(high_y, p.y);
    }
    std::string text;
    for (const double bound : {low_x, low_y, high_x, high_y}) {
        if (!text.empty()) text.push_back(',');
        api::json::append_number(text, bound);
    }
    return text;
}

}  // namespace

MeshGround ground_now(const Session& session, bool regions) {
    return session.look(
        [&](const core::Tin& tin, const std::vector<Polygon>& polygons, std::uint64_t version) {
            MeshGround ground{tin.to_data(), version, {}};
            if (regions) ground.regions = partition_ground(tin, polygons);
            return ground;
        });
}

MeshGround ground_of(const SessionState& state, std::uint64_t version, bool regions) {
    MeshGround ground{state.tin.to_data(), version, {}};
    if (regions) ground.regions = partition_ground(state.tin, state.polygons);
    return ground;
}

std::variant<MeshSource, NoSource> source_of(MeshGround ground, const api::MeshOptions& options,
                                             const std::string& unit, RegionLimits limits) {
    MeshSource source{std::move(ground.mesh), {}};
    if (ground.regions) {
        auto found =
            find_partition(*std::move(ground.regions), unit,
                           limits_for_all(std::move(limits), source.mesh.triangles.size()));
        if (!found) return NoSource(found.errors());
        source.regions = std::move(*found);
    }
    if (!options.bbox) return source;
    api::MeshPart part = api::part_within(source.mesh, *options.bbox);
    if (part.triangles.empty()) {
        return NoSource(api::Fault{
            "NOTHING_WITHIN",
            "bbox meets no triangle: the mesh lies within " + bounds_of(source.mesh) + ".",
            {},
            {},
            {},
            "bbox"});
    }
    if (source.regions) {
        std::vector<std::uint32_t> set_of;
        set_of.reserve(part.triangles.size());
        for (const std::uint32_t triangle : part.triangles)
            set_of.push_back(source.regions->set_of[triangle]);
        source.regions->set_of = std::move(set_of);
    }
    source.mesh = std::move(part.mesh);
    return source;
}

}  // namespace tinsmith::server
