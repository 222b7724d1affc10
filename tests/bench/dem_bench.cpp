// SPDX-License-Identifier: Apache-2.0
// A grid of elevations from its GeoTIFF to a mesh that can be edited, against what no program can
// leave out: reading the file, and writing as many bytes as the finished mesh has into memory that
// was not used before. README.md in this folder says what came out. Wall time: half of it is the
// system's handing out of pages.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>

#include "api/formats/geotiff.hpp"
#include "api/formats/grid_mesh.hpp"
#include "core/mesh/large_blocks.hpp"
#include "tests/bench/dem.hpp"
#include "tests/bench/timing.hpp"
#include "tests/bench/turns.hpp"
#include "tests/bench/two_processors.hpp"

namespace tinsmith::bench {
namespace {

constexpr const char* kUsage =
    "usage: dem_bench TRIANGLES [RUNS]\n"
    "  writes dem_bench.tif, the bundled terrain with about so many triangles, where it is called\n"
    "  10000000  needs 3 GB; 20000 is a smoke test, which fails where triangles are missing\n";

std::string bytes_of_file(const std::string& path) {
    std::ifstream in(path, std::ios::binary | std::ios::ate);
    std::string bytes(static_cast<std::size_t>(in.tellg()), '\0');
    in.seekg(0);
    if (!in.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
        throw std::runtime_error(path + " cannot be read");
    return bytes;
}

core::Tin ready_to_edit(const std::string& path, const core::Executor& execute) {
    api::ReadLimits limits;
    limits.max_vertices = limits.max_triangles = 50'000'000;
    auto terrain = api::read_geotiff(bytes_of_file(path), limits, {});
    if (!terrain) throw std::runtime_error(terrain.faults().front().detail);
    auto tin = api::tin_of_grid(*terrain->grid, limits, execute);
    if (!tin) throw std::runtime_error("the grid is no mesh");
    return std::move(*tin);
}

/// The bytes of the file, and so many written.
void read_and_write(const std::string& path, std::size_t bytes) {
    const std::string file = bytes_of_file(path);
    void* const block = core::allocate_large_block(bytes);
    std::memset(block, file.empty() ? 1 : file.back(), bytes);
    core::free_large_block(block, bytes);
}

int run(std::size_t triangles, int runs) {
    const std::string path = "dem_bench.tif";
    const std::size_t written = write_dem(path, triangles);
    const core::Tin tin = ready_to_edit(path, core::one_after_another);
    std::printf(
        "%zu triangles, %.1f bytes each\n", tin.triangle_count(),
        static_cast<double>(tin.memory_bytes()) / static_cast<double>(tin.triangle_count()));
    if (tin.triangle_count() != written) return EXIT_FAILURE;
    const std::size_t bytes = tin.memory_bytes();
    const auto timed = [](auto call) -> Side {
        return [call] {
            const double start = wall_ms();
            call();
            return wall_ms() - start;
        };
    };
    const Turns turns = take_turns({timed([&] { ready_to_edit(path, core::one_after_another); }),
                                    timed([&] { ready_to_edit(path, on_two_processors); }),
                                    timed([&] { read_and_write(path, bytes); })},
                                   runs);
    std::printf("| threads | Tinsmith ms | read and write ms | ratio |\n|--:|--:|--:|--:|\n");
    for (std::size_t i = 0; i < 2; ++i)
        std::printf("| %zu | %s | %s | %s |\n", i + 1, milliseconds(turns[i]).c_str(),
                    milliseconds(turns[2]).c_str(), ratio(turns[i], turns[2]).c_str());
    return EXIT_SUCCESS;
}

}  // namespace
}  // namespace tinsmith::bench

int main(int count, char** arguments) {
    return tinsmith::bench::run_program(
        "dem_bench", count, arguments, 5, [](const std::string& triangles, int runs) {
            const long wanted = std::atol(triangles.c_str());
            if (wanted >= 2) return tinsmith::bench::run(static_cast<std::size_t>(wanted), runs);
            std::fputs(tinsmith::bench::kUsage, stderr);
            return 2;
        });
}
