// SPDX-License-Identifier: Apache-2.0
#include "api/formats/geojson_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "api/formats/json_reader.hpp"

namespace tinsmith::api {

namespace {

using core::Point2;
using json::pointer_to;

struct TypeRow {
    GeometryType type;
    std::string_view name;
    std::size_t depth;  ///< of its positions, in the sense of Coordinates
};

constexpr std::array<TypeRow, 6> kTypes{{
    {GeometryType::Point, "Point", 1},
    {GeometryType::MultiPoint, "MultiPoint", 2},
    {GeometryType::LineString, "LineString", 2},
    {GeometryType::MultiLineString, "MultiLineString", 3},
    {GeometryType::Polygon, "Polygon", 3},
    {GeometryType::MultiPolygon, "MultiPolygon", 4},
}};

const TypeRow& row_of(GeometryType type) {
    return *std::find_if(kTypes.begin(), kTypes.end(),
                         [&](const TypeRow& row) { return row.type == type; });
}

bool is_polygonal(GeometryType type) {
    return type == GeometryType::Polygon || type == GeometryType::MultiPolygon;
}

/// How many different positions there are, counted up to `most`, which is 3 at most. Ends at the
/// last of those, so a long ring costs no more than a short one unless it stays in one place.
std::size_t distinct(std::span<const Point2> points, std::size_t most) {
    std::size_t found = 0;
    std::array<Point2, 3> seen{};
    for (const Point2& point : points) {
        const auto end = seen.begin() + static_cast<std::ptrdiff_t>(found);
        if (std::find(seen.begin(), end, point) != end) continue;
        seen[found++] = point;
        if (found == most) break;
    }
    return found;
}

class ShapeMaker {
  public:
    ShapeMaker(GeometryType type, Coordinates& coordinates, std::string pointer, FaultLog& log)
        : coordinates_(coordinates), log_(log) {
        made_.type = type;
        made_.pointer = std::move(pointer);
    }

    RequestedShape make() {
        if (nesting_fits()) {
            const std::size_t depth = row_of(made_.type).depth;
            if (depth == 1 || made_.type == GeometryType::MultiPoint) {
                take_points();
            } else {
                if (made_.type == GeometryType::MultiPolygon) take_polygons();
                take_lines(coordinates_.arrays[depth - 2]);
            }
        }
        coordinates_.clear();
        return std::move(made_);
    }

  private:
    void fault(std::string code, std::string detail, std::string pointer,
               const Point2* at = nullptr) {
        Fault made{std::move(code), std::move(detail), std::move(pointer)};
        if (at != nullptr) made.coordinate = {at->x, at->y};
        log_.add(FaultKind::Invalid, std::move(made));
    }

    std::string place() const { return pointer_to(made_.pointer, "coordinates"); }

    bool nesting_fits() {
        if (!coordinates_.sound) return false;  // told while it was read
        const TypeRow& row = row_of(made_.type);
        const auto& arrays = coordinates_.arrays;
        // Without positions there may still be rings or lines, whose fault is to be too short.
        const bool has_lines = row.depth > 1 && row.type != GeometryType::MultiPoint &&
                               !arrays[row.depth - 2].empty() && arrays[row.depth - 1].empty();
        if (coordinates_.depth == 0 && !has_lines) {
            fault("SHAPE_EMPTY", "This geometry has no position.", place());
            return false;
        }
        if (coordinates_.depth != 0 && coordinates_.depth != row.depth) {
            fault("COORDINATES_NESTING",
                  "The positions of a " + std::string(row.name) + " lie in " +
                      std::to_string(row.depth - 1) + " arrays; here they lie in " +
                      std::to_string(coordinates_.depth - 1) + ".",
                  place());
            return false;
        }
        return true;
    }

    void take_points() {
        const std::vector<Point2>& positions = coordinates_.positions;
        made_.shape.paths.reserve(positions.size());
        for (std::size_t i = 0; i < positions.size(); ++i) {
            made_.shape.paths.push_back({{positions[i]}, false, elevations_of(i, 1)});
        }
    }

    /// Of so many positions; empty where none of them has one.
    std::vector<double> elevations_of(std::size_t begin, std::size_t count) const {
        if (coordinates_.elevations.empty()) return {};
        const auto first = coordinates_.elevations.begin() + static_cast<std::ptrdiff_t>(begin);
        const auto last = first + static_cast<std::ptrdiff_t>(count);
        if (std::all_of(first, last, [](double z) { return std::isnan(z); })) return {};
        return {first, last};
    }

    /// Of the position before `end`; NaN where it has none.
    double closing_elevation(std::size_t end) const {
        if (coordinates_.elevations.empty() || end == 0)
            return std::numeric_limits<double>::quiet_NaN();
        return coordinates_.elevations[end - 1];
    }

    void take_polygons() {
        const auto& polygons = coordinates_.arrays[1];
        const std::size_t rings = coordinates_.arrays[2].size();
        for (std::size_t i = 0; i < polygons.size(); ++i) {
            made_.polygon_starts.push_back(polygons[i].array);
            const std::size_t end = i + 1 < polygons.size() ? polygons[i + 1].array : rings;
            if (polygons[i].array < end) continue;
            fault("SHAPE_EMPTY", "This polygon has no ring.", pointer_to(place(), i));
        }
    }

    void take_lines(const std::vector<Coordinates::Start>& lines) {
        const std::vector<Point2>& positions = coordinates_.positions;
        made_.shape.paths.reserve(lines.size());
        for (std::size_t i = 0; i < lines.size(); ++i) {
            const std::size_t begin = lines[i].position;
            const std::size_t end = i + 1 < lines.size() ? lines[i + 1].position : positions.size();
            const std::span line(positions.data() + begin, end - begin);
            // A position at fault was told; whether its line is right cannot be said.
            const bool known = std::none_of(line.begin(), line.end(),
                                            [](const Point2& p) { return std::isnan(p.x); });
            core::Path path =
                is_polygonal(made_.type) ? ring(i, line, known) : open_line(i, line, known);
            path.elevations = elevations_of(begin, path.points.size());
            if (path.closed) made_.closing_elevations.push_back(closing_elevation(end));
            made_.shape.paths.push_back(std::move(path));
        }
    }

    core::Path open_line(std::size_t path, std::span<const Point2> line, bool known) {
        if (known && distinct(line, 2) < 2) {
            fault("LINE_TOO_SHORT", "A line needs two different positions.",
                  path_pointer(made_, path), line.empty() ? nullptr : &line.front());
        }
        return {{line.begin(), line.end()}, false, {}};
    }

    core::Path ring(std::size_t path, std::span<const Point2> line, bool known) {
        if (!known) return {};
        const Point2* const first = line.empty() ? nullptr : &line.front();
        if (line.size() < 4 || distinct(line, 3) < 3) {
            fault("RING_TOO_SHORT",
                  "A ring needs four positions, the last the same as the first, and three that "
                  "differ.",
                  path_pointer(made_, path), first);
        } else if (line.front() != line.back()) {
            fault("RING_NOT_CLOSED", "The last position of a ring is the same as its first.",
                  pointer_to(path_pointer(made_, path), line.size() - 1), &line.back());
        } else {
            line = line.first(line.size() - 1);
        }
        return {{line.begin(), line.end()}, true, {}};
    }

    Coordinates& coordinates_;
    FaultLog& log_;
    RequestedShape made_;
};

}  // namespace

std::string_view geometry_name(GeometryType type) {
    return row_of(type).name;
}

std::optional<GeometryType> geometry_type(std::string_view name) {
    for (const TypeRow& row : kTypes) {
        if (row.name == name) return row.type;
    }
    return std::nullopt;
}

std::string path_pointer(const RequestedShape& shape, std::size_t path) {
    std::string base = pointer_to(shape.pointer, "coordinates");
    switch (shape.type) {
        case GeometryType::Point:
        case GeometryType::LineString:
            return base;
        case GeometryType::MultiPoint:
        case GeometryType::MultiLineString:
        case GeometryType::Polygon:
            return pointer_to(base, path);
        case GeometryType::MultiPolygon:
            break;
    }
    const auto& starts = shape.polygon_starts;
    // The last polygon that begins at or before the path; one without rings begins where the next
    // one does and is passed by.
    const auto after = std::upper_bound(starts.begin(), starts.end(), path);
    const auto polygon = static_cast<std::size_t>(after - starts.begin()) - 1;
    return pointer_to(pointer_to(base, polygon), path - starts[polygon]);
}

std::string coordinate_pointer(const RequestedShape& shape, std::size_t path, std::size_t point) {
    const bool is_point =
        shape.type == GeometryType::Point || shape.type == GeometryType::MultiPoint;
    return is_point ? path_pointer(shape, path) : pointer_to(path_pointer(shape, path), point);
}

RequestedShape make_shape(GeometryType type, Coordinates& coordinates, std::string pointer,
                          FaultLog& log) {
    return ShapeMaker(type, coordinates, std::move(pointer), log).make();
}

}  // namespace tinsmith::api
