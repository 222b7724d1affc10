// SPDX-License-Identifier: Apache-2.0
// What the parsers of options share: requests, the mesh, the terrain.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/crs.hpp"
#include "api/fault.hpp"
#include "api/requests.hpp"

namespace tinsmith::api {

struct OptionRow {
    std::string_view name;
    std::string_view values;  ///< that it takes, for people
};

template <std::size_t Count>
constexpr auto names_of(const std::array<OptionRow, Count>& table) {
    std::array<std::string_view, Count> names;
    for (std::size_t i = 0; i < Count; ++i)
        names[i] = table[i].name;
    return names;
}

/// Collects faults of options; remembers whether all of them are only "not yet".
class OptionFaults {
  public:
    void add_unknown(const NamedOption& option, std::span<const std::string_view> known) {
        add("UNKNOWN_OPTION", option, " is not known here; known are: " + listed(known) + ".");
    }
    void add_invalid(const NamedOption& option) {
        add("INVALID_OPTION", option,
            " cannot be \"" + option.value + "\": give " + std::string(option_values(option.name)) +
                ".");
    }
    void add_unavailable(const NamedOption& option) {
        const bool all_were = all_unavailable_;
        add("NOT_AVAILABLE", option,
            "=" + option.value + " is not available in this version: give " +
                std::string(option_values(option.name)) + ".");
        all_unavailable_ = all_were;
    }
    void add_contradiction(const NamedOption& option) {
        add("CONTRADICTION", option, " is given twice with different values: give it once.");
    }
    void add_incomplete(const NamedOption& option, const std::string& what_is_missing) {
        add("OPTION_INCOMPLETE", option, what_is_missing);
    }

    bool refused(std::string_view name) const {
        return std::find(refused_.begin(), refused_.end(), name) != refused_.end();
    }

    bool empty() const { return faults_.empty(); }
    FaultKind kind() const {
        if (all_unavailable_) return FaultKind::Unsupported;
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
        all_unavailable_ = false;
        refused_.push_back(option.name);
        if (faults_.size() >= kMaxFaults) return;
        Fault fault{std::move(code), option.name + rest, option.pointer};
        if (option.pointer.empty()) fault.parameter = option.name;
        faults_.push_back(std::move(fault));
    }

    Faults faults_;
    std::vector<std::string_view> refused_;
    bool all_unavailable_ = true;
};

inline bool is_one_of(std::string_view value, std::initializer_list<std::string_view> words) {
    return std::find(words.begin(), words.end(), value) != words.end();
}

inline std::optional<double> parse_number(std::string_view text) {
    double value = 0.0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

inline void read_bool(const NamedOption& option, bool& target, OptionFaults& faults) {
    if (option.value == "true" || option.value == "false") {
        target = option.value == "true";
    } else {
        faults.add_invalid(option);
    }
}

/// The choice of that word.
template <typename Choice>
void read_choice(const NamedOption& option,
                 std::initializer_list<std::pair<std::string_view, Choice>> choices, Choice& out,
                 OptionFaults& faults) {
    for (const auto& [word, choice] : choices) {
        if (option.value != word) continue;
        out = choice;
        return;
    }
    faults.add_invalid(option);
}

inline const NamedOption* find_option(std::span<const NamedOption> options, std::string_view name) {
    const auto found = std::find_if(options.begin(), options.end(),
                                    [name](const NamedOption& o) { return o.name == name; });
    return found == options.end() ? nullptr : &*found;
}

/// Whether two values of one option say the same, be it in other digits or another spelling.
inline bool is_same(const NamedOption& a, const NamedOption& b) {
    if (a.value == b.value) return true;
    const auto number = parse_number(a.value);
    const auto crs = a.name == "crs" ? normalise_crs(a.value) : std::nullopt;
    return (number && number == parse_number(b.value)) || (crs && crs == normalise_crs(b.value));
}

/// True for the second of two options of one name; faults if they contradict each other.
inline bool is_repeated(std::span<const NamedOption> options, std::size_t i, OptionFaults& faults) {
    for (std::size_t j = 0; j < i; ++j) {
        if (options[j].name != options[i].name) continue;
        if (!is_same(options[j], options[i])) faults.add_contradiction(options[i]);
        return true;
    }
    return false;
}

}  // namespace tinsmith::api
