// SPDX-License-Identifier: Apache-2.0
// Time against size for requests that meet a mesh's border, or one vertex, very often: what is
// linear takes four times as long from one row to the next.
//     boundary_bench [SHAPE [LARGEST]]
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/integrate/integrator.hpp"
#include "core/mesh/build.hpp"
#include "tests/support/border_shapes.hpp"

namespace {

using namespace tinsmith;

double now_ms() {
    using namespace std::chrono;
    return duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

/// One row; false where the size is better not doubled again.
bool run(const test::BorderShape& shape, std::size_t size, double& before) {
    constexpr double kLongEnough = 8'000.0;
    const test::BorderCase made = shape.make(size);
    auto tin = core::build_tin(made.mesh);
    if (!tin) {
        std::printf("%-20s %8zu the mesh is refused: %s\n", shape.name, size,
                    tin.errors().front().detail.c_str());
        return false;
    }
    core::IntegrateOptions options;
    options.clock_ms = now_ms;
    core::Undo undo;
    if (!made.before.empty() && !core::integrate(*tin, made.before, options, &undo)) return false;
    const double begin = now_ms();
    const auto report = core::integrate(*tin, made.shapes, options, &undo);
    const double time = now_ms() - begin;
    if (!report) {
        std::printf("%-20s %8zu refused after %.0f ms: %s\n", shape.name, size, time,
                    report.errors().front().detail.c_str());
        return time < kLongEnough;
    }
    std::uint64_t crossings = 0, vertices = 0, parts = 0;
    for (const core::ShapeReport& r : report->shapes) {
        crossings += r.crossings;
        vertices += r.vertices_added;
        parts += r.outside.size();
    }
    const double begin_undo = now_ms();
    core::take_back(*tin, undo);
    const double back = now_ms() - begin_undo;
    const core::StageTimes& t = report->time_ms;
    std::printf("%-20s %8zu %9llu %9llu %9llu %10.1f %6.1f %9.1f %9.1f %9.1f %8.1f\n", shape.name,
                size, static_cast<unsigned long long>(crossings),
                static_cast<unsigned long long>(vertices), static_cast<unsigned long long>(parts),
                time, before > 0.0 ? time / before : 0.0, t.locate, t.integrate, t.improve, back);
    std::fflush(stdout);
    before = time;
    return time < kLongEnough;
}

}  // namespace

int main(int count, char** arguments) {
    const std::string wanted = count > 1 ? arguments[1] : "";
    const std::size_t largest = count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 256'000;
    std::printf("%-20s %8s %9s %9s %9s %10s %6s %9s %9s %9s %8s\n", "shape", "size", "crossings",
                "vertices", "outside", "ms", "times", "locate", "integrate", "improve", "undo");
    for (const test::BorderShape& shape : test::border_shapes()) {
        if (!wanted.empty() && wanted != shape.name) continue;
        double before = 0.0;
        for (std::size_t size = 1'000; size <= largest; size *= 4)
            if (!run(shape, size, before)) break;
    }
}
