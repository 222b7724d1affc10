// SPDX-License-Identifier: Apache-2.0
#include "api/requests.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "api/crs.hpp"
#include "api/option_reading.hpp"
#include "api/terrain_options.hpp"
#include "core/types/range.hpp"

namespace tinsmith::api {

namespace {

constexpr std::array kPolygonTable{
    OptionRow{"elevation", "drape or own"},
    OptionRow{"on_crossing", "new or old"},
    OptionRow{"improve", "none, strict, paper or bounded"},
    OptionRow{"max_deviation", "a height above 0 in the session's unit"},
    OptionRow{"snap", "a distance of 0 or more in the session's unit"},
    OptionRow{"outside", "skip or reject"},
    OptionRow{"winding", "evenodd or nonzero"},
    OptionRow{"lock", "true or false"},
    OptionRow{"crs", "a name such as EPSG:32616"},
    OptionRow{"dry_run", "true or false"},
    OptionRow{"angles", "true or false"},
};

constexpr std::array kMeshTable{
    OptionRow{"compression", "draco, meshopt or none"},
    OptionRow{"tolerance", "a length in metres above 0 and up to 1000"},
    OptionRow{"up", "y or z"},
    OptionRow{"constraints", "true or false"},
    OptionRow{"normals", "true or false"},
    OptionRow{"regions", "true or false"},
    OptionRow{"bbox", "minx,miny,maxx,maxy in the session's system, no minimum above its maximum"},
    OptionRow{"version", "no such parameter: the mesh as it is now"},
};

constexpr auto kPolygonNames = names_of(kPolygonTable);
constexpr auto kMeshNames = names_of(kMeshTable);

void read_snap(const NamedOption& option, PolygonOptions& out, OptionFaults& faults) {
    const auto snap = parse_number(option.value);
    if (!snap || *snap < 0.0) {
        return faults.add_invalid(option);
    }
    out.integrate.snap = *snap + 0.0;  // of the two noughts the positive one
}

void read_max_deviation(const NamedOption& option, PolygonOptions& out, OptionFaults& faults) {
    const auto most = parse_number(option.value);
    if (!most || *most <= 0.0) {
        return faults.add_invalid(option);
    }
    out.integrate.max_deviation = *most;
}

void read_crs(const NamedOption& option, PolygonOptions& out, OptionFaults& faults) {
    const auto crs = normalise_crs(option.value);
    if (!crs) return faults.add_invalid(option);
    out.crs = *crs;
}

void read_polygon_option(const NamedOption& option, PolygonOptions& out, OptionFaults& faults) {
    using enum core::Improve;
    core::IntegrateOptions& integrate = out.integrate;
    if (option.name == "elevation") {
        read_choice(option, {{"drape", false}, {"own", true}}, out.own_elevations, faults);
    } else if (option.name == "on_crossing") {
        read_choice(option, {{"new", core::OnCrossing::New}, {"old", core::OnCrossing::Old}},
                    integrate.on_crossing, faults);
    } else if (option.name == "improve") {
        read_choice(option,
                    {{"none", None}, {"strict", Strict}, {"paper", Paper}, {"bounded", Bounded}},
                    integrate.improve, faults);
    } else if (option.name == "max_deviation") {
        read_max_deviation(option, out, faults);
    } else if (option.name == "snap") {
        read_snap(option, out, faults);
    } else if (option.name == "outside") {
        read_choice(option, {{"skip", core::Outside::Skip}, {"reject", core::Outside::Reject}},
                    integrate.outside, faults);
    } else if (option.name == "winding") {
        read_choice(option,
                    {{"evenodd", core::Winding::EvenOdd}, {"nonzero", core::Winding::NonZero}},
                    out.winding, faults);
    } else if (option.name == "lock") {
        read_bool(option, integrate.lock, faults);
    } else if (option.name == "crs") {
        read_crs(option, out, faults);
    } else if (option.name == "dry_run") {
        read_bool(option, out.dry_run, faults);
    } else if (option.name == "angles") {
        read_bool(option, out.angles, faults);
    } else {
        faults.add_unknown(option, kPolygonNames);
    }
}

/// Options that mean nothing without another, each told where it stands. What goes with an option
/// that was refused cannot be said.
void check_pairs(std::span<const NamedOption> options, const PolygonOptions& read,
                 OptionFaults& faults) {
    const bool bounded = read.integrate.improve == core::Improve::Bounded;
    const NamedOption* const deviation = find_option(options, "max_deviation");
    if (bounded && deviation == nullptr) {
        faults.add_incomplete(*find_option(options, "improve"),
                              "=bounded needs max_deviation: add the height by which the surface "
                              "may move at most, above 0 in the session's unit.");
    }
    if (!bounded && deviation != nullptr && !faults.refused("improve")) {
        faults.add_incomplete(*deviation, " needs improve=bounded: add that, or leave it out.");
    }
    const NamedOption* const crossing = find_option(options, "on_crossing");
    if (!read.own_elevations && crossing != nullptr && !faults.refused("elevation")) {
        faults.add_incomplete(*crossing,
                              " needs elevation=own, since draped polygons bring no elevations to "
                              "choose: add that, or leave it out.");
    }
}

/// Four numbers with commas between them.
std::optional<PlanBox> parse_bbox(std::string_view text) {
    std::array<double, 4> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const std::size_t comma = text.find(',');
        if ((comma == std::string_view::npos) != (i + 1 == numbers.size())) return std::nullopt;
        const auto number = parse_number(text.substr(0, comma));
        if (!number || std::fabs(*number) > core::kCoordinateLimit) return std::nullopt;
        numbers[i] = *number;
        if (comma != std::string_view::npos) text.remove_prefix(comma + 1);
    }
    const auto [min_x, min_y, max_x, max_y] = numbers;
    if (min_x > max_x || min_y > max_y) return std::nullopt;
    return PlanBox{min_x, min_y, max_x, max_y};
}

void read_bbox(const NamedOption& option, MeshOptions& out, OptionFaults& faults) {
    out.bbox = parse_bbox(option.value);
    if (!out.bbox) faults.add_invalid(option);
}

void read_mesh_option(const NamedOption& option, MeshOptions& options, OptionFaults& faults) {
    GltfOptions& out = options.gltf;
    if (option.name == "compression") {
        using enum Compression;
        read_choice(option, {{"draco", Draco}, {"meshopt", Meshopt}, {"none", None}},
                    out.compression, faults);
    } else if (option.name == "tolerance") {
        const auto value = parse_number(option.value);
        if (value && *value > 0.0 && *value <= 1000.0) {
            out.tolerance = *value;
        } else {
            faults.add_invalid(option);
        }
    } else if (option.name == "up") {
        read_choice(option, {{"y", UpAxis::Y}, {"z", UpAxis::Z}}, out.up, faults);
    } else if (option.name == "constraints") {
        read_bool(option, out.constraints, faults);
    } else if (option.name == "normals") {
        read_bool(option, out.normals, faults);
    } else if (option.name == "regions") {
        read_bool(option, options.regions, faults);
    } else if (option.name == "bbox") {
        read_bbox(option, options, faults);
    } else if (option.name == "version") {
        faults.add_unavailable(option);
    } else {
        faults.add_unknown(option, kMeshNames);
    }
}

}  // namespace

std::string_view winding_name(core::Winding winding) {
    return winding == core::Winding::NonZero ? "nonzero" : "evenodd";
}

std::string_view option_values(std::string_view name) {
    for (const OptionRow& row : kPolygonTable) {
        if (row.name == name) return row.values;
    }
    for (const OptionRow& row : kMeshTable) {
        if (row.name == name) return row.values;
    }
    return terrain_option_values(name);
}

std::span<const std::string_view> polygon_option_names() {
    return kPolygonNames;
}

std::span<const std::string_view> mesh_option_names() {
    return kMeshNames;
}

std::span<const std::string_view> gltf_option_names() {
    constexpr std::size_t kCount = 5;
    static_assert(kMeshNames[kCount] == "regions");
    return mesh_option_names().first(kCount);
}

Parsed<PolygonOptions> parse_polygon_options(std::span<const NamedOption> options,
                                             OptionList list) {
    PolygonOptions out;
    OptionFaults faults;
    for (std::size_t i = 0; i < options.size(); ++i) {
        if (is_repeated(options, i, faults)) continue;
        read_polygon_option(options[i], out, faults);
    }
    if (list == OptionList::Whole) check_pairs(options, out, faults);
    if (!faults.empty()) {
        const FaultKind kind = faults.kind();
        return {kind, faults.take()};
    }
    return out;
}

Parsed<MeshOptions> parse_mesh_options(std::span<const NamedOption> options) {
    MeshOptions out;
    OptionFaults faults;
    for (std::size_t i = 0; i < options.size(); ++i) {
        if (is_repeated(options, i, faults)) continue;
        read_mesh_option(options[i], out, faults);
    }
    if (!faults.empty()) {
        const FaultKind kind = faults.kind();
        return {kind, faults.take()};
    }
    return out;
}

}  // namespace tinsmith::api
