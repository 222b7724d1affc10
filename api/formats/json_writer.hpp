// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "core/types/point.hpp"

/// Numbers of large answers, appended to a text with no document tree in between.
namespace tinsmith::api::json {

/// Appends a number as the shortest text that reads back to the same value.
/// Requires: finite.
template <typename Number>
void append_number(std::string& out, Number value) {
    std::array<char, 32> digits{};
    const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    out.append(digits.data(), end);
}

/// "-0" would be read as the whole number nought, which has no sign.
inline void append_coordinate(std::string& out, double value) {
    if (value == 0.0 && std::signbit(value)) {
        out += "-0.0";
    } else {
        append_number(out, value);
    }
}

/// [x,y,z]
inline void append_position(std::string& out, const core::Point3& p) {
    out.push_back('[');
    append_coordinate(out, p.x);
    out.push_back(',');
    append_coordinate(out, p.y);
    out.push_back(',');
    append_coordinate(out, p.z);
    out.push_back(']');
}

/// One element after the other, in brackets; `append` takes the text and the element.
template <typename Range, typename Append>
void append_array(std::string& out, const Range& range, Append append) {
    out.push_back('[');
    bool first = true;
    for (const auto& element : range) {
        if (!first) out.push_back(',');
        first = false;
        append(out, element);
    }
    out.push_back(']');
}

/// [a,b]
template <typename Number>
void append_pair(std::string& out, const std::array<Number, 2>& pair) {
    append_array(out, pair, append_number<Number>);
}

}  // namespace tinsmith::api::json
