// SPDX-License-Identifier: Apache-2.0
// What integrating costs beside the least that it could: walking the same triangles and writing the
// same bytes, and nothing else. One thread, on a copy of the mesh made just before, with what the
// caches hold of it driven out of them.
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/integrate/integrator.hpp"
#include "core/mesh/build.hpp"
#include "tests/bench/terrains.hpp"
#include "tests/bench/timing.hpp"
#include "tests/bench/turns.hpp"
#include "tests/bench/walked.hpp"
#include "tests/cgal/bundled_data.hpp"

namespace tinsmith::bench {
namespace {

constexpr const char* kUsage =
    "usage: walk_bench PART [RUNS]\n"
    "  bundled  the bundled terrain and polygons\n"
    "  million  the same ground with 1,000,000 triangles\n"
    "  large    the same ground with 10,000,000 triangles (needs 4 GB)\n"
    "  smoke    one run; fails where a walk writes nothing\n";

/// Larger than any cache here.
constexpr std::size_t kDriverBytes = std::size_t{256} << 20;

core::Report integrated(core::Tin& tin, const core::Shape& shape) {
    auto report = core::integrate(tin, {&shape, 1}, {});
    if (!report) throw std::runtime_error("the shape is refused: " + report.errors()[0].detail);
    return std::move(*report);
}

class Row {
  public:
    Row(const core::Tin& base, const core::Shape& shape)
        : base_(base), shape_(shape), after_(base), walked_(walk()) {}

    bool print(const std::string& mesh, const std::string& polygon, int runs) {
        const Turns turns =
            take_turns({[this] { return integrate(); }, [this] { return go(true); },
                        [this] { return integrate(); }, [this] { return go(false); }},
                       runs);
        const auto each = [this](const std::vector<double>& ms) {
            return median(ms) * 1e6 / static_cast<double>(crossings_);
        };
        std::printf("| %s | %s | %llu | %zu | %zu | %s | %s | %s | %.0f | %s | %s |\n",
                    mesh.c_str(), polygon.c_str(), static_cast<unsigned long long>(crossings_),
                    walked_.triangle_count(), walked_.bytes_written(),
                    milliseconds(turns[0]).c_str(), milliseconds(turns[1]).c_str(),
                    milliseconds(turns[3]).c_str(), each(turns[0]),
                    ratio(turns[0], turns[1]).c_str(), ratio(turns[2], turns[3]).c_str());
        std::fflush(stdout);
        return walked_.bytes_written() > 0;
    }

  private:
    Walked walk() {
        const core::Report report = integrated(after_, shape_);
        crossings_ = report.shapes[0].vertices_added;
        return {base_, after_, report.shapes[0].chains};
    }

    void drive_out() {
        for (std::size_t i = 0; i < driver_.size(); i += 8)
            ++driver_[i];
    }

    double integrate() {
        core::Tin tin = base_;
        drive_out();
        const double start = now_ms();
        integrated(tin, shape_);
        return now_ms() - start;
    }

    double go(bool dependent) {
        Walked::Slots slots = walked_.copy_of(base_);
        drive_out();
        const double start = now_ms();
        sum_ += walked_.go(slots, dependent);
        return now_ms() - start;
    }

    const core::Tin& base_;
    const core::Shape& shape_;
    core::Tin after_;
    std::uint64_t crossings_ = 0;
    const Walked walked_;
    std::vector<std::uint64_t> driver_ = std::vector<std::uint64_t>(kDriverBytes / 8);
    double sum_ = 0.0;
};

int run(const std::string& part, int runs) {
    const bool is_smoke = part == "smoke";
    core::MeshData mesh = cgal::bundled_terrain();
    if (part == "million") {
        mesh = resampled(mesh, 1'000'000, 0.5);
    } else if (part == "large") {
        mesh = resampled(mesh, 10'000'000, 0.2);
    } else if (part != "bundled" && !is_smoke) {
        std::fputs(kUsage, stderr);
        return 2;
    }
    const auto tin = core::build_tin(mesh);
    if (!tin) throw std::runtime_error("the mesh is refused: " + tin.errors()[0].detail);
    std::printf(
        "| mesh | polygon | new vertices | triangles | bytes | Tinsmith ms | walk ms | known ahead "
        "ms | Tinsmith ns/vertex | Tinsmith / walk | Tinsmith / known ahead |\n"
        "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    bool fine = true;
    for (const char* name : {"lake", "contour_3500"}) {
        const core::Shape shape = cgal::bundled_shape(name);
        Row row(*tin, shape);
        fine &= row.print(std::to_string(tin->triangle_count() / 1000) + "k", name,
                          is_smoke ? 1 : runs);
    }
    return fine ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace tinsmith::bench

int main(int count, char** arguments) {
    return tinsmith::bench::run_program("walk_bench", count, arguments, 15, tinsmith::bench::run);
}
