// SPDX-License-Identifier: Apache-2.0
// A GLB of the whole mesh against what cannot be left out of it: Draco's and meshopt's own calls on
// ready buffers, and a copy of the file's bytes. README.md in this folder says what came out.
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "api/formats/gltf.hpp"
#include "api/side_by_side.hpp"
#include "tests/bench/glb_peers.hpp"
#include "tests/bench/terrains.hpp"
#include "tests/bench/timing.hpp"
#include "tests/bench/turns.hpp"
#include "tests/bench/two_processors.hpp"
#include "tests/cgal/bundled_data.hpp"

namespace tinsmith::bench {
namespace {

constexpr const char* kUsage =
    "usage: glb_bench PART [RUNS]\n"
    "  bundled  the bundled terrain\n"
    "  million  the same ground with 1,000,000 triangles\n"
    "  ours     Tinsmith alone on that, with Draco, for `perf record`; also ours-meshopt, "
    "ours-none\n"
    "  smoke    one run of the bundled terrain; fails where both sides' bytes differ much\n";

std::string written(const core::MeshData& mesh, const api::GltfOptions& options,
                    const core::Executor& executor = core::one_after_another) {
    auto result = api::write_glb(mesh, options, nullptr, executor);
    if (const auto* error = std::get_if<api::EncodeError>(&result))
        throw std::runtime_error(error->detail);
    return std::move(std::get<api::GltfResult>(result).bytes);
}

/// Milliseconds of a call that gives bytes, how many it keeps in `size`.
template <typename Call>
Side timed(double (*clock)(), std::size_t& size, Call call) {
    return [=, &size] {
        const double start = clock();
        size = call();
        return clock() - start;
    };
}

struct Row {
    std::size_t ours = 0;  ///< bytes
    std::size_t theirs = 0;
    Turns turns;
};

Row compare(double (*clock)(), int runs, const std::function<std::size_t()>& ours,
            const std::function<std::size_t()>& theirs) {
    Row row;
    row.turns = take_turns({timed(clock, row.ours, ours), timed(clock, row.theirs, theirs)}, runs);
    return row;
}

void print(const char* name, const Row& row) {
    std::printf("| %s | %zu | %zu | %s | %s | %s |\n", name, row.ours, row.theirs,
                milliseconds(row.turns[0]).c_str(), milliseconds(row.turns[1]).c_str(),
                ratio(row.turns[0], row.turns[1]).c_str());
    std::fflush(stdout);
}

/// One thread is timed by its own clock, two by the wall's.
struct Threads {
    const char* name;
    double (*clock)();
    core::Executor executor;
};

const Threads kOne{"one thread", now_ms, core::one_after_another};
const Threads kTwo{"two threads", wall_ms, on_two_processors};

api::GltfOptions with(api::Compression compression, bool normals = true) {
    api::GltfOptions options;
    options.compression = compression;
    options.normals = normals;
    return options;
}

Row compare_draco(const core::MeshData& mesh, const ReadyBuffers& buffers, const Threads& threads,
                  int runs) {
    const DracoAlone alone(buffers);
    return compare(
        threads.clock, runs, [&] { return written(mesh, {}, threads.executor).size(); },
        [&] { return alone.encode(); });
}

Row compare_meshopt(const core::MeshData& mesh, const ReadyBuffers& buffers, const Threads& threads,
                    int runs) {
    const MeshoptAlone alone(buffers);
    const api::GltfOptions options = with(api::Compression::Meshopt);
    return compare(
        threads.clock, runs, [&] { return written(mesh, options, threads.executor).size(); },
        [&] { return alone.encode(); });
}

Row compare_plain(const core::MeshData& mesh, bool normals, const Threads& threads, int runs) {
    const api::GltfOptions options = with(api::Compression::None, normals);
    const std::string bytes = written(mesh, options);
    return compare(
        threads.clock, runs, [&] { return written(mesh, options, threads.executor).size(); },
        [&] { return std::string(bytes).size(); });
}

void compare_all(const core::MeshData& mesh, int runs) {
    const ReadyBuffers buffers(mesh);
    std::printf(
        "%zu triangles. Milliseconds are medians (minima), ratios medians of paired runs (middle "
        "half).\n\n| GLB | bytes | theirs | Tinsmith ms | theirs ms | Tinsmith / theirs |\n"
        "|---|--:|--:|--:|--:|--:|\n",
        mesh.triangles.size());
    for (const Threads& threads : {kOne, kTwo}) {
        const auto row = [&](const char* what, const Row& runs_of) {
            print((what + (std::string(", ") + threads.name)).c_str(), runs_of);
        };
        row("Draco, against Draco alone", compare_draco(mesh, buffers, threads, runs));
        row("meshopt, against its own calls", compare_meshopt(mesh, buffers, threads, runs));
        row("plain, against a copy", compare_plain(mesh, true, threads, runs));
        row("plain without normals, against a copy", compare_plain(mesh, false, threads, runs));
    }
}

bool alike(const char* name, const Row& row) {
    std::printf("%s: %zu bytes, %zu by the codec alone\n", name, row.ours, row.theirs);
    return row.theirs > 0 && row.ours > row.theirs && row.ours - row.theirs < row.theirs / 50;
}

int smoke(const core::MeshData& mesh) {
    const ReadyBuffers buffers(mesh);
    const bool same = alike("Draco", compare_draco(mesh, buffers, kTwo, 1)) &&
                      alike("meshopt", compare_meshopt(mesh, buffers, kTwo, 1)) &&
                      written(mesh, {}) == written(mesh, {}, api::side_by_side);
    return same ? EXIT_SUCCESS : EXIT_FAILURE;
}

int ours(const core::MeshData& mesh, api::Compression compression, int runs) {
    for (int i = 0; i < runs; ++i) {
        const double start = wall_ms();
        const std::size_t size = written(mesh, with(compression), on_two_processors).size();
        std::printf("%.1f ms, %zu bytes\n", wall_ms() - start, size);
    }
    return EXIT_SUCCESS;
}

int run(const std::string& part, int runs) {
    const core::MeshData terrain = cgal::bundled_terrain();
    if (part == "smoke") return smoke(terrain);
    if (part == "bundled") {
        compare_all(terrain, runs);
        return EXIT_SUCCESS;
    }
    const core::MeshData million = resampled(terrain, 1'000'000, 0.5);
    if (part == "ours") return ours(million, api::Compression::Draco, runs);
    if (part == "ours-meshopt") return ours(million, api::Compression::Meshopt, runs);
    if (part == "ours-none") return ours(million, api::Compression::None, runs);
    if (part == "million") {
        compare_all(million, runs);
        return EXIT_SUCCESS;
    }
    std::fputs(kUsage, stderr);
    return 2;
}

}  // namespace
}  // namespace tinsmith::bench

int main(int count, char** arguments) {
    return tinsmith::bench::run_program("glb_bench", count, arguments, 9, tinsmith::bench::run);
}
