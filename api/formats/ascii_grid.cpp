// SPDX-License-Identifier: Apache-2.0
#include "api/formats/ascii_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "api/crs.hpp"
#include "api/formats/fault_log.hpp"
#include "api/formats/grid_mesh.hpp"
#include "api/formats/json_reader.hpp"
#include "api/formats/number_text.hpp"
#include "api/formats/raster_warp.hpp"
#include "api/terrain_system.hpp"

namespace tinsmith::api {

namespace {

enum Word { Columns, Rows, Left, LeftCentre, Low, LowCentre, Cell, Dx, Dy, NoData };
constexpr std::array<std::string_view, 10> kWords{
    "ncols",     "nrows",    "xllcorner", "xllcenter", "yllcorner",
    "yllcenter", "cellsize", "dx",        "dy",        "nodata_value"};

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}

std::string lower(std::string_view text) {
    std::string out(text);
    for (char& c : out)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return out;
}

/// Hands out what stands between white space, and knows where that is.
class Tokens {
  public:
    explicit Tokens(std::string_view bytes) : bytes_(bytes) {}

    /// Empty at the end.
    std::string_view next() {
        while (at_ < bytes_.size() && is_space(bytes_[at_]))
            step();
        begin_ = at_;
        token_line_ = line_;
        token_line_start_ = line_start_;
        while (at_ < bytes_.size() && !is_space(bytes_[at_]))
            ++at_;
        return bytes_.substr(begin_, at_ - begin_);
    }
    /// The next token is the last one again.
    void put_back() { at_ = begin_; }
    std::string place() const {
        return "line " + std::to_string(token_line_) + ", column " +
               std::to_string(begin_ - token_line_start_ + 1);
    }
    std::size_t left() const { return bytes_.size() - at_; }
    double share() const { return static_cast<double>(at_) / static_cast<double>(bytes_.size()); }

  private:
    void step() {
        if (bytes_[at_++] != '\n') return;
        ++line_;
        line_start_ = at_;
    }

    std::string_view bytes_;
    std::size_t at_ = 0;
    std::size_t line_ = 1;
    std::size_t line_start_ = 0;
    std::size_t begin_ = 0;  ///< of the last token
    std::size_t token_line_ = 1;
    std::size_t token_line_start_ = 0;
};

std::string not_a_number(std::string_view token) {
    const std::string hint = token.find(',') != std::string_view::npos
                                 ? " The decimal sign is a point here, and between numbers stands "
                                   "a space."
                                 : "";
    return json::quoted(token) + " is no number." + hint;
}

class GridText {
  public:
    GridText(std::string_view bytes, const TerrainOptions& options, const ReadLimits& limits)
        : tokens_(bytes), options_(options), limits_(limits), log_(limits.max_faults) {}

    Parsed<Terrain> read() {
        read_header();
        if (log_.empty()) check_header();
        if (log_.empty()) check_size();
        if (log_.empty()) settle();
        if (log_.empty()) read_elevations();
        if (!log_.empty()) return std::move(log_).refusal<Terrain>();
        return finish();
    }

  private:
    void read_header();
    void check_header();
    void check_size();
    void settle();
    void read_elevations();
    void take_elevation(std::string_view token);
    Parsed<Terrain> finish();

    void fault(FaultKind kind, std::string code, const std::string& detail) {
        log_.add(kind, {std::move(code), detail, {}});
    }
    void fault_here(std::string code, const std::string& detail) {
        fault(FaultKind::Syntax, std::move(code), "At " + tokens_.place() + ": " + detail);
    }
    bool has(Word word) const { return values_[word].has_value(); }
    double value(Word word) const { return *values_[word]; }

    Tokens tokens_;
    const TerrainOptions& options_;
    const ReadLimits& limits_;
    FaultLog log_;
    std::array<std::optional<double>, kWords.size()> values_;
    SystemSettled settled_;
    Grid grid_;
};

void GridText::read_header() {
    while (log_.size() < limits_.max_faults) {
        const std::string_view token = tokens_.next();
        if (token.empty() || number_in<double>(token)) break;  // the first elevation; "nan" is one
        const auto* const word = std::ranges::find(kWords, lower(token.substr(0, 20)));
        if (word == kWords.end()) {
            fault_here("GRID_HEADER",
                       json::quoted(token) +
                           " is no word of the header. Known are: ncols, nrows, xllcorner or "
                           "xllcenter, yllcorner or yllcenter, cellsize or dx and dy, "
                           "NODATA_value.");
            return;
        }
        auto& place = values_[static_cast<std::size_t>(word - kWords.begin())];
        if (place) fault_here("GRID_HEADER", std::string(*word) + " stands here a second time.");
        const std::string_view text = tokens_.next();
        place = number_in<double>(text);
        if (place) continue;
        fault_here("GRID_HEADER", std::string(*word) + " needs a number: " + not_a_number(text));
        place = 0.0;
    }
    tokens_.put_back();
}

void GridText::check_header() {
    const auto missing = [&](const std::string& what) {
        fault(FaultKind::Invalid, "GRID_HEADER", "The header has no " + what + ".");
    };
    if (!has(Columns)) missing("ncols");
    if (!has(Rows)) missing("nrows");
    if (has(Left) == has(LeftCentre)) missing("xllcorner or xllcenter, or it has both");
    if (has(Low) == has(LowCentre)) missing("yllcorner or yllcenter, or it has both");
    if (has(Cell) ? has(Dx) || has(Dy) : !has(Dx) || !has(Dy))
        missing("cellsize, nor dx and dy, or it has both");
    for (const Word count : {Columns, Rows}) {
        if (!has(count)) continue;
        const double n = value(count);
        if (n >= 1.0 && n <= 4e9 && n == std::floor(n)) continue;
        fault(FaultKind::Invalid, "GRID_HEADER",
              std::string(kWords[count]) + " is a whole number from 1 on.");
    }
    for (const Word size : {Cell, Dx, Dy}) {
        if (!has(size) || (value(size) > 0.0 && value(size) <= kMaxCoordinate)) continue;
        fault(FaultKind::Invalid, "GRID_HEADER",
              std::string(kWords[size]) + " is a length above 0, and below 1e9.");
    }
    for (const Word place : {Left, LeftCentre, Low, LowCentre}) {
        if (!has(place) || std::fabs(value(place)) <= kMaxCoordinate) continue;
        fault(FaultKind::Invalid, "COORDINATE_OUT_OF_RANGE",
              std::string(kWords[place]) + " is beyond 1e9.");
    }
}

/// Before memory is taken: against the limit, and against the bytes that there are.
void GridText::check_size() {
    grid_.columns = static_cast<std::size_t>(value(Columns));
    grid_.rows = static_cast<std::size_t>(value(Rows));
    const std::string size =
        std::to_string(grid_.columns) + " by " + std::to_string(grid_.rows) + " posts";
    if (grid_.columns > limits_.max_vertices / grid_.rows) {
        return fault(FaultKind::TooLarge, "TOO_MANY_VERTICES",
                     "The grid has " + size + "; at most " + std::to_string(limits_.max_vertices) +
                         " are taken here.");
    }
    if (grid_.columns * grid_.rows > tokens_.left() / 2 + 1) {  // a digit and a space each
        return fault(FaultKind::Syntax, "GRID_TOO_SHORT",
                     "The header promises " + size + ", and only " +
                         std::to_string(tokens_.left()) + " bytes follow: the file is cut off.");
    }
    grid_.dx = has(Cell) ? value(Cell) : value(Dx);
    const double down = has(Cell) ? value(Cell) : value(Dy);
    grid_.dy = -down;
    const double low = has(Low) ? value(Low) + 0.5 * down : value(LowCentre);
    grid_.origin.x = has(Left) ? value(Left) + 0.5 * grid_.dx : value(LeftCentre);
    grid_.origin.y = low + down * static_cast<double>(grid_.rows - 1);
}

void GridText::settle() {
    const auto named = normalise_crs(options_.crs);
    auto settled = reconcile_system({}, options_, [&]() -> std::variant<std::string, NoPlace> {
        return utm_zone_of(grid_, named.value_or(""));
    });
    if (settled) {
        settled_ = *std::move(settled);
        return;
    }
    for (Fault& each : settled.faults()) {
        if (each.parameter.empty()) each.parameter = "crs";  // the file says nothing of it
        log_.add(settled.kind(), std::move(each));
    }
}

void GridText::read_elevations() {
    const std::size_t count = grid_.columns * grid_.rows;
    grid_.elevations.reserve(count);
    while (grid_.elevations.size() < count && log_.size() < limits_.max_faults) {
        if (grid_.elevations.size() % grid_.columns == 0 && limits_.progress &&
            !limits_.progress(tokens_.share()))
            return log_.add(FaultKind::Stopped, reading_stopped());
        const std::string_view token = tokens_.next();
        if (token.empty()) {
            return fault_here("GRID_TOO_SHORT",
                              "the file ends after " + std::to_string(grid_.elevations.size()) +
                                  " of " + std::to_string(count) + " elevations.");
        }
        take_elevation(token);
    }
    if (!log_.empty() || tokens_.next().empty()) return;
    fault_here("GRID_TOO_LONG",
               "all " + std::to_string(count) + " elevations have been read, and more follows.");
}

void GridText::take_elevation(std::string_view token) {
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    const auto read = number_in<double>(token);
    const std::size_t index = grid_.elevations.size();
    grid_.elevations.push_back(nothing);
    if (read && (std::isnan(*read) || (has(NoData) && *read == value(NoData)))) return;
    const double elevation = read.value_or(0.0) * settled_.elevation_factor;
    if (read && std::fabs(elevation) <= kMaxCoordinate) {
        grid_.elevations.back() = elevation;
        return;
    }
    Fault fault{read ? "COORDINATE_OUT_OF_RANGE" : "GRID_NUMBER",
                "At " + tokens_.place() + ": " +
                    (read ? json::quoted(token) +
                                " is beyond 1e9. If it means no data, name it in the header: "
                                "NODATA_value " +
                                std::string(token.substr(0, 40))
                          : not_a_number(token)),
                {}};
    fault.index = index;
    fault.coordinate = {grid_.origin.x + static_cast<double>(index % grid_.columns) * grid_.dx,
                        grid_.origin.y + static_cast<double>(index / grid_.columns) * grid_.dy};
    log_.add(read ? FaultKind::Invalid : FaultKind::Syntax, std::move(fault));
}

Parsed<Terrain> GridText::finish() {
    if (!settled_.warp_from.empty()) {
        auto warped = warp_grid(grid_, settled_.warp_from, settled_.crs, limits_);
        if (!warped) return {warped.kind(), std::move(warped.faults())};
        grid_ = *std::move(warped);
    }
    Terrain terrain;
    terrain.grid = std::move(grid_);
    terrain.crs = settled_.crs;
    terrain.unit = settled_.unit;
    terrain.settled = true;
    return terrain;
}

}  // namespace

bool begins_as_ascii_grid(std::string_view bytes) {
    constexpr std::size_t longest_gap = 100;
    Tokens tokens(bytes.substr(0, longest_gap));
    const std::string first = lower(tokens.next());
    return std::ranges::find(kWords, first) != kWords.end();
}

Parsed<Terrain> read_ascii_grid(std::string_view bytes, const TerrainOptions& options,
                                const ReadLimits& limits) {
    return GridText(bytes, options, limits).read();
}

}  // namespace tinsmith::api
