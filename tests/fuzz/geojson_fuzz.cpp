// SPDX-License-Identifier: Apache-2.0
// Any bytes: the reader answers with a value or with faults, in bounded memory; what it read is fit
// to be draped, and to bring its own elevations unless it is told why not.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "api/formats/geojson.hpp"
#include "api/formats/geojson_elevations.hpp"

namespace {

using tinsmith::api::RequestedShape;

void require(bool holds) {
    if (!holds) std::abort();
}

/// Every path has so many elevations for each point, 0 or 1, all of them numbers.
void require_elevations(const std::vector<RequestedShape>& shapes, std::size_t each) {
    for (const RequestedShape& shape : shapes) {
        for (const auto& path : shape.shape.paths) {
            require(path.elevations.size() == each * path.points.size());
            for (const double z : path.elevations)
                require(std::isfinite(z));
        }
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    tinsmith::api::ReadLimits limits;
    limits.max_vertices = 10'000;
    limits.max_triangles = 20'000;
    limits.max_polygon_vertices = 10'000;
    auto parsed = tinsmith::api::read_geojson({reinterpret_cast<const char*>(data), size}, limits);
    if (!parsed) {
        require(!parsed.faults().empty() && parsed.faults().size() <= limits.max_faults);
        return 0;
    }
    const auto faults = tinsmith::api::elevation_faults(parsed->shapes, limits.max_faults);
    require(faults.size() <= limits.max_faults);
    if (faults.empty()) require_elevations(parsed->shapes, 1);
    tinsmith::api::drop_elevations(parsed->shapes);
    require_elevations(parsed->shapes, 0);
    return 0;
}
