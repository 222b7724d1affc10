// SPDX-License-Identifier: Apache-2.0
#include "server/entity_tag.hpp"

#include <algorithm>

namespace tinsmith::server {

namespace {

/// %x21, %x23-7E and bytes beyond ASCII.
bool is_tag_character(char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= 0x21 && byte != 0x22 && byte != 0x7f;
}

void skip_blanks(std::string_view& text) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
}

/// Takes one tag off the front; nothing where none is there.
std::optional<EntityTag> take_tag(std::string_view& text) {
    EntityTag tag;
    tag.weak = text.starts_with("W/");
    if (tag.weak) text.remove_prefix(2);
    if (!text.starts_with('"')) return std::nullopt;
    const std::size_t end = text.find('"', 1);
    if (end == std::string_view::npos) return std::nullopt;
    tag.opaque = std::string(text.substr(1, end - 1));
    text.remove_prefix(end + 1);
    if (!std::all_of(tag.opaque.begin(), tag.opaque.end(), is_tag_character)) return std::nullopt;
    return tag;
}

}  // namespace

std::optional<std::string> combined_field(const Request& request, std::string_view name) {
    std::optional<std::string> all;
    for (const auto& [key, value] : request.headers) {
        if (key != name) continue;
        all = all ? *all + ", " + value : value;
    }
    return all;
}

std::optional<EntityTags> parse_entity_tags(std::string_view field) {
    EntityTags list;
    for (;;) {
        skip_blanks(field);
        if (field.starts_with('*')) {
            if (list.any) return std::nullopt;
            list.any = true;
            field.remove_prefix(1);
        } else if (!field.empty() && field.front() != ',') {
            auto tag = take_tag(field);
            if (!tag) return std::nullopt;
            list.tags.push_back(std::move(*tag));
        }
        skip_blanks(field);
        if (field.empty()) break;
        if (field.front() != ',') return std::nullopt;
        field.remove_prefix(1);
    }
    if (list.any && !list.tags.empty()) return std::nullopt;
    return list;
}

}  // namespace tinsmith::server
