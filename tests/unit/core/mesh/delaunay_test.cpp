// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/delaunay.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/mesh/build.hpp"
#include "core/mesh/check.hpp"
#include "tests/support/delaunay.hpp"
#include "tests/support/point_clouds.hpp"
#include "tests/verify/exact.hpp"

namespace tinsmith::core {
namespace {

using Points = std::vector<Point3>;

std::set<std::array<std::uint32_t, 3>> turned(
    const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    std::set<std::array<std::uint32_t, 3>> set;
    for (auto t : triangles) {
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        set.insert(t);
    }
    return set;
}

const DelaunayOptions kByHalves{{}, one_after_another, 2};

/// Everything that the header says of a mesh: built, whole, convex, and no vertex of a neighbour in
/// any circle, by the verifier's rational numbers.
void expect_delaunay(const MeshData& mesh) {
    const auto tin = build_tin(mesh);
    ASSERT_TRUE(tin.ok()) << tin.errors()[0].detail;
    ASSERT_EQ(tin->vertex_count(), mesh.vertices.size()) << "two fans met in a vertex";
    const auto violations = check_tin(*tin);
    ASSERT_TRUE(violations.empty()) << violations[0].law << " " << violations[0].detail;
    const auto plan = [&](std::uint32_t v) { return mesh.vertices[v].plan(); };
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> apexes;
    for (const auto& t : mesh.triangles)
        for (unsigned i = 0; i < 3; ++i)
            apexes[{t[i], t[(i + 1) % 3]}] = t[(i + 2) % 3];
    std::map<std::uint32_t, std::uint32_t> hull;
    for (const auto& [side, apex] : apexes) {
        const auto twin = apexes.find({side[1], side[0]});
        if (twin == apexes.end()) {
            ASSERT_TRUE(hull.emplace(side[0], side[1]).second) << "the hull touches itself";
        } else {
            ASSERT_LE(verify::circle_side_of(plan(side[0]), plan(side[1]), plan(apex),
                                             plan(twin->second)),
                      0);
        }
    }
    std::size_t length = 0;
    for (std::uint32_t v = hull.begin()->first; length == 0 || v != hull.begin()->first; ++length) {
        const std::uint32_t next = hull.at(v);
        ASSERT_GE(verify::side_of(plan(v), plan(next), plan(hull.at(next))), 0);
        v = next;
    }
    EXPECT_EQ(length, hull.size()) << "more than one border";
    EXPECT_EQ(mesh.triangles.size(), 2 * mesh.vertices.size() - 2 - hull.size());
}

TEST(Delaunay, HoldsItsLawsOnCloudsOfEverySort) {
    for (const test::PointCloud& cloud : test::point_clouds()) {
        for (const std::size_t size : {10U, 100U, 3000U}) {
            SCOPED_TRACE(cloud.name + " of " + std::to_string(size));
            const Points points = cloud.make(size, size);
            const auto mesh = delaunay(points), joined = delaunay(points, kByHalves);
            ASSERT_TRUE(mesh.ok()) << mesh.errors()[0].detail;
            ASSERT_NO_FATAL_FAILURE(expect_delaunay(*mesh));
            ASSERT_TRUE(joined.ok()) << joined.errors()[0].detail;
            ASSERT_NO_FATAL_FAILURE(expect_delaunay(*joined));
            if (cloud.has_ties) continue;
            EXPECT_EQ(turned(mesh->triangles), turned(joined->triangles));
        }
    }
}

TEST(Delaunay, IsThatOfSmallSetsHoweverTheyLie) {
    // All kinds of ties: few points on a small lattice, against the slow triangulator of the tests.
    for (std::uint64_t seed = 0; seed < 6'000; ++seed) {
        SCOPED_TRACE(seed);
        std::uint64_t state = seed;
        const auto dice = [&state](std::uint64_t count) {
            state = state * 6364136223846793005ULL + 1442695040888963407ULL;
            return (state >> 33) % count;
        };
        const std::uint64_t width = 2 + dice(5), height = 1 + dice(5), number = 3 + dice(10);
        std::set<test::LatticePoint> set;
        for (std::uint64_t i = 0; i < number; ++i)
            set.insert({std::int64_t(dice(width)), std::int64_t(dice(height))});
        std::vector<test::LatticePoint> lattice(set.begin(), set.end());
        for (std::size_t i = lattice.size(); i > 1; --i)
            std::swap(lattice[i - 1], lattice[dice(i)]);
        Points points;
        for (const auto& p : lattice)
            points.push_back({double(p.x), double(p.y), 0.0});
        const auto expected = test::delaunay(lattice);
        const auto mesh = delaunay(points, seed % 2 == 0 ? DelaunayOptions{} : kByHalves);
        if (expected.empty()) {
            ASSERT_FALSE(mesh.ok());
            ASSERT_EQ(mesh.errors()[0].code,
                      points.size() < 3 ? ErrorCode::TooFewPoints : ErrorCode::PointsCollinear);
            continue;
        }
        ASSERT_TRUE(mesh.ok());
        ASSERT_EQ(mesh->triangles.size(), expected.size());
        ASSERT_NO_FATAL_FAILURE(expect_delaunay(*mesh));
    }
}

TEST(Delaunay, HasTheTrianglesOfTheOldTriangulatorWhereNothingTies) {
    std::uint64_t state = 1;
    std::set<test::LatticePoint> set;
    while (set.size() < 300) {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        set.insert({std::int64_t(state >> 44), std::int64_t(state >> 24 & 0xfffff)});
    }
    const std::vector<test::LatticePoint> lattice(set.begin(), set.end());
    Points points;
    for (const auto& p : lattice)
        points.push_back({double(p.x), double(p.y), 0.0});
    const auto mesh = delaunay(points);
    ASSERT_TRUE(mesh.ok());
    EXPECT_EQ(turned(mesh->triangles), turned(test::delaunay(lattice)));
}

TEST(Delaunay, KeepsTheOrderOfPointsAndLeavesOutRepeatedOnes) {
    const Points points{{0, 0, 1}, {10, 0, 2}, {0, 0, 1}, {10, 10, 3}, {10, 0, 2}, {0, 10, 4}};
    const auto mesh = delaunay(points);
    ASSERT_TRUE(mesh.ok());
    EXPECT_EQ(mesh->vertices, (Points{{0, 0, 1}, {10, 0, 2}, {10, 10, 3}, {0, 10, 4}}));
    EXPECT_EQ(mesh->triangles.size(), 2U);
    expect_delaunay(*mesh);
}

TEST(Delaunay, GivesTheSameBytesEachTime) {
    // A fixed sum besides: what another compiler gives has to be the same.
    std::uint64_t sum = 14695981039346656037ULL;
    for (const char* name : {"scattered", "centimetres far away", "grid far away", "lines"}) {
        const Points points = test::point_cloud(name).make(5'000, 11);
        const auto one = delaunay(points), other = delaunay(points);
        ASSERT_TRUE(one.ok() && other.ok());
        EXPECT_EQ(one->triangles, other->triangles);
        for (const auto& t : one->triangles)
            for (const std::uint32_t v : t)
                sum = (sum ^ v) * 1099511628211ULL;
    }
    EXPECT_EQ(sum, 8425804008198142698U);
}

TEST(Delaunay, IsTheSameHoweverItsHalvesAreShared) {
    DelaunayOptions shared = kByHalves;
    int calls = 0;
    shared.executor = [&calls](std::span<const Job> jobs) {
        ++calls;
        std::vector<std::thread> threads;
        for (const Job& job : jobs)
            threads.emplace_back(job);
        for (std::thread& thread : threads)
            thread.join();
    };
    for (const char* name : {"scattered", "grid", "clustered"}) {
        const Points points = test::point_cloud(name).make(40'000, 3);
        const auto alone = delaunay(points, kByHalves), beside = delaunay(points, shared);
        ASSERT_TRUE(alone.ok() && beside.ok());
        EXPECT_EQ(alone->triangles, beside->triangles) << name;
    }
    EXPECT_GT(calls, 10);
}

TEST(Delaunay, JoinsHalvesThatHardlyFitEachOther) {
    // Rows beside the line that parts them, bent to it and from it: the one half's triangles are
    // nearly all other ones beside the other half.
    for (const double bend : {-1e-3, 0.0, 1e-3}) {
        for (const bool is_upright : {true, false}) {
            Points points;
            for (int i = 0; i < 400; ++i) {
                const double y = (i - 200) * 0.01, x = 1.0 + bend * y * y + (i % 3 == 0 ? 1e-6 : 0);
                for (const double side : {-x - 2.0, x + 2.0})
                    points.push_back(is_upright ? Point3{side, y, 0} : Point3{y, side, 0});
            }
            points.push_back(is_upright ? Point3{-9, 0, 0} : Point3{0, -9, 0});
            points.push_back(is_upright ? Point3{9, 0, 0} : Point3{0, 9, 0});
            const auto mesh = delaunay(points, kByHalves);
            ASSERT_TRUE(mesh.ok());
            ASSERT_NO_FATAL_FAILURE(expect_delaunay(*mesh)) << bend;
        }
    }
}

TEST(Delaunay, NamesPositionsWithTwoElevations) {
    const Points points{{0, 0, 1}, {10, 0, 2}, {0, 10, 3}, {10, 0, 2.5}, {-0.0, 0, 7}, {10, 0, 2}};
    const auto mesh = delaunay(points);
    ASSERT_FALSE(mesh.ok());
    ASSERT_EQ(mesh.errors().size(), 2U);
    EXPECT_EQ(mesh.errors()[0].code, ErrorCode::ElevationTwice);
    EXPECT_EQ(mesh.errors()[0].place.vertex, 3U);
    EXPECT_EQ(mesh.errors()[0].place.position, (Point2{10, 0}));
    EXPECT_EQ(mesh.errors()[0].detail,
              "point 3 is at the position of point 1 with another elevation; keep one of them");
    EXPECT_EQ(mesh.errors()[1].place.vertex, 4U);
    EXPECT_EQ(mesh.errors()[1].place.earlier, 0U);
}

TEST(Delaunay, NamesEveryCoordinateThatIsNone) {
    const double none = std::numeric_limits<double>::quiet_NaN(), endless = HUGE_VAL;
    const Points points{{0, 0, 1}, {none, 0, 2}, {0, endless, 3}, {1, 1, 1e16}, {1e-70, 0, 0}};
    const auto mesh = delaunay(points);
    ASSERT_FALSE(mesh.ok());
    ASSERT_EQ(mesh.errors().size(), 4U);
    EXPECT_EQ(mesh.errors()[0].code, ErrorCode::CoordinateNotFinite);
    EXPECT_EQ(mesh.errors()[1].code, ErrorCode::CoordinateNotFinite);
    EXPECT_EQ(mesh.errors()[2].code, ErrorCode::CoordinateOutOfRange);
    EXPECT_EQ(mesh.errors()[3].place.vertex, 4U);
}

TEST(Delaunay, NamesNoMoreFaultsThanAllowed) {
    Points points;
    for (int i = 0; i < 1'000; ++i)
        points.push_back({double(i % 7), double(i % 5), double(i)});
    const auto mesh = delaunay(points);
    ASSERT_FALSE(mesh.ok());
    ASSERT_EQ(mesh.errors().size(), kMaxFaults);
    EXPECT_EQ(mesh.errors()[0].place.vertex, 35U);
    EXPECT_EQ(mesh.errors()[99].place.vertex, 134U);
    for (Point3& p : points)
        p.x = HUGE_VAL;
    EXPECT_EQ(delaunay(points).errors().size(), kMaxFaults);
}

TEST(Delaunay, RefusesWhatSpansNoTriangle) {
    EXPECT_EQ(delaunay({}).errors()[0].code, ErrorCode::TooFewPoints);
    const DelaunayOptions always_by_halves{{}, one_after_another, 0};
    EXPECT_EQ(delaunay({}, always_by_halves).errors()[0].code, ErrorCode::TooFewPoints);
    const Points two{{0, 0, 0}, {1, 1, 1}, {0, 0, 0}};
    EXPECT_EQ(delaunay(two).errors()[0].code, ErrorCode::TooFewPoints);
    Points line;
    for (int i = 0; i < 1'000; ++i)
        line.push_back({i * 0.5, i * 1.5, 0});
    EXPECT_EQ(delaunay(line).errors()[0].code, ErrorCode::PointsCollinear);
    line.push_back({0.5, std::nextafter(1.5, 2.0), 0});
    const auto mesh = delaunay(line);
    ASSERT_TRUE(mesh.ok());
    expect_delaunay(*mesh);
}

TEST(Delaunay, TellsItsProgressAndStops) {
    const Points points = test::point_cloud("scattered").make(100'000, 1);
    std::vector<double> told;
    DelaunayOptions options;
    options.progress = [&](double share) {
        told.push_back(share);
        return true;
    };
    ASSERT_TRUE(delaunay(points, options).ok());
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_GE(told.size(), 6U);
    EXPECT_LE(told.back(), 1.0);
    for (std::size_t stop = 0; stop < told.size(); ++stop) {
        std::size_t asked = 0;
        options.progress = [&](double) { return asked++ != stop; };
        const auto stopped = delaunay(points, options);
        ASSERT_FALSE(stopped.ok());
        EXPECT_EQ(stopped.errors()[0].code, ErrorCode::Cancelled);
        EXPECT_EQ(asked, stop + 1);
    }
}

}  // namespace
}  // namespace tinsmith::core
