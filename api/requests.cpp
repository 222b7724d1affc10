// SPDX-License-Identifier: Apache-2.0
#include "api/requests.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "api/crs.hpp"

namespace tinsmith::api {

namespace {

/// Collects faults of options; remembers whether all of them are only "not yet".
class OptionFaults {
  public:
    void add_unknown(const NamedOption& option, std::span<const std::string_view> known) {
        add("UNKNOWN_OPTION", option, "is not known here; known are: " + listed(known) + ".");
        all_unsupported_ = false;
    }
    void add_invalid(const NamedOption& option, std::string_view allowed) {
        add("INVALID_OPTION", option,
            "cannot be \"" + option.value + "\": give " + std::string(allowed) + ".");
        all_unsupported_ = false;
    }
    void add_unavailable(const NamedOption& option, std::string_view allowed) {
        add("NOT_AVAILABLE", option,
            "=" + option.value + " is not available in this version: give " + std::string(allowed) +
                ".");
    }
    void add_contradiction(const NamedOption& option) {
        add("CONTRADICTION", option, "is given twice with different values: give it once.");
        all_unsupported_ = false;
    }

    bool empty() const { return faults_.empty(); }
    FaultKind kind() const {
        if (all_unsupported_) return FaultKind::Unsupported;
        const bool in_body = std::any_of(faults_.begin(), faults_.end(),
                                         [](const Fault& fault) { return !fault.pointer.empty(); });
        return in_body ? FaultKind::Invalid : FaultKind::Parameter;
    }
    Faults take() { return std::move(faults_); }

  private:
    static std::string listed(std::span<const std::string_view> names) {
        std::string out;
        for (const std::string_view name : names) {
            if (!out.empty()) out += ", ";
            out += name;
        }
        return out;
    }
    void add(std::string code, const NamedOption& option, const std::string& rest) {
        if (faults_.size() >= kMaxFaults) return;
        const std::string space = rest.front() == '=' ? "" : " ";
        faults_.push_back({std::move(code), option.name + space + rest, option.pointer});
    }

    Faults faults_;
    bool all_unsupported_ = true;
};

bool is_one_of(std::string_view value, std::initializer_list<std::string_view> words) {
    return std::find(words.begin(), words.end(), value) != words.end();
}

std::optional<double> parse_number(std::string_view text) {
    double value = 0.0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

void read_bool(const NamedOption& option, bool& target, OptionFaults& faults) {
    if (option.value == "true" || option.value == "false") {
        target = option.value == "true";
    } else {
        faults.add_invalid(option, "true or false");
    }
}

constexpr std::array<std::string_view, 10> kPolygonOptions{
    "elevation", "on_crossing", "improve", "max_deviation", "snap",
    "outside",   "winding",     "lock",    "crs",           "dry_run"};

void read_improve(const NamedOption& option, PolygonOptions& out, OptionFaults& faults) {
    if (option.value == "none") {
        out.improve = core::Improve::None;
    } else if (option.value == "strict") {
        out.improve = core::Improve::Strict;
    } else if (is_one_of(option.value, {"paper", "bounded"})) {
        faults.add_unavailable(option, "strict or none");
    } else {
        faults.add_invalid(option, "strict or none");
    }
}

void read_outside(const NamedOption& option, PolygonOptions& out, OptionFaults& faults) {
    if (option.value == "skip") {
        out.outside = core::Outside::Skip;
    } else if (option.value == "reject") {
        out.outside = core::Outside::Reject;
    } else {
        faults.add_invalid(option, "skip or reject");
    }
}

/// Words of which only the first is granted in this version.
void read_fixed(const NamedOption& option, std::initializer_list<std::string_view> words,
                OptionFaults& faults) {
    const std::string_view granted = *words.begin();
    if (option.value == granted) return;
    if (is_one_of(option.value, words)) {
        faults.add_unavailable(option, granted);
    } else {
        faults.add_invalid(option, granted);
    }
}

void read_snap(const NamedOption& option, OptionFaults& faults) {
    const auto snap = parse_number(option.value);
    if (!snap || *snap < 0.0) {
        faults.add_invalid(option, "0");
    } else if (*snap > 0.0) {
        faults.add_unavailable(option, "0");
    }
}

void read_polygon_option(const NamedOption& option, PolygonOptions& out, OptionFaults& faults) {
    if (option.name == "improve") {
        read_improve(option, out, faults);
    } else if (option.name == "outside") {
        read_outside(option, out, faults);
    } else if (option.name == "dry_run") {
        read_bool(option, out.dry_run, faults);
    } else if (option.name == "crs") {
        if (const auto crs = normalise_crs(option.value)) {
            out.crs = *crs;
        } else {
            faults.add_invalid(option, "a name such as EPSG:32616");
        }
    } else if (option.name == "elevation") {
        read_fixed(option, {"drape", "own"}, faults);
    } else if (option.name == "winding") {
        read_fixed(option, {"evenodd", "nonzero"}, faults);
    } else if (option.name == "lock") {
        read_fixed(option, {"false", "true"}, faults);
    } else if (option.name == "snap") {
        read_snap(option, faults);
    } else if (is_one_of(option.name, {"on_crossing", "max_deviation"})) {
        faults.add_unavailable(option, "elevation=drape without it");
    } else {
        faults.add_unknown(option, kPolygonOptions);
    }
}

/// True for the second of two options of one name; faults if they contradict each other.
bool is_repeated(std::span<const NamedOption> options, std::size_t i, OptionFaults& faults) {
    for (std::size_t j = 0; j < i; ++j) {
        if (options[j].name != options[i].name) continue;
        if (options[j].value != options[i].value) faults.add_contradiction(options[i]);
        return true;
    }
    return false;
}

constexpr std::array<std::string_view, 8> kMeshOptions{
    "compression", "tolerance", "up", "constraints", "normals", "regions", "bbox", "version"};

void read_mesh_option(const NamedOption& option, GltfOptions& out, OptionFaults& faults) {
    if (option.name == "compression") {
        if (is_one_of(option.value, {"draco", "none"})) {
            out.compression = option.value == "draco" ? Compression::Draco : Compression::None;
        } else if (option.value == "meshopt") {
            faults.add_unavailable(option, "draco or none");
        } else {
            faults.add_invalid(option, "draco or none");
        }
    } else if (option.name == "tolerance") {
        const auto value = parse_number(option.value);
        if (value && *value > 0.0 && *value <= 1000.0) {
            out.tolerance = *value;
        } else {
            faults.add_invalid(option, "a length in metres above 0 and up to 1000");
        }
    } else if (option.name == "up") {
        if (is_one_of(option.value, {"y", "z"})) {
            out.up = option.value == "z" ? UpAxis::Z : UpAxis::Y;
        } else {
            faults.add_invalid(option, "y or z");
        }
    } else if (option.name == "constraints") {
        read_bool(option, out.constraints, faults);
    } else if (option.name == "normals") {
        read_bool(option, out.normals, faults);
    } else if (option.name == "regions") {
        read_fixed(option, {"false", "true"}, faults);
    } else if (is_one_of(option.name, {"bbox", "version"})) {
        faults.add_unavailable(option, "no such parameter: the whole mesh as it is now");
    } else {
        faults.add_unknown(option, kMeshOptions);
    }
}

}  // namespace

std::span<const std::string_view> polygon_option_names() {
    return kPolygonOptions;
}

std::span<const std::string_view> mesh_option_names() {
    return kMeshOptions;
}

Parsed<PolygonOptions> parse_polygon_options(std::span<const NamedOption> options) {
    PolygonOptions out;
    OptionFaults faults;
    for (std::size_t i = 0; i < options.size(); ++i) {
        if (is_repeated(options, i, faults)) continue;
        read_polygon_option(options[i], out, faults);
    }
    if (!faults.empty()) {
        const FaultKind kind = faults.kind();
        return {kind, faults.take()};
    }
    return out;
}

Parsed<GltfOptions> parse_mesh_options(std::span<const NamedOption> options) {
    GltfOptions out;
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
