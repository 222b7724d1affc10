// SPDX-License-Identifier: Apache-2.0
#include "api/crs.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

namespace tinsmith::api {

namespace {

constexpr std::string_view kMetre = "metre";
constexpr std::string_view kFoot = "foot";
constexpr std::string_view kSurveyFoot = "US survey foot";
constexpr std::size_t kLongestName = 100;

std::string upper(std::string_view text) {
    std::string out(text);
    for (char& c : out)
        c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return out;
}

bool is_word(std::string_view text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
    });
}

/// "AUTHORITY:CODE" when both are words.
std::optional<std::string> joined(std::string_view authority, std::string_view code) {
    if (!is_word(authority) || !is_word(code)) return std::nullopt;
    return std::string(authority) + ":" + std::string(code);
}

}  // namespace

std::optional<std::string> normalise_crs(std::string_view name) {
    if (name.size() > kLongestName) return std::nullopt;
    const std::string text = upper(name);
    std::string_view rest = text;
    char between = ':';
    bool versioned = false;
    constexpr std::array<std::pair<std::string_view, char>, 4> prefixes{{
        {"URN:OGC:DEF:CRS:", ':'},
        {"URN:X-OGC:DEF:CRS:", ':'},
        {"HTTP://WWW.OPENGIS.NET/DEF/CRS/", '/'},
        {"HTTPS://WWW.OPENGIS.NET/DEF/CRS/", '/'},
    }};
    for (const auto& [prefix, separator] : prefixes) {
        if (!rest.starts_with(prefix)) continue;
        rest.remove_prefix(prefix.size());
        between = separator;
        versioned = true;
        break;
    }
    const std::size_t first = rest.find(between);
    const std::size_t last = rest.rfind(between);
    if (first == rest.npos) return std::nullopt;
    // A version between authority and code may be empty ("EPSG::32616") and is not kept.
    if (first != last && (!versioned || rest.find(between, first + 1) != last)) return std::nullopt;
    return joined(rest.substr(0, first), rest.substr(last + 1));
}

bool same_crs(std::string_view a, std::string_view b) {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 3> twins{
        {{"OGC:CRS84", "EPSG:4326"}, {"OGC:CRS83", "EPSG:4269"}, {"OGC:CRS27", "EPSG:4267"}}};
    for (const auto& [one, other] : twins) {
        if ((a == one && b == other) || (a == other && b == one)) return true;
    }
    return a == b;
}

std::optional<std::string> normalise_unit(std::string_view name) {
    if (name.size() > kLongestName) return std::nullopt;
    std::string text = upper(name);
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '_' || c == '-'; }, ' ');
    constexpr std::array<std::pair<std::string_view, std::string_view>, 18> spellings{{
        {"METRE", kMetre},
        {"METRES", kMetre},
        {"METER", kMetre},
        {"METERS", kMetre},
        {"M", kMetre},
        {"FOOT", kFoot},
        {"FEET", kFoot},
        {"FT", kFoot},
        {"INTERNATIONAL FOOT", kFoot},
        {"US SURVEY FOOT", kSurveyFoot},
        {"US SURVEY FEET", kSurveyFoot},
        {"FOOT US", kSurveyFoot},
        {"FOOT US SURVEY", kSurveyFoot},
        {"FTUS", kSurveyFoot},
        {"US FT", kSurveyFoot},
        {"FOOT (INTERNATIONAL)", kFoot},
        {"FT US", kSurveyFoot},
        {"SURVEY FOOT", kSurveyFoot},
    }};
    for (const auto& [spelling, unit] : spellings) {
        if (text == spelling) return std::string(unit);
    }
    return std::nullopt;
}

double metres_per(std::string_view unit) {
    if (unit == kFoot) return 0.3048;
    if (unit == kSurveyFoot) return 1200.0 / 3937.0;
    return 1.0;
}

std::optional<std::string> unit_of_length(double metres) {
    for (const std::string_view unit : {kMetre, kFoot, kSurveyFoot}) {
        if (std::fabs(metres - metres_per(unit)) <= 1e-9) return std::string(unit);
    }
    return std::nullopt;
}

}  // namespace tinsmith::api
