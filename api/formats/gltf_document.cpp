// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gltf_document.hpp"

#include <cmath>
#include <cstdint>
#include <utility>

#include <nlohmann/json.hpp>

#include "api/formats/json_reader.hpp"
#include "api/formats/json_size.hpp"

namespace tinsmith::api {

namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostDepth = 100;
constexpr std::size_t kLongestName = 200;
constexpr std::size_t kMostIndex = std::size_t{1} << 40;  ///< no count or offset is beyond

/// A value that holds no others; null for texts and what does.
Json parsed(const json::JsonText& value) {
    if (value.is_object() || value.is_array() || value.is_text()) return {};
    return Json::parse(value.text().begin(), value.text().end());
}

}  // namespace

void GltfDocument::fault(FaultKind kind, std::string code, std::string detail,
                         std::string pointer) {
    log_.add(kind, {std::move(code), std::move(detail), std::move(pointer)});
}

void GltfDocument::invalid(std::string detail, std::string pointer) {
    fault(FaultKind::Invalid, "GLTF_INVALID", std::move(detail), std::move(pointer));
}

bool GltfDocument::is_sound(std::string_view text) {
    const JsonSound seen = look_through_json(text, kMostDepth);
    const std::string at = " at byte " + std::to_string(seen.wrong_byte) + ".";
    switch (seen.fault) {
        case JsonSound::Fault::None:
            return true;
        case JsonSound::Fault::Syntax:
            fault(FaultKind::Syntax, "GLTF_SYNTAX", "The file's JSON cannot be read" + at);
            break;
        case JsonSound::Fault::TooDeep:
            fault(FaultKind::TooLarge, "GLTF_DOCUMENT",
                  "The file's JSON is nested deeper than " + std::to_string(kMostDepth) + at);
            break;
        case JsonSound::Fault::TooManyMembers:
            fault(FaultKind::TooLarge, "GLTF_DOCUMENT",
                  "An object of the file's JSON has more than " +
                      std::to_string(json::kMostMembers) + " members" + at);
            break;
        case JsonSound::Fault::RepeatedName:
            invalid("The file's JSON has " + json::quoted(seen.name) + " twice in one object" + at,
                    {});
            break;
        case JsonSound::Fault::TooLong:
            fault(FaultKind::TooLarge, "GLTF_DOCUMENT",
                  "The file's JSON has a number or a text that is too long" + at);
            break;
    }
    return false;
}

bool GltfDocument::count(std::size_t& all, std::size_t more, std::string_view what,
                         const std::string& pointer) {
    all += more;
    if (all <= kMostGltfParts) return true;
    fault(FaultKind::TooLarge, "GLTF_DOCUMENT",
          "The file has more than " + std::to_string(kMostGltfParts) + " " + std::string(what) +
              ". Join meshes, and leave out what is not seen.",
          pointer);
    return false;
}

std::optional<double> GltfDocument::number_of(const JsonText& value) {
    const Json number = parsed(value);
    return number.is_number() ? std::optional(number.get<double>()) : std::nullopt;
}

std::optional<std::size_t> GltfDocument::whole(const JsonText& text, const std::string& pointer) {
    const Json value = parsed(text);
    if (value.is_number_unsigned() && value.get<std::uint64_t>() <= kMostIndex)
        return value.get<std::size_t>();
    if (value.is_number_float()) {
        const double number = value.get<double>();
        if (number >= 0.0 && number <= 1e12 && number == std::floor(number))
            return static_cast<std::size_t>(number);
    }
    invalid("A whole number of 0 or more belongs here.", pointer);
    return std::nullopt;
}

std::optional<std::size_t> GltfDocument::index(const JsonText& object, const char* name,
                                               const std::string& pointer) {
    const auto value = object.member(name);
    return value ? whole(*value, pointer + "/" + name) : std::nullopt;
}

std::size_t GltfDocument::number(const JsonText& object, const char* name,
                                 const std::string& pointer, std::size_t otherwise) {
    return index(object, name, pointer).value_or(otherwise);
}

std::size_t GltfDocument::needed(const JsonText& object, const char* name,
                                 const std::string& pointer) {
    const auto found = index(object, name, pointer);
    if (!object.member(name)) invalid(std::string("There is no \"") + name + "\" here.", pointer);
    return found.value_or(0);
}

std::string GltfDocument::text_of(const JsonText& value) {
    if (!value.is_text() || value.text().size() > kLongestName) return {};
    return Json::parse(value.text().begin(), value.text().end()).get<std::string>();
}

std::string GltfDocument::text(const JsonText& object, const char* name) {
    const auto value = object.member(name);
    return value ? text_of(*value) : std::string();
}

bool GltfDocument::flag(const JsonText& object, const char* name) {
    const auto value = object.member(name);
    return value && value->text() == "true";
}

std::optional<json::JsonText> GltfDocument::extension(const JsonText& object, const char* name) {
    const auto all = object.member("extensions");
    const auto one = all ? all->member(name) : std::nullopt;
    return one && one->is_object() ? one : std::nullopt;
}

std::string GltfDocument::whole_text_of_escaped(const JsonText& value) {
    if (value.text().find('\\') == std::string_view::npos) return {};
    return Json::parse(value.text().begin(), value.text().end()).get<std::string>();
}

}  // namespace tinsmith::api
