// SPDX-License-Identifier: Apache-2.0
#include "api/terrain_options.hpp"

#include "api/crs.hpp"
#include "api/option_reading.hpp"

namespace tinsmith::api {

namespace {

constexpr std::array kTable{
    OptionRow{"repair", "true or false"},
    OptionRow{"weld", "a distance of 0 or more in the terrain's unit"},
    OptionRow{"project", "auto or a name such as EPSG:32616"},
    OptionRow{"unit", "metre, foot or US survey foot"},
    OptionRow{"crs", "a name such as EPSG:32616"},
};

constexpr auto kNames = names_of(kTable);

constexpr std::string_view kCrsBeside = "terrain_crs";

constexpr auto kNamesBeside = [] {
    auto names = kNames;
    names.back() = kCrsBeside;
    return names;
}();

void read_weld(const NamedOption& option, TerrainOptions& out, OptionFaults& faults) {
    const auto weld = parse_number(option.value);
    if (!weld || *weld < 0.0) return faults.add_invalid(option);
    out.weld = *weld + 0.0;  // of the two noughts the positive one
}

void read_crs(const NamedOption& option, std::string& out, OptionFaults& faults) {
    const auto crs = normalise_crs(option.value);
    if (!crs) return faults.add_invalid(option);
    out = *crs;
}

void read_option(const NamedOption& option, TerrainOptions& out, OptionFaults& faults) {
    if (option.name == "repair") {
        read_bool(option, out.repair, faults);
    } else if (option.name == "weld") {
        read_weld(option, out, faults);
    } else if (option.name == "project" && option.value == "auto") {
        out.project = option.value;
    } else if (option.name == "project") {
        read_crs(option, out.project, faults);
    } else if (option.name == "unit") {
        const auto unit = normalise_unit(option.value);
        if (!unit) return faults.add_invalid(option);
        out.unit = *unit;
    } else if (option.name == "crs" || option.name == kCrsBeside) {
        read_crs(option, out.crs, faults);
    } else {
        faults.add_unknown(option, kNames);
    }
}

}  // namespace

std::span<const std::string_view> terrain_option_names() {
    return kNames;
}

std::span<const std::string_view> terrain_option_names_beside() {
    return kNamesBeside;
}

std::string_view terrain_option_values(std::string_view name) {
    for (std::size_t i = 0; i < kTable.size(); ++i)
        if (name == kTable[i].name || name == kNamesBeside[i]) return kTable[i].values;
    return {};
}

Parsed<TerrainOptions> parse_terrain_options(std::span<const NamedOption> options) {
    TerrainOptions out;
    OptionFaults faults;
    for (std::size_t i = 0; i < options.size(); ++i) {
        if (is_repeated(options, i, faults)) continue;
        read_option(options[i], out, faults);
    }
    const NamedOption* const weld = find_option(options, "weld");
    if (weld != nullptr && !out.repair && !faults.refused("repair")) {
        faults.add_incomplete(*weld,
                              " needs repair=true, since it changes the mesh: add that, or leave "
                              "it out.");
    }
    if (!faults.empty()) {
        const FaultKind kind = faults.kind();
        return {kind, faults.take()};
    }
    return out;
}

}  // namespace tinsmith::api
