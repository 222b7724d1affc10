// SPDX-License-Identifier: Apache-2.0
// The verifier finds each kind of fault that is planted in a mesh that it found right.
#include "tests/verify/verifier.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "core/integrate/integrator.hpp"
#include "core/mesh/build.hpp"

namespace tinsmith::verify {
namespace {

using core::MeshData;

/// A rough grid with a ring and a line that leaves the mesh integrated into it.
class Planted : public testing::Test {
  protected:
    void SetUp() override {
        constexpr std::uint32_t n = 5;
        for (std::uint32_t r = 0; r <= n; ++r)
            for (std::uint32_t c = 0; c <= n; ++c)
                before_.vertices.push_back({100.0 + c, 200.0 + r, 0.25 * ((c * 7 + r * 5) % 4)});
        for (std::uint32_t r = 0; r < n; ++r) {
            for (std::uint32_t c = 0; c < n; ++c) {
                const std::uint32_t a = r * (n + 1) + c;
                before_.triangles.push_back({a, a + 1, a + n + 2});
                before_.triangles.push_back({a, a + n + 2, a + n + 1});
            }
        }
        core::Path ring{{{101.3, 201.2}, {103.6, 201.7}, {102.4, 203.4}}, true};
        core::Path line{{{104.1, 201.4}, {107.0, 203.1}}, false};
        shapes_ = {{{ring}}, {{line}}};
        auto tin = core::build_tin(before_);
        ASSERT_TRUE(tin.ok());
        const auto report = core::integrate(*tin, shapes_, options_);
        ASSERT_TRUE(report.ok());
        for (const auto& shape : report->shapes)
            certified_ += shape.max_vertical_deviation;
        after_ = tin->to_data();
        ASSERT_EQ(check(after_), Faults{});
    }

    Faults check(const MeshData& after) const {
        return Verifier(before_).step(after, shapes_, options_, certified_);
    }
    /// The guarantee that the first fault names.
    std::string found(const MeshData& after) const {
        const Faults faults = check(after);
        return faults.empty() ? "nothing" : faults.front();
    }

    /// The first edge that two triangles share and `wanted` takes, as its triangles and corners:
    /// a -> b with apex c in the first, d in the second.
    struct Edge {
        std::uint32_t first, second, a, b, c, d;
    };
    template <typename Wanted>
    Edge edge_where(const Wanted& wanted) const {
        const Stars stars(after_);
        for (std::uint32_t t = 0; t < after_.triangles.size(); ++t) {
            for (unsigned i = 0; i < 3; ++i) {
                const auto& v = after_.triangles[t];
                const std::uint32_t a = v[i], b = v[(i + 1) % 3], c = v[(i + 2) % 3];
                const std::uint32_t u = stars.triangle_of(b, a);
                if (u == kNone) continue;
                const auto& w = after_.triangles[u];
                const std::uint32_t d = *std::find_if(
                    w.begin(), w.end(), [&](std::uint32_t x) { return x != a && x != b; });
                if (const Edge edge{t, u, a, b, c, d}; wanted(edge)) return edge;
            }
        }
        ADD_FAILURE() << "there is no such edge";
        return {};
    }
    Point2 plan(std::uint32_t v) const { return after_.vertices[v].plan(); }
    bool may_swap(const Edge& e) const {
        return side_of(plan(e.c), plan(e.d), plan(e.b)) > 0 &&
               side_of(plan(e.d), plan(e.c), plan(e.a)) > 0;
    }
    bool is_constrained(const Edge& e) const {
        return std::any_of(after_.constraints.begin(), after_.constraints.end(), [&](auto c) {
            return std::minmax(c[0], c[1]) == std::minmax(e.a, e.b);
        });
    }
    /// The quad of the edge cut along its other diagonal.
    MeshData swapped(const Edge& e) const {
        MeshData mesh = after_;
        mesh.triangles[e.first] = {e.c, e.d, e.b};
        mesh.triangles[e.second] = {e.d, e.c, e.a};
        return mesh;
    }
    bool bends(const Edge& e) const {
        const auto& v = after_.vertices;
        return gap_at_crossing(v[e.a], v[e.b], v[e.c], v[e.d]) > 0.01;
    }
    std::uint32_t first_new() const { return static_cast<std::uint32_t>(before_.vertices.size()); }
    std::uint32_t inner_new() const {
        for (std::uint32_t v = first_new(); v < after_.vertices.size(); ++v)
            if (after_.vertices[v].x < 104.9) return v;
        return kNone;
    }

    MeshData before_, after_;
    std::vector<core::Shape> shapes_;
    core::IntegrateOptions options_;
    double certified_ = 0.0;
};

#define EXPECT_FAULT(mesh, begin) EXPECT_EQ(found(mesh).substr(0, std::string(begin).size()), begin)

TEST_F(Planted, AnEdgeSwappedAcrossFacets) {
    const Edge edge =
        edge_where([&](const Edge& e) { return may_swap(e) && !is_constrained(e) && bends(e); });
    EXPECT_FAULT(swapped(edge), "G2 edge at");
}

TEST_F(Planted, ASwapInsideAFacetIsNoFault) {
    const auto is_flat = [&](const Edge& e) {
        const auto& v = after_.vertices;
        return may_swap(e) && !is_constrained(e) &&
               gap_at_crossing(v[e.a], v[e.b], v[e.c], v[e.d]) < 1e-14;
    };
    EXPECT_EQ(found(swapped(edge_where(is_flat))), "nothing");
}

TEST_F(Planted, AConstrainedEdgeSwapped) {
    const Edge edge = edge_where([&](const Edge& e) { return may_swap(e) && is_constrained(e); });
    MeshData mesh = swapped(edge);
    EXPECT_FAULT(mesh, "G1 constraint");
    // Its mark gone as well, it is no longer there to cover the segment.
    std::erase_if(mesh.constraints,
                  [&](auto c) { return std::minmax(c[0], c[1]) == std::minmax(edge.a, edge.b); });
    const Faults faults = check(mesh);
    EXPECT_TRUE(std::any_of(faults.begin(), faults.end(), [](const std::string& fault) {
        return fault.starts_with("G3 segment");
    }));
}

TEST_F(Planted, AnOldVertexMoved) {
    MeshData mesh = after_;
    mesh.vertices[14].x += 1e-9;
    EXPECT_FAULT(mesh, "G4 old vertex 14 moved");
}

TEST_F(Planted, ANewVertexMovedOffItsSegmentAndItsFacetEdge) {
    MeshData mesh = after_;
    mesh.vertices[inner_new()].y += 1e-9;
    EXPECT_NE(found(mesh), "nothing");
    mesh = after_;
    mesh.vertices[inner_new()].x += 1e-2;
    EXPECT_NE(found(mesh), "nothing");
}

TEST_F(Planted, AnElevationShifted) {
    MeshData mesh = after_;
    mesh.vertices[inner_new()].z += 1e-10;
    EXPECT_FAULT(mesh, "CERTIFIED new vertex");
    mesh.vertices[inner_new()].z += 1e-7;
    EXPECT_FAULT(mesh, "G2 new vertex");
    mesh = after_;
    mesh.vertices[7].z = std::nextafter(mesh.vertices[7].z, 10.0);
    EXPECT_FAULT(mesh, "G2 the elevation of old vertex 7 changed");
}

TEST_F(Planted, ABoundBelowTheTruth) {
    const core::IntegrateOptions options;
    EXPECT_NE(Verifier(before_).step(after_, shapes_, options, 0.0), Faults{});
}

TEST_F(Planted, ATriangleDropped) {
    MeshData mesh = after_;
    mesh.triangles.pop_back();
    EXPECT_NE(found(mesh), "nothing");
    mesh = after_;
    mesh.triangles[3] = mesh.triangles.back();
    mesh.triangles.pop_back();
    EXPECT_NE(found(mesh), "nothing");
}

TEST_F(Planted, ATriangleTwice) {
    MeshData mesh = after_;
    mesh.triangles.push_back(mesh.triangles[0]);
    EXPECT_FAULT(mesh, "G1 two triangles have the edge");
}

TEST_F(Planted, ATriangleTurnedOver) {
    MeshData mesh = after_;
    std::swap(mesh.triangles[0][1], mesh.triangles[0][2]);
    EXPECT_FAULT(mesh, "G1 triangle 0 is not counter-clockwise");
}

TEST_F(Planted, ATriangleOverOthers) {
    MeshData mesh = after_;
    const auto v = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(),
                         {{101.1, 201.1, 0}, {101.2, 201.1, 0}, {101.1, 201.2, 0}});
    mesh.triangles.push_back({v, v + 1, v + 2});
    EXPECT_FAULT(mesh, "G2 the plan has an outline that it had not");
}

TEST_F(Planted, TwoFansAtOneVertex) {
    // A triangle beyond the corner that hangs on it alone.
    MeshData mesh = after_;
    const auto v = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {{99.0, 199.5, 0}, {99.5, 199.0, 0}});
    mesh.triangles.push_back({0, v, v + 1});
    EXPECT_FAULT(mesh, "G1 the triangles around vertex 0 are not one fan");
}

TEST_F(Planted, AVertexThatNothingUses) {
    MeshData mesh = after_;
    mesh.vertices.push_back({102, 202, 0});
    EXPECT_FAULT(mesh, "G1 no triangle uses vertex");
}

TEST_F(Planted, AMarkLost) {
    for (std::size_t i = 0; i < after_.constraints.size(); ++i) {
        MeshData mesh = after_;
        mesh.constraints.erase(mesh.constraints.begin() + static_cast<std::ptrdiff_t>(i));
        EXPECT_FAULT(mesh, "G3 segment") << i;
    }
}

TEST_F(Planted, AMarkThatNobodyAskedFor) {
    MeshData mesh = after_;
    const Edge edge = edge_where([&](const Edge& e) { return !is_constrained(e); });
    mesh.constraints.push_back({edge.a, edge.b});
    EXPECT_FAULT(mesh, "G3 the edge");
}

TEST_F(Planted, AnOldConstraintLost) {
    const MeshData first = after_;
    MeshData second = first;
    second.constraints.pop_back();
    const std::vector<core::Shape> none;
    EXPECT_EQ(Verifier(first).step(first, none, options_, certified_), Faults{});
    EXPECT_NE(Verifier(first).step(second, none, options_, certified_), Faults{});
}

TEST_F(Planted, ANeedlessVertex) {
    // In the middle of a triangle, on its plane: nothing but the count is wrong.
    MeshData mesh = after_;
    const auto v = static_cast<std::uint32_t>(mesh.vertices.size());
    const auto [a, b, c] = mesh.triangles.front();
    const Point3 p = mesh.vertices[a], q = mesh.vertices[b], r = mesh.vertices[c];
    mesh.vertices.push_back(
        {p.x / 2 + q.x / 4 + r.x / 4, p.y / 2 + q.y / 4 + r.y / 4, p.z / 2 + q.z / 4 + r.z / 4});
    mesh.triangles.front() = {a, b, v};
    mesh.triangles.push_back({b, c, v});
    mesh.triangles.push_back({c, a, v});
    EXPECT_FAULT(mesh, "G8 at");
}

/// A spike whose way back a snap put beside the way there, and a line across both.
class BentSpike : public testing::Test {
  protected:
    void SetUp() override {
        before_.vertices = {{0, 0, 0}, {6.8773, 5.0404, 0}, {5.828, 5.8763, 0}, {7, 6, 0}};
        before_.triangles = {{0, 1, 2}, {1, 3, 2}};
        const Point2 root{0.5795280133684149, 4.241443790551555};
        spike_ = {{{{{root, {6.5347, 5.3181}, root}, false}}}};
        across_ = {{{{{{9, 0}, {4, 8}}, false}}}};
        snapped_.snap = 0.0041540122988920165;
        auto tin = core::build_tin(before_);
        ASSERT_TRUE(tin.ok());
        ASSERT_TRUE(core::integrate(*tin, spike_, snapped_).ok());
        between_ = tin->to_data();
        ASSERT_TRUE(core::integrate(*tin, across_, {}).ok());
        after_ = tin->to_data();
    }
    Faults check(const MeshData& after) const {
        Verifier verifier(before_);
        EXPECT_EQ(verifier.step(between_, spike_, snapped_, 0.0), Faults{});
        return verifier.step(after, across_, {}, 0.0);
    }

    MeshData before_, between_, after_;
    std::vector<core::Shape> spike_, across_;
    core::IntegrateOptions snapped_;
};

TEST_F(BentSpike, IsCrossedTwiceForTwoReasons) {
    EXPECT_EQ(check(after_), Faults{});
}

TEST_F(BentSpike, IsNoReasonForAThirdVertex) {
    // On the line across, between the two places where it crosses the spike's chain.
    std::vector<std::uint32_t> crossings;
    for (std::uint32_t v = 0; v < after_.vertices.size(); ++v)
        if (std::fabs(after_.vertices[v].x - 5.7637) < 0.001) crossings.push_back(v);
    ASSERT_EQ(crossings.size(), 2U);
    const std::uint32_t a = crossings[0], b = crossings[1];
    const Point3 p = after_.vertices[a], q = after_.vertices[b];
    MeshData mesh = after_;
    const auto m = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back({(p.x + q.x) / 2, (p.y + q.y) / 2, (p.z + q.z) / 2});
    for (std::size_t t = 0; t < after_.triangles.size(); ++t) {
        for (unsigned i = 0; i < 3; ++i) {
            const std::array<std::uint32_t, 3> corners = after_.triangles[t];
            const std::uint32_t u = corners[i], v = corners[(i + 1) % 3], w = corners[(i + 2) % 3];
            if (std::minmax(u, v) != std::minmax(a, b)) continue;
            mesh.triangles[t] = {u, m, w};
            mesh.triangles.push_back({m, v, w});
        }
    }
    std::erase_if(mesh.constraints, [&](const auto& edge) {
        return std::minmax(edge[0], edge[1]) == std::minmax(a, b);
    });
    mesh.constraints.push_back({a, m});
    mesh.constraints.push_back({b, m});
    const Faults faults = check(mesh);
    ASSERT_FALSE(faults.empty());
    EXPECT_EQ(faults.front().substr(0, 5), "G8 at");
}

TEST(Crease, IsAReasonForAVertexWhereTheSurfaceBends) {
    // Its ends touch the border, and do not cross it.
    const std::vector<core::Shape> shapes{{{{{{0, 1}, {1, 0}}, false}}}};
    for (const double bend : {0.0, 1e-6, 1.0}) {
        MeshData mesh;
        mesh.vertices = {{0, 0, 0}, {1, 0, 1}, {1, 1, 3 + bend}, {0, 1, 2}};
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        std::vector<ActualCrossing> crossings;
        add_actual_crossings(Snapshot(mesh), shapes, 1e-5, crossings);
        ASSERT_EQ(crossings.size(), bend > 1e-5 ? 1U : 0U);
        for (const ActualCrossing& crossing : crossings)
            EXPECT_EQ(crossing.p, (Point2{0.5, 0.5}));
    }
}

TEST(Crease, IsSeenWhereTheDiagonalsDoNotCross) {
    // The edge from the middle to a corner of a triangle.
    const std::vector<core::Shape> shapes{{{{{{0.25, 0.75}, {0.75, 0.25}}, false}}}};
    for (const double bend : {0.0, 1.0}) {
        MeshData mesh;
        mesh.vertices = {{0, 0, 0}, {4, 0, 4}, {0, 4, 8}, {1, 1, 3 + bend}};
        mesh.triangles = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
        std::vector<ActualCrossing> crossings;
        add_actual_crossings(Snapshot(mesh), shapes, 1e-5, crossings);
        EXPECT_EQ(crossings.size(), bend > 1e-5 ? 1U : 0U);
    }
}

TEST_F(Planted, AnOutlineCutShort) {
    // A corner triangle goes; the mesh stays valid and covers less.
    MeshData mesh = after_;
    const auto corner =
        std::find_if(mesh.triangles.begin(), mesh.triangles.end(),
                     [](const auto& t) { return std::find(t.begin(), t.end(), 0U) != t.end(); });
    mesh.triangles.erase(corner);
    EXPECT_NE(found(mesh), "nothing");
}

TEST_F(Planted, AnElevationThatNoPathBrings) {
    // The ring brings the elevations that it has on the surface; then one that it has not.
    const auto elevation_at = [this](Point2 p) {
        for (const Point3& v : after_.vertices)
            if (v.plan() == p) return v.z;
        return -1.0;
    };
    core::Path& ring = shapes_[0].paths[0];
    for (const Point2 p : ring.points)
        ring.elevations.push_back(elevation_at(p));
    shapes_.pop_back();
    auto tin = core::build_tin(before_);
    const auto report = core::integrate(*tin, shapes_, options_);
    ASSERT_TRUE(report.ok());
    certified_ = report->shapes[0].max_vertical_deviation;
    after_ = tin->to_data();
    EXPECT_EQ(check(after_), Faults{});
    MeshData mesh = after_;
    mesh.vertices[inner_new()].z += 1e-6;
    EXPECT_FAULT(mesh, "OWN vertex");
}

TEST_F(Planted, ASegmentThatIsNotThere) {
    shapes_.push_back({{{{{101.0, 200.5}, {101.0, 200.75}}, false}}});
    EXPECT_FAULT(after_, "G3 segment from 101 200.5");
}

}  // namespace
}  // namespace tinsmith::verify
