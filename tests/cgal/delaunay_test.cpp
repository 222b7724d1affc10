// SPDX-License-Identifier: Apache-2.0
// The core's Delaunay triangulation against CGAL's, on point clouds of every sort.
#include "core/mesh/delaunay.hpp"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "core/mesh/build.hpp"
#include "core/mesh/check.hpp"
#include "tests/cgal/bundled_data.hpp"
#include "tests/cgal/delaunay_mesh.hpp"
#include "tests/support/point_clouds.hpp"

namespace tinsmith {
namespace {

std::set<std::array<std::uint32_t, 3>> turned(const core::MeshData& mesh) {
    std::set<std::array<std::uint32_t, 3>> set;
    for (auto t : mesh.triangles) {
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        set.insert(t);
    }
    return set;
}

void expect_as_cgal(const std::vector<core::Point3>& points, bool has_ties) {
    const auto mesh = core::delaunay(points);
    ASSERT_TRUE(mesh.ok()) << mesh.errors()[0].detail;
    const auto tin = core::build_tin(*mesh);
    ASSERT_TRUE(tin.ok()) << tin.errors()[0].detail;
    const auto violations = core::check_tin(*tin);
    ASSERT_TRUE(violations.empty()) << violations[0].law << " " << violations[0].detail;
    EXPECT_TRUE(cgal::is_delaunay(*mesh));
    const core::MeshData theirs = cgal::delaunay_mesh(mesh->vertices);
    EXPECT_EQ(mesh->triangles.size(), theirs.triangles.size());
    if (!has_ties) {
        EXPECT_EQ(turned(*mesh), turned(theirs));
    }
}

TEST(DelaunayAgainstCgal, OnCloudsOfEverySort) {
    for (const test::PointCloud& cloud : test::point_clouds()) {
        for (std::uint64_t seed = 1; seed <= 30; ++seed) {
            SCOPED_TRACE(cloud.name + ", seed " + std::to_string(seed));
            ASSERT_NO_FATAL_FAILURE(
                expect_as_cgal(cloud.make(20 + 23 * seed, seed), cloud.has_ties));
        }
        SCOPED_TRACE(cloud.name);
        ASSERT_NO_FATAL_FAILURE(expect_as_cgal(cloud.make(30'000, 99), cloud.has_ties));
    }
}

TEST(DelaunayAgainstCgal, OnTheBundledTerrain) {
    expect_as_cgal(cgal::bundled_terrain().vertices, true);
}

}  // namespace
}  // namespace tinsmith
