// SPDX-License-Identifier: Apache-2.0
// Time to integrate a bundled polygon into the bundled terrain, as the report gives it: the median
// and the least of many runs, each on a fresh copy of the mesh. One thread.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "api/formats/geojson.hpp"
#include "api/formats/geotiff.hpp"
#include "api/formats/grid_mesh.hpp"
#include "core/integrate/integrator.hpp"
#include "core/mesh/build.hpp"

namespace {

std::string read_data(const std::string& name) {
    std::ifstream in(std::string(TINSMITH_SOURCE_DIR) + "/tests/data/" + name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

double now_ms() {
    using namespace std::chrono;
    return duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

}  // namespace

int main() {
    using namespace tinsmith;
    const auto terrain = api::meshed(api::read_geotiff(read_data("jacksboro.tif"), {}), {});
    if (!terrain) return 1;
    auto built = core::build_tin(terrain->mesh);
    if (!built) return 1;
    std::printf("%zu triangles\n%-14s %10s %10s %10s %12s\n", built->triangle_count(), "polygon",
                "crossings", "median ms", "least ms", "ns/crossing");
    for (const char* name : {"parcel", "lake", "road", "contour_450", "contour_3500"}) {
        const auto request = api::read_geojson(read_data(std::string(name) + ".geojson"), {});
        if (!request) return 1;
        std::vector<core::Shape> shapes;
        for (const auto& requested : request->shapes)
            shapes.push_back(requested.shape);
        core::IntegrateOptions options;
        options.clock_ms = now_ms;
        std::vector<double> times;
        std::uint64_t vertices = 0;
        for (int run = 0; run < 21; ++run) {
            core::Tin tin = *built;
            const auto report = core::integrate(tin, shapes, options);
            if (!report) return 1;
            const core::StageTimes& t = report->time_ms;
            times.push_back(t.locate + t.integrate + t.improve);
            vertices = report->shapes[0].vertices_added;
        }
        std::sort(times.begin(), times.end());
        const double median = times[times.size() / 2];
        std::printf("%-14s %10llu %10.3f %10.3f %12.0f\n", name,
                    static_cast<unsigned long long>(vertices), median, times.front(),
                    median * 1e6 / static_cast<double>(vertices));
    }
}
