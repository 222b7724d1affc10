// SPDX-License-Identifier: Apache-2.0
// The core's Delaunay triangulation against CGAL's with its spatial sort, on the same points, in
// one run: README.md in this folder says what is compared and what came out. One thread by its own
// clock, and Tinsmith on two processors by the wall's.
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/mesh/delaunay.hpp"
#include "tests/bench/timing.hpp"
#include "tests/bench/two_processors.hpp"
#include "tests/cgal/bundled_data.hpp"
#include "tests/cgal/delaunay_mesh.hpp"
#include "tests/support/point_clouds.hpp"

namespace tinsmith::bench {
namespace {

constexpr const char* kUsage =
    "usage: delaunay_bench PART [RUNS]\n"
    "  bundled  the bundled terrain's points, and as many of each sort\n"
    "  half     500,000 points\n"
    "  large    5,000,000 points (needs 2 GB)\n"
    "  ours     Tinsmith alone, 1,000,000 scattered points, for `perf record`\n"
    "  smoke    small clouds of every sort; fails where the counts of triangles differ\n";

using Points = std::vector<core::Point3>;

std::size_t count_by(const core::Executor& executor, const Points& points) {
    core::DelaunayOptions options;
    options.executor = executor;
    const auto mesh = core::delaunay(points, options);
    if (!mesh) throw std::runtime_error("the points are refused: " + mesh.errors()[0].detail);
    return mesh->triangles.size();
}

std::size_t count_ours(const Points& points) {
    return count_by(core::one_after_another, points);
}

std::size_t count_on_two(const Points& points) {
    return count_by(on_two_processors, points);
}

struct Timed {
    double ms = 0.0;
    std::size_t triangles = 0;
};

Timed timed(std::size_t (*count)(const Points&), const Points& points, double (*clock)() = now_ms) {
    const double start = clock();
    const std::size_t triangles = count(points);
    return {clock() - start, triangles};
}

/// All in turn, each run after a first one that warms up.
void compare(const std::string& name, const Points& points, int runs) {
    std::vector<double> ours, shared, bare, indexed;
    for (int run = 0; run <= runs; ++run) {
        const Timed our = timed(count_ours, points);
        const Timed two = timed(count_on_two, points, wall_ms);
        const Timed plain = timed(cgal::delaunay_count, points);
        const Timed with_indices = timed(cgal::delaunay_count_with_indices, points);
        if (our.triangles != plain.triangles || two.triangles != plain.triangles ||
            our.triangles != with_indices.triangles)
            throw std::runtime_error(name + ": " + std::to_string(our.triangles) +
                                     " triangles, CGAL " + std::to_string(plain.triangles));
        if (run == 0) continue;
        ours.push_back(our.ms);
        shared.push_back(two.ms);
        bare.push_back(plain.ms);
        indexed.push_back(with_indices.ms);
    }
    std::printf("| %s | %zu | %.1f | %.1f | %.1f | %.1f | %.0f | %s | %s | %s |\n", name.c_str(),
                points.size(), median(ours), median(shared), median(bare), median(indexed),
                median(ours) * 1e6 / static_cast<double>(points.size()), ratio(bare, ours).c_str(),
                ratio(bare, shared).c_str(), ratio(indexed, ours).c_str());
    std::fflush(stdout);
}

void compare_all(std::size_t size, int runs) {
    for (const char* name :
         {"scattered", "centimetres far away", "grid", "grid far away", "clustered"})
        compare(name, test::point_cloud(name).make(size, 1), runs);
}

int smoke() {
    for (const test::PointCloud& cloud : test::point_clouds()) {
        const Points points = cloud.make(2'000, 7);
        const std::size_t ours = count_ours(points), theirs = cgal::delaunay_count(points);
        std::printf("%s: %zu triangles, %zu by CGAL\n", cloud.name.c_str(), ours, theirs);
        if (ours != theirs) return EXIT_FAILURE;
    }
    return EXIT_SUCCESS;
}

int run(const std::string& part, int runs) {
    if (part == "smoke") return smoke();
    if (part == "ours") {
        const Points points = test::point_cloud("scattered").make(1'000'000, 1);
        for (int i = 0; i < runs; ++i)
            std::printf("%.1f ms\n", timed(count_ours, points).ms);
        return EXIT_SUCCESS;
    }
    if (part != "bundled" && part != "half" && part != "large") {
        std::fputs(kUsage, stderr);
        return 2;
    }
    std::printf(
        "| points | number | Tinsmith ms | on two ms | CGAL ms | CGAL with indices ms | Tinsmith "
        "ns/point | CGAL / Tinsmith | CGAL / on two | with indices / Tinsmith |\n"
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    if (part == "bundled") {
        const Points terrain = cgal::bundled_terrain().vertices;
        compare("bundled terrain", terrain, runs);
        compare_all(terrain.size(), runs);
    }
    if (part == "half") compare_all(500'000, runs);
    if (part == "large") compare_all(5'000'000, runs);
    return EXIT_SUCCESS;
}

}  // namespace
}  // namespace tinsmith::bench

int main(int count, char** arguments) {
    return tinsmith::bench::run_program("delaunay_bench", count, arguments, 9,
                                        tinsmith::bench::run);
}
