// SPDX-License-Identifier: Apache-2.0
// Cut and fill between two versions of the bundled terrain, exactly, against the difference of two
// rasters of it by GDAL with posts every metre. README.md in this folder says what came out.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <gdal.h>

#include "core/edit/volume.hpp"
#include "core/integrate/integrator.hpp"
#include "core/mesh/build.hpp"
#include "core/mesh/surface.hpp"
#include "core/mesh/walk.hpp"
#include "tests/bench/timing.hpp"
#include "tests/bench/turns.hpp"
#include "tests/cgal/bundled_data.hpp"

namespace tinsmith::bench {
namespace {

constexpr const char* kUsage =
    "usage: volume_bench PART [RUNS]\n"
    "  lake   where the lake's outline was bent to one level\n"
    "  smoke  one run with posts every 8 metres; fails where the volumes differ much\n";

struct Close {
    void operator()(GDALDatasetH dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<void, Close>;

struct Box {
    core::Point2 low{1e300, 1e300};
    core::Point2 high{-1e300, -1e300};
};

double elevation_at(const core::Tin& tin, core::Point2 p) {
    const core::Location at = core::locate(tin, p, tin.hint(p));
    if (at.kind == core::Location::Kind::Outside) throw std::runtime_error("outside the mesh");
    if (at.kind == core::Location::Kind::OnVertex) return tin.vertex(at.vertex).z;
    return core::elevation_in(tin, at.side.triangle(), p);
}

/// A surface as a raster in GDAL's memory: float64 at the middles of cells.
Dataset raster_of(const core::Tin& tin, const Box& box, double cell) {
    const auto columns = static_cast<int>((box.high.x - box.low.x) / cell);
    const auto rows = static_cast<int>((box.high.y - box.low.y) / cell);
    Dataset raster(
        GDALCreate(GDALGetDriverByName("MEM"), "", columns, rows, 1, GDT_Float64, nullptr));
    std::vector<double> line(static_cast<std::size_t>(columns));
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column)
            line[static_cast<std::size_t>(column)] = elevation_at(
                tin, {box.low.x + (column + 0.5) * cell, box.low.y + (row + 0.5) * cell});
        if (GDALRasterIO(GDALGetRasterBand(raster.get(), 1), GF_Write, 0, row, columns, 1,
                         line.data(), columns, 1, GDT_Float64, 0, 0) != CE_None)
            throw std::runtime_error("the raster cannot be written");
    }
    return raster;
}

core::Volume difference(const Dataset& raster, const Dataset& other, double cell) {
    GDALRasterBandH ours = GDALGetRasterBand(raster.get(), 1);
    GDALRasterBandH theirs = GDALGetRasterBand(other.get(), 1);
    const int columns = GDALGetRasterXSize(raster.get()), rows = GDALGetRasterYSize(raster.get());
    constexpr int kAtOnce = 16;
    std::vector<double> a(static_cast<std::size_t>(columns) * kAtOnce), b(a.size());
    core::Volume volume;
    for (int row = 0; row < rows; row += kAtOnce) {
        const int count = std::min(kAtOnce, rows - row);
        const auto read = [&](GDALRasterBandH band, std::vector<double>& into) {
            return GDALRasterIO(band, GF_Read, 0, row, columns, count, into.data(), columns, count,
                                GDT_Float64, 0, 0);
        };
        if (read(ours, a) != CE_None || read(theirs, b) != CE_None)
            throw std::runtime_error("the raster cannot be read");
        const std::size_t cells = static_cast<std::size_t>(columns * count);
        for (std::size_t i = 0; i < cells; ++i) {
            const double above = a[i] - b[i];
            volume.cut += std::max(above, 0.0);
            volume.fill += std::max(-above, 0.0);
        }
    }
    volume.cut *= cell * cell;
    volume.fill *= cell * cell;
    return volume;
}

core::Volume between(const core::Tin& tin, const std::vector<core::TriangleId>& triangles,
                     const core::Tin& other) {
    const auto volume = core::volume_between(tin, triangles, other);
    if (!volume) throw std::runtime_error(volume.errors()[0].detail);
    return *volume;
}

struct Versions {
    core::Tin before;
    core::Tin after;
    Box changed;
};

/// The lake's outline is bent to one level, with the ground around it.
Versions versions() {
    auto tin = core::build_tin(cgal::bundled_terrain());
    if (!tin) throw std::runtime_error(tin.errors()[0].detail);
    Versions made{*tin, *tin, {}};
    core::Shape lake = cgal::bundled_shape("lake");
    for (core::Path& path : lake.paths)
        path.elevations.assign(path.points.size(), 330.0);
    if (const auto report = core::integrate(made.after, {&lake, 1}, {}); !report)
        throw std::runtime_error(report.errors()[0].detail);
    constexpr double kAround = 150.0;  // what moves with the outline
    for (const core::Path& path : lake.paths) {
        for (const core::Point2 p : path.points) {
            Box& box = made.changed;
            box.low = {std::min(box.low.x, p.x - kAround), std::min(box.low.y, p.y - kAround)};
            box.high = {std::max(box.high.x, p.x + kAround), std::max(box.high.y, p.y + kAround)};
        }
    }
    return made;
}

std::vector<core::TriangleId> triangles_in(const core::Tin& tin, const Box& box) {
    std::vector<core::TriangleId> found;
    for (const core::TriangleId t : core::all_triangles(tin)) {
        Box of;
        for (const core::VertexId v : tin.triangle(t).vertices) {
            const core::Point2 p = tin.plan(v);
            of.low = {std::min(of.low.x, p.x), std::min(of.low.y, p.y)};
            of.high = {std::max(of.high.x, p.x), std::max(of.high.y, p.y)};
        }
        if (of.low.x <= box.high.x && of.high.x >= box.low.x && of.low.y <= box.high.y &&
            of.high.y >= box.low.y)
            found.push_back(t);
    }
    return found;
}

/// What is under a surface, down to sea level: by prisms, without any overlay.
double under(const core::Tin& tin) {
    const core::Volume volume =
        core::volume_against(tin, core::all_triangles(tin), core::level_plane(0.0));
    return volume.cut - volume.fill;
}

int compare(double cell, int runs) {
    GDALAllRegister();
    const Versions made = versions();
    const std::vector<core::TriangleId> part = triangles_in(made.after, made.changed);
    const Dataset after = raster_of(made.after, made.changed, cell);
    const Dataset before = raster_of(made.before, made.changed, cell);
    core::Volume exact, sampled;
    const auto timed = [](core::Volume& volume, auto call) -> Side {
        return [&volume, call] {
            const double start = now_ms();
            volume = call();
            return now_ms() - start;
        };
    };
    const Turns turns =
        take_turns({timed(exact, [&] { return between(made.after, part, made.before); }),
                    timed(sampled, [&] { return difference(after, before, cell); })},
                   runs);
    std::printf(
        "%zu triangles, %d by %d cells\n\n"
        "| | cut | fill | ms |\n|---|--:|--:|--:|\n| Tinsmith | %.3f | %.3f | %s |\n"
        "| GDAL | %.3f | %.3f | %s |\n\nTinsmith / GDAL %s\n",
        part.size(), GDALGetRasterXSize(after.get()), GDALGetRasterYSize(after.get()), exact.cut,
        exact.fill, milliseconds(turns[0]).c_str(), sampled.cut, sampled.fill,
        milliseconds(turns[1]).c_str(), ratio(turns[0], turns[1]).c_str());

    const double start = now_ms();
    const core::Volume whole = between(made.after, core::all_triangles(made.after), made.before);
    const double ms = now_ms() - start;
    const double net = whole.cut - whole.fill, by_prisms = under(made.after) - under(made.before);
    std::printf(
        "The whole terrain, Tinsmith alone: cut %.6f, fill %.6f in %.1f ms; cut less fill differs "
        "from what is under the two by %.1e, of %.3e under one of them\n",
        whole.cut, whole.fill, ms, std::fabs(net - by_prisms), under(made.before));
    const bool agrees = std::fabs(exact.fill + exact.cut - sampled.fill - sampled.cut) <
                        0.01 * (exact.fill + exact.cut);
    return agrees && exact.cut + exact.fill > 1.0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

int run(const std::string& part, int runs) {
    if (part == "smoke") return compare(8.0, 1);
    if (part == "lake") return compare(1.0, runs);
    std::fputs(kUsage, stderr);
    return 2;
}

}  // namespace
}  // namespace tinsmith::bench

int main(int count, char** arguments) {
    return tinsmith::bench::run_program("volume_bench", count, arguments, 15, tinsmith::bench::run);
}
