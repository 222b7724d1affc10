// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "api/formats/json_reader_values.hpp"
#include "core/edit/plane.hpp"

namespace tinsmith::api::json {

/// The members by which an object names a plane, one way or another: "elevation"; "plane" of three
/// points; or "slope", "azimuth" and "point".
class PlaneMembers {
  public:
    std::vector<Member> members();

    // Requires, of each: the object expects these members, and has ended.

    /// How many ways of naming one it takes.
    int count(const Object& object) const;
    /// Faults of a slope that lacks one of its three.
    void check(Reader& reader, const Object& object) const;
    /// The plane, or a fault and nothing. Requires: a count of one and no fault in the members.
    std::optional<core::Plane> take(Reader& reader, const Object& object) const;

  private:
    static bool is_sloping(const Object& object);

    Number elevation_, slope_, azimuth_;
    TupleList<3> plane_{"a point [x, y, z]", "an array of three points [x, y, z]", 3};
    Tuple point_{3, Tuple::Items::Coordinate, "a point [x, y, z]"};
};

}  // namespace tinsmith::api::json
