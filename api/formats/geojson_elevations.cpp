// SPDX-License-Identifier: Apache-2.0
#include "api/formats/geojson_elevations.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "api/formats/json_reader_values.hpp"

namespace tinsmith::api {

namespace {

using core::Point2;

/// Looks at one shape's paths, each with the position that closes it where it is a ring.
class ElevationCheck {
  public:
    ElevationCheck(const RequestedShape& shape, std::size_t most, Faults& faults)
        : shape_(shape), most_(most), faults_(faults) {}

    void run() {
        for (std::size_t p = 0; p < shape_.shape.paths.size() && !full(); ++p) {
            const core::Path& path = shape_.shape.paths[p];
            const std::size_t count = path.points.size() + (path.closed ? 1 : 0);
            for (std::size_t i = 0; i < count && !full(); ++i)
                check(p, i);
        }
    }

  private:
    void check(std::size_t p, std::size_t i) {
        const core::Path& path = shape_.shape.paths[p];
        const double z = elevation(p, i);
        if (std::isnan(z)) {
            fault("ELEVATION_MISSING",
                  "With elevation=own every position is three numbers, [x, y, z]; this one has no "
                  "elevation.",
                  p, i);
        } else if (!json::acceptable_coordinate(z)) {
            fault("COORDINATE_OUT_OF_RANGE", json::coordinate_out_of_range(), p, i);
            faults_.back().pointer += "/2";
        } else if (i == path.points.size() && differs(z, elevation(p, 0))) {
            fault("RING_NOT_CLOSED",
                  "The last position of a ring is the same as its first, in elevation too.", p, i);
        } else if (i > 0 && point(p, i) == point(p, i - 1) && differs(z, elevation(p, i - 1))) {
            fault("ELEVATION_REPEATED",
                  "The position before has this place and another elevation; a terrain has one "
                  "for each place.",
                  p, i);
        }
    }

    /// False also where one of them is missing, which is told by itself.
    static bool differs(double a, double b) { return a < b || a > b; }

    double elevation(std::size_t p, std::size_t i) const {
        const core::Path& path = shape_.shape.paths[p];
        if (i == path.points.size()) return shape_.closing_elevations[p];
        return path.elevations.empty() ? std::nan("") : path.elevations[i];
    }

    Point2 point(std::size_t p, std::size_t i) const {
        const auto& points = shape_.shape.paths[p].points;
        return points[i % points.size()];
    }

    bool full() const { return faults_.size() >= most_; }

    void fault(std::string code, std::string detail, std::size_t p, std::size_t i) {
        Fault made{std::move(code), std::move(detail), coordinate_pointer(shape_, p, i)};
        made.coordinate = {point(p, i).x, point(p, i).y};
        faults_.push_back(std::move(made));
    }

    const RequestedShape& shape_;
    const std::size_t most_;
    Faults& faults_;
};

}  // namespace

Faults elevation_faults(std::span<const RequestedShape> shapes, std::size_t most) {
    Faults faults;
    for (const RequestedShape& shape : shapes)
        ElevationCheck(shape, most, faults).run();
    return faults;
}

void drop_elevations(std::span<RequestedShape> shapes) {
    for (RequestedShape& shape : shapes) {
        shape.closing_elevations = std::vector<double>();
        for (core::Path& path : shape.shape.paths)
            path.elevations = std::vector<double>();  // {} would keep the memory
    }
}

}  // namespace tinsmith::api
