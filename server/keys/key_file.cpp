// SPDX-License-Identifier: Apache-2.0
#include "server/keys/key_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <set>
#include <type_traits>
#include <utility>

#include "server/file_io.hpp"
#include "server/hex.hpp"
#include "server/keys/private_file.hpp"
#include "server/log_line.hpp"

namespace tinsmith::server {

namespace {

constexpr std::size_t kMostFaults = 100;
constexpr std::size_t kHashBytes = 32;
constexpr std::size_t kTimeLength = std::string_view("2026-11-26T13:00:00Z").size();
/// Beyond, doubles are no whole numbers any more.
constexpr double kLargestQuota = 9e15;

constexpr std::string_view kHeader =
    "# The API keys of a Tinsmith server, by their SHA-256: the keys themselves are not in here.\n"
    "# name id sha256 made [QUOTA=N ...], such as max_sessions=10\n"
    "# `tinsmith key` writes this file. A running server reads it again on SIGHUP.\n";

struct Quota {
    std::string_view name;
    std::optional<double> (*get)(const KeyQuotas&);
    void (*set)(KeyQuotas&, double);
    bool is_whole;
    double least = 0.0;
};

template <auto member>
std::optional<double> get(const KeyQuotas& quotas) {
    const auto& value = quotas.*member;
    return value ? std::optional(static_cast<double>(*value)) : std::nullopt;
}
template <auto member>
void set(KeyQuotas& quotas, double value) {
    auto& place = quotas.*member;
    using Number = std::remove_cvref_t<decltype(*place)>;
    place = static_cast<Number>(value);
}
template <auto member>
constexpr Quota quota(std::string_view name, bool is_whole, double least = 0.0) {
    return {name, get<member>, set<member>, is_whole, least};
}

constexpr std::array kQuotas{
    quota<&KeyQuotas::max_sessions>("max_sessions", true),
    quota<&KeyQuotas::max_memory_bytes>("max_memory_bytes", true),
    quota<&KeyQuotas::max_requests>("max_requests", true),
    quota<&KeyQuotas::max_requests_per_second>("max_requests_per_second", false),
    quota<&KeyQuotas::max_body_bytes>("max_body_bytes", true),
    quota<&KeyQuotas::max_session_bytes>("max_session_bytes", true),
    quota<&KeyQuotas::max_vertices>("max_vertices", true),
    quota<&KeyQuotas::max_triangles>("max_triangles", true),
    quota<&KeyQuotas::max_polygon_vertices>("max_polygon_vertices", true),
    quota<&KeyQuotas::max_crossings>("max_crossings", true),
    quota<&KeyQuotas::max_edit_seconds>("max_edit_seconds", false),
    quota<&KeyQuotas::max_history>("max_history", true, 1.0),
    quota<&KeyQuotas::max_history_bytes>("max_history_bytes", true),
    quota<&KeyQuotas::max_points>("max_points", true),
    quota<&KeyQuotas::max_profile_crossings>("max_profile_crossings", true),
    quota<&KeyQuotas::max_queued_jobs>("max_queued_jobs", true),
};

std::string in_quotes(std::string_view text) {
    return '"' + sanitized(text, 80) + '"';
}

std::vector<std::string_view> words_of(std::string_view line) {
    constexpr std::string_view kBlanks = " \t\r";
    std::vector<std::string_view> words;
    for (;;) {
        const std::size_t begin = line.find_first_not_of(kBlanks);
        if (begin == line.npos) return words;
        line.remove_prefix(begin);
        const std::size_t end = std::min(line.find_first_of(kBlanks), line.size());
        words.push_back(line.substr(0, end));
        line.remove_prefix(end);
    }
}

/// Empty, or what is wrong.
std::string read_quota(std::string_view word, KeyQuotas& quotas) {
    const std::size_t equals = word.find('=');
    const std::string_view name = word.substr(0, equals);
    const auto known =
        std::ranges::find_if(kQuotas, [name](const Quota& one) { return one.name == name; });
    if (equals == word.npos || known == kQuotas.end()) {
        std::string names;
        for (const Quota& one : kQuotas)
            names.append(names.empty() ? "" : ", ").append(one.name);
        return in_quotes(word) + " is no quota: known are " + names + ", such as max_sessions=10";
    }
    if (known->get(quotas)) return std::string(name) + " is given twice";
    const std::string_view text = word.substr(equals + 1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_number = error == std::errc() && end == text.data() + text.size() &&
                           std::isfinite(value) && value >= known->least && value <= kLargestQuota;
    if (!is_number || (known->is_whole ? value != std::floor(value) : value <= 0.0)) {
        return std::string(name) + " cannot be " + in_quotes(text) + ": give a " +
               (known->is_whole ? "whole number, " + quota_text(known->least) + " or more"
                                : std::string("number above 0"));
    }
    known->set(quotas, value);
    return {};
}

/// The key of one line, and what is wrong with it.
ApiKey read_line(std::string_view line, std::vector<std::string>& faults) {
    const auto words = words_of(line);
    ApiKey key;
    if (words.size() < 4) {
        faults.push_back(
            "a key has a name, an id, a SHA-256 and the time when it was made; here "
            "are " +
            std::to_string(words.size()) + " words");
        return key;
    }
    key.name = words[0];
    key.id = words[1];
    key.made = words[3];
    if (!is_key_name(key.name)) {
        faults.push_back("the name " + in_quotes(key.name) +
                         " is not 1 to 64 letters, digits, dots, dashes and underscores with a "
                         "letter or digit in front");
    }
    if (!is_key_name(key.id)) {
        faults.push_back("the id " + in_quotes(key.id) +
                         " is not 1 to 64 letters, digits, dots, dashes and underscores with a "
                         "letter or digit in front");
    }
    auto hash = from_hex(words[2]);
    if (words[2].starts_with("tin_")) {
        faults.push_back(
            "a key itself stands where its SHA-256 belongs: take it out, it is known "
            "to whoever has read this file");
    } else if (!hash || hash->size() != kHashBytes) {
        faults.push_back(in_quotes(words[2]) + " is no SHA-256: 64 lower-case hexadecimal digits");
    } else {
        key.hash = *std::move(hash);
    }
    if (key.made.size() != kTimeLength || !key.made.ends_with('Z'))
        faults.push_back(in_quotes(key.made) + " is no time such as 2026-11-26T13:00:00Z");
    for (std::size_t i = 4; i < words.size(); ++i) {
        if (auto fault = read_quota(words[i], key.quotas); !fault.empty())
            faults.push_back(std::move(fault));
    }
    return key;
}

}  // namespace

std::variant<Keys, KeyFaults> parse_keys(std::string_view text, const std::string& path) {
    Keys keys;
    KeyFaults faults;
    std::set<std::string> names, ids, hashes;
    for (std::size_t number = 1; !text.empty() && faults.size() < kMostFaults; ++number) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        const auto words = words_of(line);
        if (words.empty() || words[0].starts_with('#')) continue;
        std::vector<std::string> wrong;
        ApiKey key = read_line(line, wrong);
        if (wrong.empty()) {
            const std::string before = " is that of a line before, too";
            if (!names.insert(key.name).second)
                wrong.push_back("the name " + in_quotes(key.name) + before);
            if (!ids.insert(key.id).second) wrong.push_back("the id " + in_quotes(key.id) + before);
            if (!hashes.insert(key.hash).second) wrong.push_back("the SHA-256" + before);
        }
        const std::string place = path + ":" + std::to_string(number) + ": ";
        for (const std::string& fault : wrong)
            faults.push_back(place + fault);
        keys.push_back(std::move(key));
    }
    if (faults.size() > kMostFaults) faults.resize(kMostFaults);
    if (!faults.empty()) return faults;
    return keys;
}

std::string write_keys(const Keys& keys) {
    std::string text(kHeader);
    for (const ApiKey& key : keys) {
        text += key.name + ' ' + key.id + ' ' + hex_of(key.hash) + ' ' + key.made;
        for (const auto& [name, value] : named_quotas(key.quotas)) {
            if (!value) continue;
            text.append(" ").append(name).append("=").append(quota_text(*value));
        }
        text += '\n';
    }
    return text;
}

std::variant<Keys, KeyFaults> read_key_file(const std::string& path, bool missing) {
    std::error_code code;
    const bool is_there = std::filesystem::exists(path, code);
    if (!is_there && !code && missing) return Keys{};
    std::string error;
    const auto text = read_file(path, error);
    if (!text) return KeyFaults{error};
    return parse_keys(*text, path);
}

KeyFaults change_key_file(const std::string& path,
                          const std::function<std::optional<std::string>(Keys&)>& change) {
    std::string error;
    const auto turn = FileTurn::take(path, error);
    if (!turn) return {error};
    auto read = read_key_file(path, true);
    if (auto* faults = std::get_if<KeyFaults>(&read)) return std::move(*faults);
    Keys& keys = std::get<Keys>(read);
    if (const auto why = change(keys)) return {*why};
    error = write_private_file(path, write_keys(keys));
    return error.empty() ? KeyFaults{} : KeyFaults{error};
}

std::string quota_text(double value) {
    std::array<char, 32> digits{};
    // Never with an exponent: 1e+09 would be right and unreadable.
    const auto end =
        std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed)
            .ptr;
    return {digits.data(), end};
}

std::vector<NamedQuota> named_quotas(const KeyQuotas& quotas) {
    std::vector<NamedQuota> list;
    list.reserve(std::size(kQuotas));
    for (const Quota& one : kQuotas)
        list.push_back({one.name, one.get(quotas)});
    return list;
}

}  // namespace tinsmith::server
