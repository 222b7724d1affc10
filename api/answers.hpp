// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/formats/questions_json.hpp"
#include "core/edit/profile.hpp"
#include "core/edit/spot.hpp"
#include "core/edit/volume.hpp"
#include "core/types/point.hpp"

namespace tinsmith::api {

/// Whose surface an answer is about. Lengths are in `unit`, areas in its square, volumes in its
/// cube.
struct AnswerHead {
    std::string_view session;
    std::uint64_t version = 0;
    std::string_view unit;
};

struct VolumeView {
    AnswerHead head;
    core::Volume volume;
    double area_left_out = 0.0;  ///< of what was asked for, where one of the surfaces is not
    std::string_view polygon;    ///< id; empty: none of the session's
    const Against& against;
    std::uint64_t other_version = 0;  ///< where `against` is a surface with versions
};

/// All bodies are JSON texts that end with a newline. Numbers read back to the same double.
std::string write_elevation(const AnswerHead& head, core::Point2 at, const core::Spot& spot,
                            std::span<const std::string> polygons);
/// One entry for each point asked for; null and a reason where that is outside the mesh. `brought`:
/// where the points lie in the session's system, one for each, or none to leave that out.
std::string write_elevations(const AnswerHead& head,
                             std::span<const std::optional<core::Spot>> spots,
                             std::span<const core::Point2> brought = {});
std::string write_profile(const AnswerHead& head, const core::Profile& profile);
std::string write_volume(const VolumeView& view);

}  // namespace tinsmith::api
