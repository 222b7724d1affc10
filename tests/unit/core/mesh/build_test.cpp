// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/build.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "core/mesh/check.hpp"
#include "core/mesh/walk.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith::core {
namespace {

using test::grid;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::vector<ErrorCode> codes(const Result<Tin>& result) {
    std::vector<ErrorCode> found;
    if (!result)
        for (const Error& error : result.errors())
            found.push_back(error.code);
    return found;
}

/// Vertex 0 in the middle of spokes at the angles given, in degrees; a triangle between each two
/// that follow each other, and from the last to the first when closed.
MeshData fan(const std::vector<double>& degrees, bool closed) {
    MeshData mesh;
    mesh.vertices.push_back({0, 0, 0});
    for (const double angle : degrees) {
        const double turn = angle * 3.14159265358979 / 180.0;
        mesh.vertices.push_back({std::cos(turn), std::sin(turn), 0});
    }
    const auto count = static_cast<std::uint32_t>(degrees.size());
    for (std::uint32_t i = 1; i < count; ++i)
        mesh.triangles.push_back({0, i, i + 1});
    if (closed) mesh.triangles.push_back({0, count, 1});
    return mesh;
}

TEST(Build, KeepsVerticesTrianglesAndTheirOrder) {
    const MeshData data = grid(4, 3, test::Diagonals::Alternate);
    const Tin tin = test::built(data);
    EXPECT_TRUE(test::same_bytes(tin.to_data(), data));
    EXPECT_TRUE(check_tin(tin).empty());
    EXPECT_EQ(tin.bounds().min.plan(), (Point2{0, 0}));
    EXPECT_EQ(tin.bounds().max.plan(), (Point2{4, 3}));
}

TEST(Build, GivesEachTriangleAFacetOfItsOwn) {
    const Tin tin = test::built(grid(3, 3));
    for (std::uint32_t t = 0; t < tin.triangle_count(); ++t)
        for (unsigned i = 0; i < 3; ++i)
            EXPECT_TRUE(tin.separates_facets({{t}, i}));
}

TEST(Build, TakesHolesAndComponents) {
    MeshData data = test::ring_of_cells();
    EXPECT_TRUE(check_tin(test::built(data)).empty());
    const auto base = static_cast<std::uint32_t>(data.vertices.size());
    for (const Point3 p : {Point3{20, 0, 1}, Point3{21, 0, 2}, Point3{20, 1, 3}})
        data.vertices.push_back(p);
    data.triangles.push_back({base, base + 1, base + 2});
    EXPECT_TRUE(check_tin(test::built(data)).empty());
}

TEST(Build, RefusesAMeshWithoutTriangles) {
    EXPECT_EQ(codes(build_tin({})), std::vector{ErrorCode::MeshEmpty});
    EXPECT_EQ(codes(build_tin({{{0, 0, 0}}, {}, {}})), std::vector{ErrorCode::MeshEmpty});
}

TEST(Build, NamesEveryVertexThatIsNotFiniteOrOutOfRange) {
    MeshData data = grid(2, 2);
    data.vertices[1].x = kNaN;
    data.vertices[4].z = HUGE_VAL;
    data.vertices[7].y = 1e16;
    data.vertices[8].x = 1e-70;
    const auto result = build_tin(data);
    ASSERT_EQ(codes(result),
              (std::vector{ErrorCode::CoordinateNotFinite, ErrorCode::CoordinateNotFinite,
                           ErrorCode::CoordinateOutOfRange, ErrorCode::CoordinateOutOfRange}));
    EXPECT_EQ(result.errors()[0].place.vertex, 1u);
    EXPECT_EQ(result.errors()[1].place.vertex, 4u);
    EXPECT_EQ(result.errors()[2].place.vertex, 7u);
    EXPECT_EQ(result.errors()[3].place.vertex, 8u);
}

TEST(Build, DoesNotBlameTrianglesForACoordinateThatCannotBe) {
    MeshData data = grid(2, 2);
    data.vertices[0].x = 1e300;
    data.vertices[4].x = kNaN;
    for (const ErrorCode code : codes(build_tin(data)))
        EXPECT_TRUE(code == ErrorCode::CoordinateNotFinite ||
                    code == ErrorCode::CoordinateOutOfRange)
            << code_name(code);
}

TEST(Build, NamesEveryFaultyTriangleAtOnce) {
    MeshData data = grid(3, 2);
    std::swap(data.triangles[1][0], data.triangles[1][1]);
    data.triangles[4] = {0, 1, 2};    // on one line
    data.triangles[6] = {0, 1, 999};  // not there
    data.triangles[9] = {5, 5, 6};    // twice the same
    const auto result = build_tin(data);
    ASSERT_EQ(codes(result),
              (std::vector{ErrorCode::TriangleClockwise, ErrorCode::TriangleFlat,
                           ErrorCode::VertexIndexOutOfRange, ErrorCode::TriangleFlat}));
    const std::size_t expected[] = {1, 4, 6, 9};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(result.errors()[i].place.triangle, expected[i]);
        EXPECT_NE(result.errors()[i].detail.find(std::to_string(expected[i])), std::string::npos);
    }
}

TEST(Build, NamesNoMoreFaultsThanTheLimit) {
    MeshData data = grid(20, 20);
    for (auto& t : data.triangles)
        std::swap(t[0], t[1]);
    EXPECT_EQ(codes(build_tin(data)).size(), kMaxFaults);
}

TEST(Build, RefusesAnEdgeOfThreeTriangles) {
    MeshData data = grid(1, 1);
    data.vertices.push_back({2, 0.5, 9});
    data.triangles.push_back({0, 1, 4});  // the side 0 -> 1 again; 0, 1, (2, 0.5) turns left
    const auto result = build_tin(data);
    ASSERT_EQ(codes(result), std::vector{ErrorCode::EdgeNotManifold});
    EXPECT_EQ(result.errors()[0].place.triangle, 2u);
}

TEST(Build, RefusesTheSameTriangleTwice) {
    MeshData data = test::one_triangle();
    data.triangles.push_back(data.triangles[0]);
    for (const ErrorCode code : codes(build_tin(data)))
        EXPECT_EQ(code, ErrorCode::EdgeNotManifold);
    EXPECT_EQ(codes(build_tin(data)).size(), 3u);
}

TEST(Build, NamesEveryUnusedVertex) {
    MeshData data = grid(2, 2);
    data.vertices.push_back({5, 5, 5});
    data.vertices.push_back({6, 5, 5});
    const auto result = build_tin(data);
    ASSERT_EQ(codes(result), (std::vector{ErrorCode::VertexUnused, ErrorCode::VertexUnused}));
    EXPECT_EQ(result.errors()[0].place.vertex, 9u);
    EXPECT_EQ(result.errors()[1].place.vertex, 10u);
}

TEST(Build, TakesFansOfUpToAFullTurn) {
    EXPECT_TRUE(build_tin(fan({0, 70, 140, 210, 280}, true)));
    EXPECT_TRUE(build_tin(fan({15, 120, 240}, true)));
    EXPECT_TRUE(build_tin(fan({200, 300, 350, 460, 550}, false)));
    // A slit: the first and the last spoke are different vertices of one position.
    MeshData slit = fan({0, 90, 180, 270, 360}, false);
    slit.vertices[5] = slit.vertices[1];
    EXPECT_TRUE(build_tin(slit));
}

TEST(Build, RefusesAFanThatTurnsTwice) {
    std::vector<double> spokes;
    for (int i = 0; i < 7; ++i)
        spokes.push_back(i * 720.0 / 7.0);
    const auto result = build_tin(fan(spokes, true));
    ASSERT_EQ(codes(result), std::vector{ErrorCode::VertexFolded});
    EXPECT_EQ(result.errors()[0].place.vertex, 0u);
}

TEST(Build, RefusesAnOpenFanThatOverlapsItself) {
    for (const double first : {0.0, 10.0, 100.0, 350.0}) {
        std::vector<double> spokes;
        for (int i = 0; i < 8; ++i)
            spokes.push_back(first + i * 70.0);
        EXPECT_EQ(codes(build_tin(fan(spokes, false))), std::vector{ErrorCode::VertexFolded})
            << "490 degrees from " << first;
    }
}

TEST(Build, RefusesFansThatOverlapAtAVertexTheyShare) {
    MeshData data = fan({0, 60}, false);
    for (const double angle : {30.0, 90.0}) {
        const double turn = angle * 3.14159265358979 / 180.0;
        data.vertices.push_back({std::cos(turn), std::sin(turn), 1});
    }
    data.triangles.push_back({0, 3, 4});
    EXPECT_EQ(codes(build_tin(data)), std::vector{ErrorCode::VertexFolded});
}

MeshData two_triangles_that_touch() {
    return {
        {{0, 0, 0}, {2, 1, 1}, {1, 2, 2}, {-2, -1, 3}, {-1, -2, 4}}, {{0, 1, 2}, {0, 3, 4}}, {}};
}

TEST(Build, SplitsAVertexWhereTwoFansTouch) {
    const MeshData data = two_triangles_that_touch();
    const Tin tin = test::built(data);
    EXPECT_TRUE(check_tin(tin).empty());
    ASSERT_EQ(tin.vertex_count(), 6u);
    EXPECT_EQ(tin.vertex({5}).point(), data.vertices[0]);
    EXPECT_EQ(tin.triangle({0}).vertices[0], VertexId{0});
    EXPECT_EQ(tin.triangle({1}).vertices[0], VertexId{5});
}

TEST(Build, MarksConstraintsOnBothSides) {
    MeshData data = grid(2, 2);
    data.constraints = {{0, 4}, {5, 4}, {0, 1}};
    const Tin tin = test::built(data);
    EXPECT_TRUE(check_tin(tin).empty());
    EXPECT_EQ(tin.to_data().constraints.size(), 3u);
    for (const auto& [from, to] : data.constraints) {
        const Side side = find_edge(tin, {from}, {to});
        EXPECT_TRUE(tin.is_constrained(side));
        if (tin.twin(side).valid()) {
            EXPECT_TRUE(tin.is_constrained(tin.twin(side)));
        }
    }
    EXPECT_FALSE(tin.is_constrained(find_edge(tin, {3}, {4})));
}

TEST(Build, MarksConstraintsOfEveryFanThatTouches) {
    MeshData data = two_triangles_that_touch();
    data.constraints = {{0, 1}, {3, 0}, {0, 4}, {3, 4}};
    const auto result = build_tin(data);
    ASSERT_TRUE(result) << result.errors()[0].detail;
    EXPECT_EQ(result->to_data().constraints.size(), 4u);
}

TEST(Build, RefusesConstraintsThatAreNoEdges) {
    MeshData data = grid(2, 2);
    data.constraints = {{0, 1}, {1, 3}, {0, 99}, {4, 4}};
    const auto result = build_tin(data);
    ASSERT_EQ(codes(result).size(), 3u);
    EXPECT_NE(result.errors()[0].detail.find("constraint 1"), std::string::npos);
    EXPECT_NE(result.errors()[1].detail.find("constraint 2"), std::string::npos);
}

/// The triangles in another order, each beginning with another corner.
MeshData shuffled(MeshData mesh) {
    std::uint32_t lot = 1;
    for (std::size_t i = mesh.triangles.size(); i > 1; --i) {
        lot = lot * 1664525U + 1013904223U;
        std::swap(mesh.triangles[i - 1], mesh.triangles[(lot >> 8) % i]);
        auto& corners = mesh.triangles[i - 1];
        std::rotate(corners.begin(), corners.begin() + (lot >> 4) % 3, corners.end());
    }
    return mesh;
}

TEST(Build, LinksAlikeWhetherItMustSortOrNot) {
    std::vector<double> spokes;
    for (int i = 0; i < 300; ++i)
        spokes.push_back(1.2 * i);
    MeshData holes = grid(9, 9);
    std::erase_if(holes.triangles, [](const auto& t) { return t[0] == 40 || t[0] == 42; });
    for (const MeshData& mesh :
         {shuffled(grid(20, 13, test::Diagonals::Alternate)), grid(2, 2), shuffled(holes),
          fan(spokes, true), shuffled(fan(spokes, true)), shuffled(fan(spokes, false))}) {
        const Tin plain = test::built(mesh);
        MeshData marked = mesh;
        marked.constraints.push_back({mesh.triangles[0][0], mesh.triangles[0][1]});
        const Tin sorted = test::built(marked);
        EXPECT_TRUE(check_tin(plain).empty());
        ASSERT_EQ(plain.triangle_count(), sorted.triangle_count());
        for (std::uint32_t t = 0; t < plain.triangle_count(); ++t) {
            EXPECT_EQ(plain.triangle({t}).twins, sorted.triangle({t}).twins);
            EXPECT_EQ(plain.triangle({t}).vertices, sorted.triangle({t}).vertices);
        }
        for (std::uint32_t v = 0; v < plain.vertex_count(); ++v)
            EXPECT_EQ(plain.vertex({v}).triangle, sorted.vertex({v}).triangle);
        EXPECT_EQ(plain.components(), sorted.components());
    }
}

TEST(Build, GivesTheSameMeshFromItsOwnData) {
    Tin tin = test::built(test::ring_of_cells());
    ASSERT_TRUE(integrate(tin, std::vector{test::line({{-1, 0.3}, {4, 2.6}})}, {}));
    const MeshData data = tin.to_data();
    const auto again = build_tin(data);
    ASSERT_TRUE(again) << again.errors()[0].detail;
    EXPECT_TRUE(test::same_bytes(again->to_data(), data));
}

}  // namespace
}  // namespace tinsmith::core
