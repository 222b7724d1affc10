// SPDX-License-Identifier: Apache-2.0
#include "api/formats/plane_members.hpp"

#include <string>
#include <utility>

namespace tinsmith::api::json {

namespace {

core::Point3 point_of(const std::array<double, Tuple::kMost>& numbers) {
    return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace

std::vector<Member> PlaneMembers::members() {
    return {{"elevation", &elevation_},
            {"plane", &plane_},
            {"slope", &slope_},
            {"azimuth", &azimuth_},
            {"point", &point_}};
}

bool PlaneMembers::is_sloping(const Object& object) {
    return object.has("slope") || object.has("azimuth") || object.has("point");
}

int PlaneMembers::count(const Object& object) const {
    return object.has("elevation") + object.has("plane") + static_cast<int>(is_sloping(object));
}

void PlaneMembers::check(Reader& reader, const Object& object) const {
    for (const std::string_view name : {"slope", "azimuth", "point"}) {
        if (is_sloping(object) && !object.has(name)) {
            reader.fault("MEMBER_MISSING", quoted(name) +
                                               " is needed with the other two of slope, azimuth "
                                               "and point.");
        }
    }
}

std::optional<core::Plane> PlaneMembers::take(Reader& reader, const Object& object) const {
    if (object.has("elevation")) return core::level_plane(elevation_.number());
    if (is_sloping(object)) {
        return core::sloping_plane(slope_.number(), azimuth_.number(), point_of(point_.numbers()));
    }
    const auto& points = plane_.items();
    const auto refuse = [&](std::string code, std::string detail) {
        reader.add(FaultKind::Invalid,
                   {std::move(code), std::move(detail), pointer_to(reader.pointer(), "plane")});
        return std::nullopt;
    };
    if (points.size() != 3) {
        return refuse("WRONG_LENGTH", "A plane is given by three points [x, y, z]; here are " +
                                          std::to_string(points.size()) + ".");
    }
    auto plane = core::plane_through(point_of(points[0]), point_of(points[1]), point_of(points[2]));
    if (plane) return plane;
    return refuse("PLANE_UPRIGHT",
                  "The three points are in one line in plan: no plane that has one elevation at "
                  "each position goes through them. Move one.");
}

}  // namespace tinsmith::api::json
