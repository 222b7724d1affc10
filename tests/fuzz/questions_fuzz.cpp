// SPDX-License-Identifier: Apache-2.0
// Any bytes as the body of each question: the reader answers with a value or with faults, in
// bounded memory; what it read is fit to be asked.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <variant>

#include "api/formats/questions_json.hpp"

namespace {

using namespace tinsmith;

void require(bool holds) {
    if (!holds) std::abort();
}

template <typename T>
bool is_read(const api::Parsed<T>& parsed, const api::ReadLimits& limits) {
    if (parsed) return true;
    require(!parsed.faults().empty() && parsed.faults().size() <= limits.max_faults);
    return false;
}

void require_finite(core::Point2 p) {
    require(std::isfinite(p.x) && std::isfinite(p.y));
}

void ask_points(std::string_view body, const api::ReadLimits& limits) {
    const auto points = api::read_points(body, limits);
    if (!is_read(points, limits)) return;
    require(points->size() <= limits.max_polygon_vertices);
    for (const core::Point2 p : *points)
        require_finite(p);
}

void ask_profile(std::string_view body, const api::ReadLimits& limits) {
    const auto line = api::read_line(body, limits);
    if (!is_read(line, limits)) return;
    require(line->shapes.size() == 1 && line->shapes.front().shape.paths.size() == 1);
    const auto& points = line->shapes.front().shape.paths.front().points;
    require(points.size() >= 2);
    for (const core::Point2 p : points)
        require_finite(p);
}

void ask_volume(std::string_view body, const api::ReadLimits& limits) {
    const auto asked = api::read_volume_request(body, limits);
    if (!is_read(asked, limits)) return;
    require(!asked->shape || asked->polygon_id.empty());
    const auto* plane = std::get_if<core::Plane>(&asked->against);
    if (plane != nullptr) require_finite({plane->at.x, plane->at.y});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    api::ReadLimits limits;
    limits.max_polygon_vertices = 10'000;
    const std::string_view body{reinterpret_cast<const char*>(data), size};
    ask_points(body, limits);
    ask_profile(body, limits);
    ask_volume(body, limits);
    return 0;
}
