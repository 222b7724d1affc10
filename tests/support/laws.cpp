// SPDX-License-Identifier: Apache-2.0
#include "tests/support/laws.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/integrate/integrator.hpp"
#include "tests/support/same_bytes.hpp"
#include "tests/verify/edit.hpp"

namespace tinsmith::test {

using core::MeshData;
using core::Path;
using core::Point3;
using core::Tin;

namespace {

/// Whether the request leaves the surface as it is.
bool keeps_surface(const Request& request) {
    if (request.options.improve != core::Improve::None &&
        request.options.improve != core::Improve::Strict)
        return false;
    for (const auto& shape : request.shapes)
        for (const Path& path : shape.paths)
            if (!path.elevations.empty()) return false;
    return true;
}

/// The vertices in order of position.
std::vector<Point3> sorted_vertices(const MeshData& mesh) {
    std::vector<Point3> found = mesh.vertices;
    std::sort(found.begin(), found.end(), [](const Point3& l, const Point3& r) {
        return l.x != r.x ? l.x < r.x : l.y != r.y ? l.y < r.y : l.z < r.z;
    });
    return found;
}

/// Whether each vertex of one has a vertex of the other within `reach` in plan.
bool is_near_all(const std::vector<Point3>& these, const std::vector<Point3>& those, double reach) {
    return std::all_of(these.begin(), these.end(), [&](const Point3& p) {
        auto q = std::lower_bound(those.begin(), those.end(), p.x - reach,
                                  [](const Point3& l, double x) { return l.x < x; });
        for (; q != those.end() && q->x <= p.x + reach; ++q)
            if (std::fabs(q->y - p.y) <= reach) return true;
        return false;
    });
}

Request reversed(const Request& request) {
    Request other = request;
    for (auto& shape : other.shapes) {
        for (Path& path : shape.paths) {
            if (!path.closed || path.points.size() < 3) continue;
            std::reverse(path.points.begin(), path.points.end());
            std::rotate(path.points.begin(),
                        path.points.begin() + static_cast<std::ptrdiff_t>(path.points.size() / 3),
                        path.points.end());
        }
    }
    return other;
}

}  // namespace

std::vector<std::string> check_laws(const Tin& tin, const Request& request) {
    std::vector<std::string> broken;
    const MeshData before = tin.to_data();
    Tin first = tin;
    core::Undo undo;
    const auto report = core::integrate(first, request.shapes, request.options, &undo);
    if (!report) return broken;
    const MeshData after = first.to_data();

    Tin other = tin;
    core::IntegrateOptions elsewhere = request.options;
    elsewhere.walk_seed = 12345;
    if (!core::integrate(other, request.shapes, elsewhere) || !same_bytes(other.to_data(), after))
        broken.push_back("COPY: a walk from elsewhere gives other bytes");

    const std::string twice = request.options.snap > 0.0 ? "TWICE_SNAPPED: " : "TWICE: ";
    if (keeps_surface(request)) {
        const auto again = core::integrate(other, request.shapes, request.options);
        if (!again)
            broken.push_back(twice + "refused the second time: " + again.errors()[0].detail);
        else if (other.vertex_count() != first.vertex_count())
            broken.push_back(verify::words(twice, "the second time adds ",
                                           other.vertex_count() - first.vertex_count(),
                                           " vertices"));
    }
    if (keeps_surface(request) && request.options.improve == core::Improve::None &&
        request.options.snap == 0.0) {
        Tin turned = tin;
        const Request backwards = reversed(request);
        const auto result = core::integrate(turned, backwards.shapes, request.options);
        const auto these = sorted_vertices(after), those = sorted_vertices(turned.to_data());
        // Rounding moves a crossing along lines that are almost parallel, so it has room.
        const verify::TriangleGrid grid(before);
        const double reach = std::max(1e-9 * grid.extent(), 16 * grid.rounding_reach());
        if (!result)
            broken.push_back("REVERSED: refused: " + result.errors()[0].detail);
        else if (these.size() != those.size() || !is_near_all(these, those, reach) ||
                 !is_near_all(those, these, reach))
            broken.push_back(
                verify::words("REVERSED: other vertices, ", these.size(), " and ", those.size()));
    }
    core::take_back(first, undo);
    if (!same_bytes(first.to_data(), before))
        broken.push_back("UNDO: taking the operation back leaves other bytes");
    return broken;
}

}  // namespace tinsmith::test
