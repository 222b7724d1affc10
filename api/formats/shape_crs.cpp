// SPDX-License-Identifier: Apache-2.0
#include "api/formats/shape_crs.hpp"

#include <optional>
#include <utility>
#include <variant>

#include "api/crs.hpp"
#include "api/formats/json_reader.hpp"
#include "api/projection.hpp"

namespace tinsmith::api {

namespace {

using Wanted = std::optional<Transformation>;

/// How to get from the claim to the terrain, nothing where there is nothing to do; or why not.
std::variant<Wanted, Fault> transformation(const std::string& terrain_crs, const CrsClaim& claim) {
    if (claim.crs.empty() || same_crs(claim.crs, terrain_crs)) return Wanted();
    const auto refuse = [&](std::string code, std::string detail) {
        Fault fault{std::move(code), std::move(detail), claim.pointer};
        if (claim.pointer.empty()) fault.parameter = "crs";
        return fault;
    };
    if (terrain_crs.empty()) {
        return refuse("CRS_MISMATCH",
                      "The positions are said to be in " + claim.crs +
                          ", and the terrain is in no named system: there is nothing to bring them "
                          "to. Make the session with its crs, or leave crs out if the numbers are "
                          "the terrain's.");
    }
    auto made = Transformation::between(claim.crs, terrain_crs);
    if (auto* no = std::get_if<NoPlace>(&made))
        return refuse(std::move(no->code), std::move(no->detail));
    auto& found = std::get<Transformation>(made);
    if (claim.heights && found.from().has_height) {
        return refuse("CRS_VERTICAL",
                      crs_with_name(found.from()) +
                          " says what elevations mean, and those are not brought over: they are "
                          "taken to be in the terrain's unit and above its zero. Bring them there, "
                          "and name the system of the plan.");
    }
    return Wanted(std::move(found));
}

/// Takes position by position over, and keeps what is wrong.
class Mover {
  public:
    Mover(const Transformation& transformation, std::size_t most)
        : transformation_(transformation), most_(most) {}

    /// `place` tells the pointer of a position at fault.
    template <typename Place>
    void move(core::Point2& position, Place place) {
        if (faults_.size() >= most_) return;
        auto there = transformation_(position);
        if (const auto* point = std::get_if<core::Point2>(&there)) {
            position = *point;
            return;
        }
        auto& no = std::get<NoPlace>(there);
        Fault fault{std::move(no.code), std::move(no.detail), place()};
        fault.coordinate = {position.x, position.y};
        faults_.push_back(std::move(fault));
    }
    Faults take() && { return std::move(faults_); }

  private:
    const Transformation& transformation_;
    std::size_t most_;
    Faults faults_;
};

}  // namespace

Faults bring_into(const std::string& terrain_crs, const CrsClaim& claim,
                  std::span<core::Shape> shapes, std::span<const RequestedShape> requested,
                  std::size_t most) {
    auto wanted = transformation(terrain_crs, claim);
    if (auto* fault = std::get_if<Fault>(&wanted)) return {std::move(*fault)};
    const Wanted& way = std::get<Wanted>(wanted);
    if (!way) return {};
    Mover mover(*way, most);
    for (std::size_t s = 0; s < shapes.size(); ++s) {
        for (std::size_t p = 0; p < shapes[s].paths.size(); ++p) {
            auto& points = shapes[s].paths[p].points;
            for (std::size_t i = 0; i < points.size(); ++i)
                mover.move(points[i], [&] { return coordinate_pointer(requested[s], p, i); });
        }
    }
    return std::move(mover).take();
}

Faults bring_into(const std::string& terrain_crs, const CrsClaim& claim,
                  std::span<core::Point2> positions, const std::string& pointer, std::size_t most) {
    auto wanted = transformation(terrain_crs, claim);
    if (auto* fault = std::get_if<Fault>(&wanted)) return {std::move(*fault)};
    const Wanted& way = std::get<Wanted>(wanted);
    if (!way) return {};
    Mover mover(*way, most);
    for (std::size_t i = 0; i < positions.size(); ++i)
        mover.move(positions[i], [&] { return json::pointer_to(pointer, i); });
    return std::move(mover).take();
}

}  // namespace tinsmith::api
