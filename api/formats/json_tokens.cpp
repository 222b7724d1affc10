// SPDX-License-Identifier: Apache-2.0
#include "api/formats/json_tokens.hpp"

#include <algorithm>
#include <functional>

namespace tinsmith::api::json {

namespace {

constexpr std::size_t kFew = 32;  ///< names that are looked through one by one

bool is_of_number(char c) {
    return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.' || c == 'e' || c == 'E';
}

/// Behind the last byte between the quotes, or `most` or one more where that is nearer.
std::size_t end_of_text(std::string_view body, std::size_t begin, std::size_t most) {
    std::size_t at = begin;
    while (at < most && body[at] != '"')
        at += body[at] == '\\' ? std::size_t{2} : std::size_t{1};
    return at;
}

bool is_plain(std::string_view text) {
    return std::all_of(text.begin(), text.end(),
                       [](char c) { return c >= ' ' && c <= '~' && c != '\\'; });
}

std::size_t end_of_number(std::string_view body, std::size_t begin) {
    std::size_t at = begin;
    while (at < body.size() && is_of_number(body[at]))
        ++at;
    return at;
}

/// The first that is too long. Plain texts are not, where they are wanted.
std::optional<LongToken> find_long(std::string_view body, std::vector<PlainText>* plain_texts) {
    for (std::size_t at = 0; at < body.size(); ++at) {
        const char c = body[at];
        if (c == '"') {
            const std::size_t begin = at + 1;
            std::size_t end =
                end_of_text(body, begin, std::min(body.size(), begin + kLongestText + 1));
            if (end - begin > kLongestText) {
                if (plain_texts == nullptr) return LongToken{at, true};
                end = body.find('"', begin);
                if (end == body.npos || !is_plain(body.substr(begin, end - begin)))
                    return LongToken{at, true};
                plain_texts->push_back({begin, end});
            }
            at = end;
        } else if ((c >= '0' && c <= '9') || c == '-') {
            const std::size_t end = end_of_number(body, at);
            if (end - at > kLongestNumber) return LongToken{at, false};
            at = end - 1;
        }
    }
    return std::nullopt;
}

}  // namespace

std::optional<LongToken> first_long_token(std::string_view body) {
    return find_long(body, nullptr);
}

LongTokens long_tokens(std::string_view body) {
    LongTokens all;
    all.other = find_long(body, &all.plain_texts);
    return all;
}

bool is_written_nonzero(std::string_view number) {
    const std::string_view digits = number.substr(0, number.find_first_of("eE"));
    return digits.find_first_of("123456789") != digits.npos;
}

void NameSet::clear() {
    few_.clear();
    many_.clear();
}

bool NameSet::add(std::string_view name) {
    const std::uint64_t hash = std::hash<std::string_view>{}(name);
    if (std::find(few_.begin(), few_.end(), hash) != few_.end()) return false;
    if (few_.size() == kFew) return many_.insert(hash).second;
    few_.push_back(hash);
    return true;
}

}  // namespace tinsmith::api::json
