// SPDX-License-Identifier: Apache-2.0
#include "core/edit/profile.hpp"

#include <set>

#include <gtest/gtest.h>

#include "core/edit/spot.hpp"
#include "core/integrate/distance.hpp"
#include "tests/support/random_input.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith {
namespace {

using core::Point2;
using Kind = core::ProfilePoint::Kind;
using Line = std::vector<Point2>;

core::Profile profile(const core::Tin& tin, const Line& line) {
    const auto found = core::profile_along(tin, line);
    EXPECT_TRUE(found.ok());
    return found ? *found : core::Profile{};
}

std::string kinds(const core::Stretch& stretch) {
    std::string text;
    for (const auto& point : stretch.points)
        text += "IEV"[static_cast<int>(point.kind)];
    return text;
}

TEST(Profile, InsideOneTriangle) {
    const core::Tin tin = test::built(test::one_triangle());
    const auto found = profile(tin, {{10, 10}, {40, 10}, {40, 50}});
    ASSERT_EQ(found.stretches.size(), 1U);
    EXPECT_EQ(kinds(found.stretches[0]), "III");
    EXPECT_EQ(found.length, 70.0);
    EXPECT_EQ(found.stretches[0].points[2].distance, 70.0);
    EXPECT_DOUBLE_EQ(found.stretches[0].points[2].position.z, 10.0 + 25.0);
}

TEST(Profile, CrossesEdgesAndVerticesOnce) {
    const core::Tin tin = test::built(test::grid(4, 4));
    EXPECT_EQ(kinds(profile(tin, {{0.5, 0.25}, {2.5, 0.25}}).stretches[0]), "IEEEEI");
    EXPECT_EQ(kinds(profile(tin, {{0.5, 0.5}, {2.5, 2.5}}).stretches[0]), "IVVI") << "diagonals";
    EXPECT_EQ(kinds(profile(tin, {{0, 1}, {3, 1}}).stretches[0]), "IVVI") << "along edges";
    EXPECT_EQ(kinds(profile(tin, {{0.5, 1.5}, {1.5, 0.5}}).stretches[0]), "IVI");
    EXPECT_EQ(kinds(profile(tin, {{0, 0}, {0, 4}}).stretches[0]), "IVVVI") << "on the border";
    EXPECT_EQ(kinds(profile(tin, {{0.5, 1}, {0.75, 1}, {0.75, 1.25}}).stretches[0]), "III");
}

TEST(Profile, GapsPartTheStretches) {
    const core::Tin tin = test::built(test::ring_of_cells());
    const auto through = profile(tin, {{-1, 1.25}, {4, 1.25}});
    ASSERT_EQ(through.stretches.size(), 2U);
    EXPECT_EQ(kinds(through.stretches[0]), "EEE");
    EXPECT_EQ(kinds(through.stretches[1]), "EEE");
    EXPECT_EQ(through.stretches[0].points.front().distance, 1.0);
    EXPECT_EQ(through.stretches[0].points.back().distance, 2.0);
    EXPECT_EQ(through.stretches[1].points.front().distance, 3.0);
    EXPECT_EQ(through.stretches[1].points.back().distance, 4.0);
    EXPECT_EQ(through.length, 5.0);

    EXPECT_EQ(profile(tin, {{1.25, 1.5}, {1.75, 1.5}}).stretches.size(), 0U) << "in the hole";
    EXPECT_EQ(profile(tin, {{-5, 0}, {-4, 9}}).stretches.size(), 0U) << "outside";
    EXPECT_EQ(profile(tin, {{-1, 1}, {1, -1}}).stretches.size(), 0U) << "grazes the corner";
    const auto touch = profile(tin, {{-1, 1}, {0, 0}, {1, -1}});
    ASSERT_EQ(touch.stretches.size(), 1U);
    EXPECT_EQ(kinds(touch.stretches[0]), "I");
    const auto corner = profile(tin, {{1.5, 1.5}, {1, 1}, {0.5, 0.5}});
    ASSERT_EQ(corner.stretches.size(), 1U);
    EXPECT_EQ(kinds(corner.stretches[0]), "II");
    EXPECT_EQ(kinds(profile(tin, {{1, -1}, {1, 4}}).stretches[0]), "VVVV") << "along the hole";
    EXPECT_EQ(kinds(profile(tin, {{1.5, 1.5}, {1.5, 1}, {1.5, 0}}).stretches[0]), "IEI");
}

TEST(Profile, RefusesWhatIsNoLine) {
    const core::Tin tin = test::built(test::grid(4, 4));
    EXPECT_EQ(core::profile_along(tin, Line{{1, 1}, {1, 1}}).errors()[0].code,
              core::ErrorCode::LineTooShort);
    EXPECT_EQ(core::profile_along(tin, Line{}).errors()[0].code, core::ErrorCode::LineTooShort);
    EXPECT_EQ(core::profile_along(tin, Line{{1, 1}, {1, 1e300}}).errors()[0].place.point, 1U);
    EXPECT_EQ(core::profile_along(tin, Line{{0, 0.1}, {4, 0.2}}, {3, {}}).errors()[0].code,
              core::ErrorCode::CrossingBudget);
    EXPECT_EQ(core::profile_along(tin, Line{{0, 0.1}, {4, 0.2}}, {9, [] { return true; }})
                  .errors()[0]
                  .code,
              core::ErrorCode::Cancelled);
}

/// Edges of the mesh that the segment crosses in one inner point of both, by looking at all.
std::size_t crossed_edges(const core::Tin& tin, Point2 p, Point2 q) {
    std::size_t count = 0;
    for (std::uint32_t t = 0; t < tin.triangle_count(); ++t) {
        for (unsigned i = 0; i < 3; ++i) {
            const core::Side side({t}, i);
            if (tin.twin(side).valid() && tin.twin(side) < side) continue;
            count += core::cross_properly(p, q, tin.plan(tin.origin(side)),
                                          tin.plan(tin.destination(side)));
        }
    }
    return count;
}

/// Places along the segment where it goes through a vertex and the mesh is before or behind.
std::size_t met_vertices(const core::Tin& tin, Point2 p, Point2 q) {
    std::set<core::VertexId> met;
    for (std::uint32_t v = 0; v < tin.vertex_count(); ++v) {
        const Point2 at = tin.plan({v});
        if (at == p || at == q || core::orientation(p, q, at) != core::Orientation::Collinear)
            continue;
        if (!core::is_ahead(p, q, at) || !core::is_ahead(q, p, at)) continue;
        const core::Side side = core::side_from(tin, {v});
        const bool ahead = core::leave(tin, {v}, q, side).kind != core::Departure::Kind::Outside;
        const bool behind = core::leave(tin, {v}, p, side).kind != core::Departure::Kind::Outside;
        if (ahead || behind) met.insert({v});
    }
    return met.size();
}

void compare_with_all_edges(const core::Tin& tin, const Line& line, double slack) {
    const auto found = profile(tin, line);
    std::size_t edges = 0, vertices = 0;
    double length = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        if (line[i] == line[i - 1]) continue;
        edges += crossed_edges(tin, line[i - 1], line[i]);
        vertices += met_vertices(tin, line[i - 1], line[i]);
        length += core::distance_between(line[i - 1], line[i]);
    }
    EXPECT_EQ(found.length, length);
    std::size_t edges_found = 0, vertices_found = 0;
    double before = 0.0;
    for (const core::Stretch& stretch : found.stretches) {
        ASSERT_FALSE(stretch.points.empty());
        for (const core::ProfilePoint& point : stretch.points) {
            edges_found += point.kind == Kind::Edge;
            vertices_found += point.kind == Kind::Vertex;
            EXPECT_GE(point.distance, before);
            EXPECT_LT(point.triangle.index(), tin.triangle_count());
            before = point.distance;
        }
        for (std::size_t i = 1; i < stretch.points.size(); ++i) {
            const core::Point3& a = stretch.points[i - 1].position;
            const core::Point3& b = stretch.points[i].position;
            if (slack > 0.0) {
                const auto spot =
                    core::spot_at(tin, {a.x + (b.x - a.x) / 2, a.y + (b.y - a.y) / 2});
                if (spot) {
                    EXPECT_NEAR(spot->elevation, (a.z + b.z) / 2, slack);
                }
            }
        }
    }
    EXPECT_EQ(edges_found, edges);
    EXPECT_EQ(vertices_found, vertices);
    EXPECT_EQ(found.crossings, edges + vertices);
}

TEST(Profile, MeetsWhatLookingAtAllEdgesMeets) {
    for (int kind = 0; kind < test::kMeshKinds; ++kind) {
        for (std::uint64_t seed = 1; seed <= 300; ++seed) {
            test::Random random(seed * 100 + static_cast<std::uint64_t>(kind));
            const auto which = static_cast<test::MeshKind>(kind);
            const core::MeshData mesh = test::random_mesh(random, which, 6);
            if (mesh.triangles.empty()) continue;
            const auto tin = core::build_tin(mesh);
            if (!tin) continue;
            const auto shape = test::random_shape(
                random, static_cast<test::ShapeKind>(test::pick(random, test::kShapeKinds)), mesh);
            for (const core::Path& path : shape.paths) {
                Line line = path.points;
                if (path.closed) line.push_back(line.front());
                if (std::set<std::pair<double, double>> places; true) {
                    for (const Point2& p : line)
                        places.insert({p.x, p.y});
                    if (places.size() < 2) continue;
                }
                SCOPED_TRACE(std::string(test::name_of(which)) + " " + std::to_string(seed));
                const bool gentle = which == test::MeshKind::Grid ||
                                    which == test::MeshKind::Concave ||
                                    which == test::MeshKind::Holes;
                compare_with_all_edges(*tin, line, gentle ? 1e-9 : 0.0);
                if (testing::Test::HasFailure()) return;
            }
        }
    }
}

TEST(Profile, LeavesTheMeshAlone) {
    const core::Tin tin = test::built(test::grid(4, 4));
    const core::Tin before = tin;
    profile(tin, {{-1, 0.3}, {5, 3.7}, {2, 2}});
    EXPECT_TRUE(test::same_slots(tin, before));
}

TEST(Spot, IsExactAtVerticesAndAbsentOutside) {
    const core::Tin tin = test::built(test::ring_of_cells());
    for (std::uint32_t v = 0; v < tin.vertex_count(); ++v)
        EXPECT_EQ(core::spot_at(tin, tin.plan({v}))->elevation, tin.vertex({v}).z);
    EXPECT_FALSE(core::spot_at(tin, {1.5, 1.5}));
    EXPECT_FALSE(core::spot_at(tin, {-1, 0}));
    EXPECT_TRUE(core::spot_at(tin, {0.5, 0.25}));
}

}  // namespace
}  // namespace tinsmith
