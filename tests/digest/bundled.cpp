// SPDX-License-Identifier: Apache-2.0
#include "tests/digest/bundled.hpp"

#include <charconv>
#include <fstream>
#include <iterator>
#include <string_view>

namespace tinsmith::digest {

namespace {

/// What the bundled files hold, no more: one feature, its positions as pairs of numbers. The api's
/// own reader would bring its library along, and this program is built by compilers of its own.
core::Shape read_coordinates(std::string_view text) {
    core::Shape shape;
    const bool closed = text.find("\"Polygon\"") != std::string_view::npos;
    const std::size_t start = text.find("\"coordinates\"");
    if (start == std::string_view::npos) return shape;
    core::Path path;
    path.closed = closed;
    std::vector<double> numbers;
    const char* const end = text.data() + text.size();
    for (const char* at = text.data() + start; at < end;) {
        double number = 0.0;
        const auto [next, fault] = std::from_chars(at, end, number);
        if (fault == std::errc{}) {
            numbers.push_back(number);
            at = next;
            continue;
        }
        if (*at == ']' && numbers.size() >= 2) {
            path.points.push_back({numbers[0], numbers[1]});
            numbers.clear();
        } else if (*at == ']' && !path.points.empty()) {
            if (closed) path.points.pop_back();  // GeoJSON repeats the first
            shape.paths.push_back(path);
            path.points.clear();
        } else if (*at == '}') {
            break;
        }
        ++at;
    }
    return shape;
}

}  // namespace

std::vector<core::Shape> read_bundled(const std::string& folder) {
    std::vector<core::Shape> shapes;
    for (const char* name : {"contour_3500", "contour_450", "lake", "leaving", "parcel", "road"}) {
        std::ifstream in(folder + "/" + name + ".geojson");
        const std::string text{std::istreambuf_iterator<char>(in), {}};
        shapes.push_back(read_coordinates(text));
        if (shapes.back().paths.empty()) return {};
    }
    return shapes;
}

}  // namespace tinsmith::digest
