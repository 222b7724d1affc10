// SPDX-License-Identifier: Apache-2.0
#include "api/formats/json_text.hpp"

#include <algorithm>

namespace tinsmith::api::json {

namespace {

constexpr std::string_view kSpaces = " \t\r\n";

void skip(std::string_view& text, std::string_view what) {
    text.remove_prefix(std::min(text.find_first_not_of(what), text.size()));
}

/// Behind the closing quote. Requires: a text begins here.
std::size_t length_of_text(std::string_view text) {
    const std::size_t quote = text.find('"', 1);
    if (text.substr(0, quote).find('\\') == text.npos) return std::min(quote, text.size() - 1) + 1;
    std::size_t at = 1;
    while (at < text.size() && text[at] != '"')
        at += text[at] == '\\' ? std::size_t{2} : std::size_t{1};
    return std::min(at + 1, text.size());
}

/// Requires: a value begins here, no space.
std::size_t length_of_value(std::string_view text) {
    if (text.starts_with('"')) return length_of_text(text);
    if (!text.starts_with('{') && !text.starts_with('['))
        return std::min(text.find_first_of(",]} \t\r\n"), text.size());
    std::size_t depth = 0;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const char c = text[at];
        if (c == '"') {
            at += length_of_text(text.substr(at)) - 1;
        } else if (c == '{' || c == '[') {
            ++depth;
        } else if ((c == '}' || c == ']') && --depth == 0) {
            return at + 1;
        }
    }
    return text.size();
}

/// The value that begins here, which is passed.
std::string_view take_value(std::string_view& rest) {
    const std::string_view value = rest.substr(0, length_of_value(rest));
    rest.remove_prefix(value.size());
    return value;
}

}  // namespace

JsonText::JsonText(std::string_view text) : text_(text) {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
    skip(text_, kSpaces);
    const std::size_t last = text_.find_last_not_of(kSpaces);
    text_ = text_.substr(0, last + 1);
}

std::optional<JsonText> JsonText::member(std::string_view name) const {
    if (!is_object()) return std::nullopt;
    std::string_view rest = text_.substr(1);
    while (true) {
        skip(rest, " \t\r\n,");
        if (!rest.starts_with('"')) return std::nullopt;
        const std::string_view quoted = take_value(rest);
        skip(rest, " \t\r\n:");
        const std::string_view value = take_value(rest);
        if (quoted.substr(1, quoted.size() - 2) == name) return JsonText(value);
    }
}

std::optional<JsonText> JsonText::Elements::next() {
    skip(rest_, " \t\r\n,");
    if (rest_.empty() || rest_.starts_with(']')) return std::nullopt;
    return JsonText(take_value(rest_));
}

std::size_t JsonText::element_count() const {
    std::size_t count = 0;
    for (Elements all(*this); all.next();)
        ++count;
    return count;
}

}  // namespace tinsmith::api::json
