// SPDX-License-Identifier: Apache-2.0
// Tinsmith's `strict` against CGAL's two recipes, on the same mesh and polygons, in one run:
//   a  constrained Delaunay triangulation of the terrain's points, the polygon inserted: the
//      surface moves;
//   b  the same with every edge of the terrain a constraint and elevations at intersections from
//      the terrain's edge: the surface stays. This is the fair peer.
// What is timed is the insertion alone, each time into a fresh copy; the peers' vertices come
// with their elevations already draped. Tinsmith's time is the report's, location, improvement and
// measuring included. Runs alternate; ratios are of paired runs. One thread.
// CGAL's triangulations are GPL: this program is never part of the product.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Projection_traits_xy_3.h>

#include "api/formats/geojson.hpp"
#include "api/formats/geotiff.hpp"
#include "core/integrate/integrator.hpp"
#include "core/mesh/build.hpp"
#include "core/mesh/surface.hpp"
#include "core/mesh/walk.hpp"

namespace {

using namespace tinsmith;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// Projection traits whose intersections take their elevation from the second segment, which is the
/// edge that the mesh has already. CGAL's own take the mean of both, which moves the surface.
struct Traits : CGAL::Projection_traits_xy_3<Kernel> {
    struct Intersect_2 {
        using Result = boost::optional<boost::variant<Kernel::Point_3, Kernel::Segment_3>>;
        Result operator()(const Kernel::Segment_3& s, const Kernel::Segment_3& edge) const {
            const auto &p = s.source(), &q = s.target();
            const auto &a = edge.source(), &b = edge.target();
            const double to_a =
                (q.x() - p.x()) * (a.y() - p.y()) - (q.y() - p.y()) * (a.x() - p.x());
            const double to_b =
                (q.x() - p.x()) * (b.y() - p.y()) - (q.y() - p.y()) * (b.x() - p.x());
            if (to_a == to_b) return {};
            const double t = to_a / (to_a - to_b);
            return Result{Kernel::Point_3(a.x() + (b.x() - a.x()) * t, a.y() + (b.y() - a.y()) * t,
                                          a.z() + (b.z() - a.z()) * t)};
        }
    };
    Intersect_2 intersect_2_object() const { return {}; }
};

using Peer =
    CGAL::Constrained_Delaunay_triangulation_2<Traits, CGAL::Default, CGAL::Exact_predicates_tag>;

double now_ms() {
    using namespace std::chrono;
    return duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

std::string read_data(const std::string& name) {
    std::ifstream in(std::string(TINSMITH_SOURCE_DIR) + "/tests/data/" + name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

/// The peer's base: the points, and for recipe b every edge of the mesh as a constraint.
Peer make_peer(const core::MeshData& mesh, bool edges) {
    Peer peer;
    std::vector<Peer::Vertex_handle> handles;
    Peer::Face_handle hint;
    for (const auto& v : mesh.vertices) {
        handles.push_back(peer.insert({v.x, v.y, v.z}, hint));
        hint = handles.back()->face();
    }
    if (!edges) return peer;
    for (const auto& t : mesh.triangles)
        for (unsigned i = 0; i < 3; ++i)
            if (t[i] < t[(i + 1) % 3])
                peer.insert_constraint(handles[t[i]], handles[t[(i + 1) % 3]]);
    return peer;
}

double time_peer(const Peer& base, const std::vector<std::vector<Kernel::Point_3>>& paths) {
    Peer peer = base;
    const double start = now_ms();
    Peer::Face_handle hint = peer.finite_faces_begin();
    for (const auto& path : paths) {
        Peer::Vertex_handle before;
        for (const auto& p : path) {
            const Peer::Vertex_handle v = peer.insert(p, hint);
            hint = v->face();
            if (before != Peer::Vertex_handle() && before != v) peer.insert_constraint(before, v);
            before = v;
        }
    }
    return now_ms() - start;
}

double time_ours(const core::Tin& base, const std::vector<core::Shape>& shapes,
                 std::uint64_t& added) {
    core::Tin tin = base;
    core::IntegrateOptions options;
    options.clock_ms = now_ms;
    const auto report = core::integrate(tin, shapes, options);
    if (!report) return 0.0;
    added = report->shapes[0].vertices_added;
    return report->time_ms.locate + report->time_ms.integrate + report->time_ms.improve;
}

}  // namespace

int main(int count, char** arguments) {
    const int runs = count > 1 ? std::atoi(arguments[1]) : 15;
    const auto terrain = api::read_geotiff(read_data("jacksboro.tif"), {});
    if (!terrain) return 1;
    const auto tin = core::build_tin(terrain->mesh);
    if (!tin) return 1;
    const Peer plain = make_peer(terrain->mesh, false);
    const Peer fixed = make_peer(terrain->mesh, true);
    std::printf("%zu triangles, %d paired runs; medians, ratio of medians of pairs\n",
                tin->triangle_count(), runs);
    std::printf("%-14s %9s %9s %9s %9s %12s %8s %8s\n", "polygon", "vertices", "ours ms", "a ms",
                "b ms", "ours ns/vert", "ours/a", "ours/b");
    for (const char* name : {"parcel", "lake", "road", "contour_450", "contour_3500"}) {
        const auto request = api::read_geojson(read_data(std::string(name) + ".geojson"), {});
        if (!request) return 1;
        std::vector<core::Shape> shapes{request->shapes[0].shape};
        std::vector<std::vector<Kernel::Point_3>> paths;
        for (const auto& path : shapes[0].paths) {
            paths.emplace_back();
            const auto drape = [&](core::Point2 p) {
                const auto at = core::locate(*tin, p, tin->hint(p));
                const double z = at.kind == core::Location::Kind::OnVertex
                                     ? tin->vertex(at.vertex).z
                                     : core::elevation_in(*tin, at.side.triangle(), p);
                paths.back().emplace_back(p.x, p.y, z);
            };
            for (const auto& p : path.points)
                drape(p);
            if (path.closed) drape(path.points.front());
        }
        std::vector<double> ours, a, b, to_a, to_b;
        std::uint64_t added = 0;
        for (int run = 0; run < runs; ++run) {
            ours.push_back(time_ours(*tin, shapes, added));
            a.push_back(time_peer(plain, paths));
            b.push_back(time_peer(fixed, paths));
            to_a.push_back(ours.back() / a.back());
            to_b.push_back(ours.back() / b.back());
        }
        std::printf("%-14s %9llu %9.3f %9.3f %9.3f %12.0f %8.2f %8.2f\n", name,
                    static_cast<unsigned long long>(added), median(ours), median(a), median(b),
                    median(ours) * 1e6 / static_cast<double>(added), median(to_a), median(to_b));
    }
}
