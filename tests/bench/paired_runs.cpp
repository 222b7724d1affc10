// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/paired_runs.hpp"

#include <cstdio>
#include <stdexcept>

#include "core/integrate/integrator.hpp"
#include "core/mesh/build.hpp"
#include "tests/bench/timing.hpp"
#include "tests/cgal/bundled_data.hpp"

namespace tinsmith::bench {

namespace {

core::Tin built(const core::MeshData& mesh) {
    auto tin = core::build_tin(mesh);
    if (!tin) throw std::runtime_error("the mesh is refused: " + tin.errors()[0].detail);
    return std::move(*tin);
}

core::Report integrated(core::Tin& tin, const core::Shape& shape,
                        const core::IntegrateOptions& options) {
    auto report = core::integrate(tin, {&shape, 1}, options);
    if (!report) throw std::runtime_error("the shape is refused: " + report.errors()[0].detail);
    return std::move(*report);
}

/// Of a run of its own, for looking at the clock takes time.
double share_of_improving(core::Tin tin, const core::Shape& shape) {
    core::IntegrateOptions options;
    options.clock_ms = now_ms;
    const core::StageTimes ms = integrated(tin, shape, options).time_ms;
    return ms.improve / (ms.locate + ms.integrate + ms.improve);
}

double timed_insert(cgal::Peer& peer, const std::vector<cgal::Polyline>& paths) {
    const double start = now_ms();
    peer.insert(paths);
    return now_ms() - start;
}

/// Of each turn's two runs of `ours` the one of that number, which stands beside a peer's.
std::vector<double> of_turns(const std::vector<double>& ours, std::size_t number) {
    std::vector<double> runs;
    for (std::size_t i = number; i < ours.size(); i += 2)
        runs.push_back(ours[i]);
    return runs;
}

std::string times(const std::vector<double>& values) {
    char text[64];
    std::snprintf(text, sizeof text, "%.3f (%.3f)", median(values), least(values));
    return text;
}

}  // namespace

Bases::Bases(const core::MeshData& mesh)
    : tin(built(mesh)),
      points(cgal::Peer::of_points(mesh)),
      triangles(cgal::Peer::of_triangles(mesh)) {}

PairedRuns run_paired(const Bases& bases, const core::Shape& shape, int runs) {
    const std::vector<cgal::Polyline> paths = cgal::drape(bases.tin, shape);
    PairedRuns result;
    const auto run_ours = [&] {
        core::Tin tin = bases.tin;
        const double start = now_ms();
        const core::Report report = integrated(tin, shape, {});
        result.ours.push_back(now_ms() - start);
        result.crossings = report.shapes[0].crossings;
        result.added = report.shapes[0].vertices_added;
    };
    const auto run_peer = [&](const cgal::Peer& base, std::vector<double>& times) {
        cgal::Peer peer = base;
        times.push_back(timed_insert(peer, paths));
        return peer.vertex_count() - base.vertex_count();
    };
    result.improving = share_of_improving(bases.tin, shape);
    for (int run = 0; run < runs; ++run) {
        run_ours();
        result.added_points = run_peer(bases.points, result.points);
        run_ours();
        result.added_triangles = run_peer(bases.triangles, result.triangles);
    }
    return result;
}

void print_heading() {
    std::printf(
        "Milliseconds are medians (minima in brackets), ratios medians of paired runs (middle half "
        "in brackets).\n\n"
        "| mesh | polygon | segments | crossings | new vertices | b's | Tinsmith ms | a ms | b ms "
        "| of it improving | Tinsmith ns/vertex | b ns/vertex | Tinsmith / a | Tinsmith / b |\n"
        "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
}

void print_row(const std::string& mesh, const std::string& polygon, std::size_t segments,
               const PairedRuns& runs) {
    const auto each = [](double ms, std::uint64_t count) {
        return ms * 1e6 / static_cast<double>(count);
    };
    std::printf(
        "| %s | %s | %zu | %llu | %llu | %llu | %s | %s | %s | %.0f %% | %.0f | %.0f | %s | %s |\n",
        mesh.c_str(), polygon.c_str(), segments, static_cast<unsigned long long>(runs.crossings),
        static_cast<unsigned long long>(runs.added),
        static_cast<unsigned long long>(runs.added_triangles), times(runs.ours).c_str(),
        times(runs.points).c_str(), times(runs.triangles).c_str(), runs.improving * 100.0,
        each(median(runs.ours), runs.added), each(median(runs.triangles), runs.added_triangles),
        ratio(of_turns(runs.ours, 0), runs.points).c_str(),
        ratio(of_turns(runs.ours, 1), runs.triangles).c_str());
    std::fflush(stdout);
}

}  // namespace tinsmith::bench
