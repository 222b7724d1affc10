// SPDX-License-Identifier: Apache-2.0
#include "api/formats/csv_columns.hpp"

#include <algorithm>
#include <cctype>
#include <string>

namespace tinsmith::api::csv {

namespace {

constexpr std::string_view kAxes = "xyz";
constexpr std::array<std::string_view, 3> kNames = {" x e east easting ", " y n north northing ",
                                                    " z h height elev elevation alt altitude "};
constexpr std::array<std::string_view, 3> kKnown = {
    "x, e, east or easting", "y, n, north or northing",
    "z, h, height, elev, elevation, alt or altitude"};
constexpr std::string_view kDegrees = " lon long longitude lng lat latitude ";

/// Small letters, and without a unit: "Easting (m)" is "easting".
std::string plain_name(std::string_view name) {
    name = trimmed(name.substr(0, name.find_first_of("([,")));
    std::string out(name);
    for (char& c : out)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

bool is_among(std::string_view names, const std::string& name) {
    return !name.empty() && name.find(' ') == name.npos &&
           names.find(" " + name + " ") != names.npos;
}

}  // namespace

std::string at(std::size_t line, std::size_t column) {
    return "Line " + std::to_string(line) + ", column " + std::to_string(column) + ": ";
}

std::optional<Columns> columns_named(const std::vector<Field>& names, std::size_t line,
                                     FaultLog& faults) {
    Columns columns;
    columns.count = names.size();
    columns.are_named = true;
    std::array<bool, 3> found{};
    const std::size_t before = faults.size();
    if (names.size() >= kMostFields) {
        faults.add(FaultKind::TooLarge,
                   {"TOO_MANY_COLUMNS",
                    at(line, names.back().column) + "A header names fewer than " +
                        std::to_string(kMostFields) + " columns.",
                    {}});
        return std::nullopt;
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
        const std::string name = plain_name(names[i].text);
        const std::string here = at(line, names[i].column);
        if (is_among(kDegrees, name)) {
            faults.add(FaultKind::Unsupported,
                       {"CRS_GEOGRAPHIC",
                        here + shown(names[i].text) +
                            " is in degrees; project the points to metres first.",
                        {}});
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!is_among(kNames[axis], name)) continue;
            if (found[axis]) {
                faults.add(FaultKind::Invalid,
                           {"COLUMN_REPEATED",
                            here + shown(names[i].text) + " is a second column for " + kAxes[axis] +
                                "; name one only.",
                            {}});
            }
            found[axis] = true;
            columns.field[axis] = i;
        }
    }
    if (faults.size() == before) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (found[axis]) continue;
            faults.add(FaultKind::Invalid,
                       {"COLUMN_MISSING",
                        at(line, 1) + "No column of the header is " + kAxes[axis] + "; call it " +
                            std::string(kKnown[axis]) + ".",
                        {}});
        }
    }
    if (faults.size() > before) return std::nullopt;
    return columns;
}

}  // namespace tinsmith::api::csv
