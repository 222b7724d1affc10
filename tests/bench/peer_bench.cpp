// SPDX-License-Identifier: Apache-2.0
// Tinsmith's `strict` against CGAL's two recipes, on the same meshes and polygons, in one run:
// README.md in this folder says what is compared and what came out. One thread.
#include <cstdio>
#include <cstdlib>
#include <string>

#include <sys/resource.h>

#include "tests/bench/paired_runs.hpp"
#include "tests/bench/terrains.hpp"
#include "tests/bench/timing.hpp"
#include "tests/cgal/bundled_data.hpp"

namespace tinsmith::bench {
namespace {

constexpr const char* kUsage =
    "usage: peer_bench PART [RUNS]\n"
    "  bundled  the bundled terrain and polygons, and shorelines over 90 % of it\n"
    "  million  the same ground with 1,000,000 triangles\n"
    "  large    the same ground with 10,000,000 triangles (needs 4 GB)\n"
    "  scaling  shorelines of 100 to 100,000 segments in the bundled terrain\n"
    "  memory   bytes a triangle at rest\n"
    "  smoke    one run of the bundled polygons; fails where the counts of new vertices differ\n";

constexpr const char* kBundled[] = {"parcel", "lake", "road", "contour_450", "contour_3500"};

std::size_t segment_count(const core::Shape& shape) {
    std::size_t count = 0;
    for (const core::Path& path : shape.paths)
        count += path.points.size() - (path.closed ? 0 : 1);
    return count;
}

std::string name_of(const core::MeshData& mesh) {
    const double thousands = static_cast<double>(mesh.triangles.size()) / 1e3;
    return std::to_string(static_cast<long>(thousands + 0.5)) + "k";
}

/// The bundled shapes and then shorelines of these numbers of segments.
void compare(const core::MeshData& mesh, bool bundled, std::initializer_list<std::size_t> shores,
             int runs) {
    const Bases bases(mesh);
    const auto row = [&](const std::string& polygon, const core::Shape& shape) {
        print_row(name_of(mesh), polygon, segment_count(shape), run_paired(bases, shape, runs));
    };
    if (bundled) {
        for (const char* name : kBundled)
            row(name, cgal::bundled_shape(name));
    }
    for (const std::size_t segments : shores)
        row("shoreline", shoreline(bases.tin.bounds(), 0.9, segments));
}

int smoke(const core::MeshData& mesh) {
    const Bases bases(mesh);
    int failures = 0;
    for (const char* name : kBundled) {
        const PairedRuns runs = run_paired(bases, cgal::bundled_shape(name), 1);
        std::printf("%s: %llu crossings, %llu new vertices, %llu by CGAL\n", name,
                    static_cast<unsigned long long>(runs.crossings),
                    static_cast<unsigned long long>(runs.added),
                    static_cast<unsigned long long>(runs.added_triangles));
        if (runs.added == 0 || runs.added != runs.added_triangles) ++failures;
    }
    return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

double resident_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) * 1024.0;
}

void print_memory(const core::MeshData& mesh) {
    const Bases bases(mesh);
    const auto count = static_cast<double>(mesh.triangles.size());
    std::printf("| %s | %.1f | %.1f | %.1f | %.0f |\n", name_of(mesh).c_str(),
                static_cast<double>(bases.tin.memory_bytes()) / count,
                static_cast<double>(bases.points.memory_bytes()) / count,
                static_cast<double>(bases.triangles.memory_bytes()) / count,
                resident_bytes() / 0x1p20);
}

int run(const std::string& part, int runs) {
    const core::MeshData terrain = cgal::bundled_terrain();
    if (part == "smoke") return smoke(terrain);
    if (part == "memory") {
        std::printf(
            "| mesh | Tinsmith B/triangle | a B/triangle | b B/triangle | peak of the process, all "
            "three and the buffers, MiB |\n|---|--:|--:|--:|--:|\n");
        print_memory(terrain);
        print_memory(resampled(terrain, 1'000'000, 0.5));
        print_memory(resampled(terrain, 10'000'000, 0.2));
        return EXIT_SUCCESS;
    }
    const bool known =
        part == "bundled" || part == "million" || part == "large" || part == "scaling";
    if (!known) {
        std::fputs(kUsage, stderr);
        return 2;
    }
    print_heading();
    if (part == "bundled") compare(terrain, true, {90, 1'000, 10'000, 76'000}, runs);
    if (part == "million")
        compare(resampled(terrain, 1'000'000, 0.5), true, {90, 1'000, 10'000, 76'000}, runs);
    if (part == "large")
        compare(resampled(terrain, 10'000'000, 0.2), true, {90, 1'000, 10'000, 76'000}, runs);
    if (part == "scaling")
        compare(terrain, false, {100, 300, 1'000, 3'000, 10'000, 30'000, 100'000}, runs);
    return EXIT_SUCCESS;
}

}  // namespace
}  // namespace tinsmith::bench

int main(int count, char** arguments) {
    return tinsmith::bench::run_program("peer_bench", count, arguments, 15, tinsmith::bench::run);
}
