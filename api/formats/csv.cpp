// SPDX-License-Identifier: Apache-2.0
#include "api/formats/csv.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "api/crs.hpp"
#include "api/formats/csv_columns.hpp"
#include "api/formats/csv_line.hpp"
#include "api/formats/json_reader_values.hpp"
#include "api/projection.hpp"

namespace tinsmith::api {

namespace {

constexpr std::size_t kTellEvery = 4096;  // lines

/// A number as it must be written, to the nearest double. What is wrong with it, or nothing.
struct Number {
    double value = 0.0;
    std::string code;
    std::string detail;
};

Number number_of(std::string_view text) {
    Number number;
    std::string_view digits = text;
    if (digits.starts_with('+')) digits.remove_prefix(1);
    // from_chars takes "inf" and "nan" as well, which begin with no digit.
    const std::size_t sign = digits.starts_with('-') && digits.size() == text.size() ? 1 : 0;
    const char first = digits.size() > sign ? digits[sign] : 'x';
    const bool begins = (first >= '0' && first <= '9') || first == '.';
    const auto [end, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), number.value);
    if (text.empty()) {
        number.code = "NUMBER_INVALID";
        number.detail = "The field is empty; a number is needed here.";
    } else if (!begins || error == std::errc::invalid_argument ||
               end != digits.data() + digits.size()) {
        number.code = "NUMBER_INVALID";
        number.detail = csv::shown(text) + " is no number";
        number.detail += text.find(',') != text.npos ? ": write decimals with a point, not a comma."
                                                     : "; write it like -12.5 or 1.2e3.";
    } else if (error == std::errc::result_out_of_range) {
        number.code = "NUMBER_OUT_OF_RANGE";
        number.detail = csv::shown(text) + " is a number that no double holds.";
    } else if (!json::acceptable_coordinate(number.value)) {
        number.code = "COORDINATE_OUT_OF_RANGE";
        number.detail = json::coordinate_out_of_range();
    }
    return number;
}

/// Columns of degrees need a system that has some, and a plan to be brought to.
csv::Degrees degrees_of(const TerrainOptions& options) {
    const auto crs = normalise_crs(options.crs);
    const auto facts = crs ? find_crs(*crs) : std::nullopt;
    if (!facts || facts->kind != CrsFacts::Kind::Geographic) return csv::Degrees::WithoutSystem;
    return options.project.empty() ? csv::Degrees::WithoutPlan : csv::Degrees::Taken;
}

class CsvReader {
  public:
    CsvReader(std::string_view bytes, const TerrainOptions& options, const ReadLimits& limits)
        : text_(csv::without_mark(bytes)),
          options_(options),
          limits_(limits),
          faults_(limits.max_faults) {}

    Parsed<Terrain> read() {
        if (text_.substr(0, 4096).find('\0') != text_.npos) {
            return {FaultKind::Syntax,
                    Fault{"CSV_SYNTAX",
                          "These bytes are no text in UTF-8; save the points as CSV in UTF-8.",
                          {}}};
        }
        Terrain terrain;
        read_lines();
        if (!faults_.empty()) return std::move(faults_).refusal<Terrain>();
        terrain.mesh.vertices = std::move(points_);
        terrain.points = PointsPlace{
            {},
            [lines = std::move(lines_)](Fault& fault, std::size_t point,
                                        std::optional<std::size_t> earlier) {
                fault.detail = "Line " + std::to_string(lines[point]) + ": " + fault.detail;
                if (earlier)
                    fault.detail += " (point " + std::to_string(*earlier) + " is in line " +
                                    std::to_string(lines[*earlier]) + ")";
            }};
        return terrain;
    }

  private:
    void fault(std::string code, std::size_t line, std::size_t column, const std::string& detail) {
        faults_.add(FaultKind::Invalid,
                    {std::move(code), csv::at(line, column) + detail, {}, {}, points_.size()});
    }

    void read_lines();
    bool begin(std::string_view line, std::size_t number);
    void read_point(std::string_view line, std::size_t number);
    bool has_stopped(const csv::Lines& lines);

    std::string_view text_;
    const TerrainOptions& options_;
    const ReadLimits& limits_;
    FaultLog faults_;
    csv::Separator separator_ = csv::Separator::Comma;
    csv::Columns columns_;
    std::vector<csv::Field> fields_;
    std::vector<core::Point3> points_;
    std::vector<std::uint32_t> lines_;  ///< by point
};

void CsvReader::read_lines() {
    csv::Lines lines(text_);
    std::string_view line;
    bool has_begun = false;
    while (lines.next(line) && !faults_.full()) {
        if (lines.number() % kTellEvery == 0 && has_stopped(lines)) return;
        if (csv::is_passed_over(line)) continue;
        if (!has_begun) {
            has_begun = true;
            if (!begin(line, lines.number())) return;
            if (columns_.are_named) continue;
        }
        if (points_.size() == limits_.max_vertices) {
            faults_.add(FaultKind::TooLarge,
                        {"TOO_MANY_VERTICES",
                         csv::at(lines.number(), 1) + "More than " +
                             std::to_string(limits_.max_vertices) + " points; no more are taken.",
                         {}});
            return;
        }
        read_point(line, lines.number());
    }
}

/// Looks at the first line, and from a header on to the first line of data, which says how fields
/// are parted. False where nothing can be read by this header.
bool CsvReader::begin(std::string_view line, std::size_t number) {
    if (csv::begins_as_number(line)) {
        separator_ = csv::separator_of(line);
        return true;
    }
    csv::Lines ahead(
        text_.substr(static_cast<std::size_t>(line.data() - text_.data()) + line.size()));
    std::string_view data;
    while (ahead.next(data) && csv::is_passed_over(data)) {
    }
    separator_ = csv::separator_of(csv::is_passed_over(data) ? line : data);
    if (!csv::split(line, separator_, fields_)) {
        faults_.add(FaultKind::Syntax,
                    {"CSV_SYNTAX",
                     csv::at(number, fields_.back().column) + "A quote is opened and not closed.",
                     {}});
        return false;
    }
    const auto columns = csv::columns_named(fields_, number, degrees_of(options_), faults_);
    if (columns) columns_ = *columns;
    return columns.has_value();
}

void CsvReader::read_point(std::string_view line, std::size_t number) {
    std::array<double, 3> values{};
    if (!csv::split(line, separator_, fields_)) {
        fault("CSV_SYNTAX", number, fields_.back().column, "A quote is opened and not closed.");
    } else if (fields_.size() != columns_.count) {
        std::string detail =
            std::to_string(fields_.size()) + (fields_.size() == 1 ? " field; " : " fields; ");
        detail += columns_.are_named
                      ? "the header has " + std::to_string(columns_.count) + "."
                      : "without a header that names the columns there are three: x, y, z.";
        const std::size_t excess = std::min(fields_.size() - 1, columns_.count);
        fault("WRONG_LENGTH", number, fields_[excess].column, detail);
    } else {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const csv::Field& field = fields_[columns_.field[axis]];
            Number read = number_of(field.text);
            values[axis] = read.value;
            if (!read.code.empty()) fault(std::move(read.code), number, field.column, read.detail);
        }
    }
    points_.push_back({values[0], values[1], values[2]});
    lines_.push_back(static_cast<std::uint32_t>(number));
}

bool CsvReader::has_stopped(const csv::Lines& lines) {
    if (!limits_.progress) return false;
    const double share = static_cast<double>(lines.offset()) / static_cast<double>(text_.size());
    if (limits_.progress(0.5 * share)) return false;
    faults_.add(FaultKind::Stopped, reading_stopped());
    return true;
}

}  // namespace

Parsed<Terrain> read_csv(std::string_view bytes, const TerrainOptions& options,
                         const ReadLimits& limits) {
    return CsvReader(bytes, options, limits).read();
}

bool looks_like_csv(std::string_view bytes) {
    constexpr std::size_t kFarEnough = 65536;
    csv::Lines lines(csv::without_mark(bytes.substr(0, kFarEnough)));
    std::string_view line;
    while (lines.next(line) && csv::is_passed_over(line)) {
    }
    if (csv::is_passed_over(line)) return false;
    std::vector<csv::Field> fields;
    if (!csv::split(line, csv::separator_of(line), fields)) return false;
    if (csv::begins_as_number(line))
        return fields.size() >= 3 && number_of(fields[0].text).code.empty();
    FaultLog faults(1);
    return csv::columns_named(fields, 1, csv::Degrees::WithoutSystem, faults).has_value() ||
           (!faults.empty() &&
            std::move(faults).refusal<Terrain>().faults()[0].code != "COLUMN_MISSING");
}

}  // namespace tinsmith::api
