// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "api/formats/gltf.hpp"

namespace tinsmith::api {

/// A position or direction of the session (z up) in the file's axes. Counter-clockwise seen from
/// above stays so: both are rotations.
template <typename T>
std::array<T, 3> to_axes(const std::array<T, 3>& v, UpAxis up) {
    if (up == UpAxis::Z) return v;
    return {v[0], v[2], T{0} - v[1]};  // 0 - 0 is 0, where -0 would be minus zero
}

}  // namespace tinsmith::api
