// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "api/formats/csv_line.hpp"
#include "api/formats/fault_log.hpp"

namespace tinsmith::api::csv {

/// Which fields of a line are x, y and z.
struct Columns {
    std::array<std::size_t, 3> field{0, 1, 2};
    std::size_t count = 3;   ///< fields that each line has
    bool are_named = false;  ///< by a header: others are passed over
};

/// What becomes of columns in degrees.
enum class Degrees {
    Taken,
    WithoutSystem,  ///< refused: it is not said that the points are in degrees, and in which
    WithoutPlan,    ///< refused: it is not said where to bring them
};

/// By the names in a header: x, east(ing), e; y, north(ing), n; z, height, elev(ation), alt(itude),
/// h; in any case and order, with or without a unit in brackets or after a comma. Longitude (lon,
/// long, lng) and latitude (lat) are x and y where degrees are taken. Where a coordinate has no
/// column, or two, or columns are degrees and those are not taken, the faults say so and there is
/// nothing.
std::optional<Columns> columns_named(const std::vector<Field>& names, std::size_t line,
                                     Degrees degrees, FaultLog& faults);

/// "Line 3, column 7: " for the beginning of a detail.
std::string at(std::size_t line, std::size_t column);

}  // namespace tinsmith::api::csv
