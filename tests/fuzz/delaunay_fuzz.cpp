// SPDX-License-Identifier: Apache-2.0
// Any points: a mesh that holds the laws of core/mesh/delaunay.hpp, or faults.
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <vector>

#include "core/mesh/build.hpp"
#include "core/mesh/check.hpp"
#include "core/mesh/delaunay.hpp"
#include "core/predicates/in_circle.hpp"
#include "core/predicates/orientation.hpp"

namespace tinsmith {
namespace {

using core::Point3;

/// The first byte says how the others are points.
std::vector<Point3> points_of(const std::uint8_t* data, std::size_t size) {
    std::vector<Point3> points;
    if (size == 0) return points;
    const unsigned sort = data[0] % 4;
    ++data, --size;
    const auto moved = [](double x, unsigned ulps) {
        return std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) + ulps);
    };
    if (sort < 2) {  // a lattice of 16 steps or of 256
        const std::size_t each = sort == 0 ? 1 : 2;
        for (std::size_t i = 0; i + each <= size; i += each) {
            const unsigned x = sort == 0 ? data[i] >> 4 : data[i];
            const unsigned y = sort == 0 ? data[i] & 15U : data[i + 1];
            points.push_back({30.0 * x, 30.0 * y, 1.0});
        }
    } else if (sort == 2) {  // ulps around a few places of a map
        for (std::size_t i = 0; i + 2 <= size; i += 2) {
            const double x = 4e5 + (data[i] >> 4), y = 5e6 + (data[i + 1] >> 4);
            points.push_back({moved(x, data[i] & 15U), moved(y, data[i + 1] & 15U), 1.0});
        }
    } else {  // any doubles; their elevations differ
        for (std::size_t i = 0; i + 16 <= size; i += 16) {
            Point3 p{0, 0, data[i] % 2 == 0 ? 1.0 : 2.0};
            std::memcpy(&p.x, data + i, 8);
            std::memcpy(&p.y, data + i + 8, 8);
            points.push_back(p);
        }
    }
    return points;
}

void require(bool holds) {
    if (!holds) std::abort();
}

void check(const core::MeshData& mesh) {
    const auto tin = core::build_tin(mesh);
    require(tin.ok() && core::check_tin(*tin).empty());
    require(tin->vertex_count() == mesh.vertices.size());
    const auto plan = [&](std::uint32_t v) { return mesh.vertices[v].plan(); };
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> apexes;
    for (const auto& t : mesh.triangles)
        for (unsigned i = 0; i < 3; ++i)
            apexes[{t[i], t[(i + 1) % 3]}] = t[(i + 2) % 3];
    std::map<std::uint32_t, std::uint32_t> hull;
    for (const auto& [side, apex] : apexes) {
        const auto twin = apexes.find({side[1], side[0]});
        if (twin == apexes.end())
            hull[side[0]] = side[1];
        else
            require(core::in_circle(plan(side[0]), plan(side[1]), plan(apex), plan(twin->second)) !=
                    core::CircleSide::Inside);
    }
    for (const auto& [from, to] : hull)
        require(hull.contains(to) && core::orientation(plan(from), plan(to), plan(hull[to])) !=
                                         core::Orientation::Clockwise);
    require(mesh.triangles.size() == 2 * mesh.vertices.size() - 2 - hull.size());
}

}  // namespace
}  // namespace tinsmith

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tinsmith;
    const std::vector<Point3> points = points_of(data, size);
    core::DelaunayOptions by_halves;
    by_halves.least_to_part = 2;
    for (const core::DelaunayOptions& options : {core::DelaunayOptions{}, by_halves}) {
        const auto mesh = core::delaunay(points, options);
        if (mesh)
            check(*mesh);
        else
            require(!mesh.errors().empty() && mesh.errors().size() <= core::kMaxFaults);
    }
    return 0;
}
