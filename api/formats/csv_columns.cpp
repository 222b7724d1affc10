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
/// Of longitude and latitude.
constexpr std::array<std::string_view, 2> kDegrees = {" lon long longitude lng ", " lat latitude "};

std::string what_degrees_need(Degrees degrees) {
    if (degrees == Degrees::WithoutPlan)
        return " is in degrees, and a terrain needs a plan: add project=auto (the UTM zone of its "
               "centre), or name the system, such as project=EPSG:32633.";
    return " is in degrees: say in which system, and where to bring them, such as crs=EPSG:4326 "
           "(terrain_crs=EPSG:4326 beside polygons) and project=auto, or project the points first.";
}

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
                                     Degrees degrees, FaultLog& faults) {
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
        const bool is_degrees = is_among(kDegrees[0], name) || is_among(kDegrees[1], name);
        if (is_degrees && degrees != Degrees::Taken) {
            faults.add(
                FaultKind::Unsupported,
                {"CRS_GEOGRAPHIC", here + shown(names[i].text) + what_degrees_need(degrees), {}});
            continue;
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool is_axis = is_among(kNames[axis], name) ||
                                 (axis < kDegrees.size() && is_among(kDegrees[axis], name));
            if (!is_axis) continue;
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
