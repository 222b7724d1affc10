// SPDX-License-Identifier: Apache-2.0
#include "api/formats/csv_line.hpp"

namespace tinsmith::api::csv {

namespace {

constexpr std::size_t kLongestShown = 40;

bool is_blank(char c) {
    return c == ' ' || c == '\t';
}

bool parts(char c, Separator separator) {
    switch (separator) {
        case Separator::Comma:
            return c == ',';
        case Separator::Semicolon:
            return c == ';';
        case Separator::Tab:
            return c == '\t';
        case Separator::Blanks:
            return is_blank(c);
    }
    return false;
}

}  // namespace

Separator separator_of(std::string_view line) {
    line = trimmed(line);
    if (line.find(';') != line.npos) return Separator::Semicolon;
    if (line.find(',') != line.npos) {
        // Between tabs a comma can only be a decimal one, which is told as such.
        return line.find('\t') != line.npos ? Separator::Tab : Separator::Comma;
    }
    // Tabs among blanks are blanks.
    const bool has_tab = line.find('\t') != line.npos, has_space = line.find(' ') != line.npos;
    return has_tab && !has_space ? Separator::Tab : Separator::Blanks;
}

bool split(std::string_view line, Separator separator, std::vector<Field>& fields) {
    fields.clear();
    const auto skip_blanks = [&](std::size_t at) {
        while (at < line.size() && is_blank(line[at]) &&
               (separator == Separator::Blanks || !parts(line[at], separator)))
            ++at;
        return at;
    };
    std::size_t at = skip_blanks(0);
    // Each round takes a field and what parts it from the next one.
    while (true) {
        const std::size_t begin = at;
        if (at < line.size() && line[at] == '"') {
            std::size_t close = line.find('"', at + 1);
            while (close != line.npos && close + 1 < line.size() && line[close + 1] == '"')
                close = line.find('"', close + 2);
            if (close == line.npos) {
                fields.push_back({line.substr(begin), begin + 1});
                return false;
            }
            at = close + 1;
        }
        const bool is_last = fields.size() + 1 == kMostFields;
        while (at < line.size() && (is_last || !parts(line[at], separator)))
            ++at;
        std::string_view text = trimmed(line.substr(begin, at - begin));
        if (text.size() >= 2 && text.front() == '"' && text.back() == '"')
            text = trimmed(text.substr(1, text.size() - 2));
        fields.push_back({text, begin + 1});
        if (at >= line.size()) return true;
        at = skip_blanks(at + 1);
        if (separator == Separator::Blanks && at >= line.size()) return true;
    }
}

bool Lines::next(std::string_view& line) {
    if (offset_ >= text_.size()) return false;
    const std::size_t begin = offset_;
    std::size_t end = begin;
    while (end < text_.size() && text_[end] != '\n' && text_[end] != '\r')
        ++end;
    line = text_.substr(begin, end - begin);
    offset_ = end + 1;
    if (end + 1 < text_.size() && text_[end] == '\r' && text_[end + 1] == '\n') ++offset_;
    if (offset_ > text_.size()) offset_ = text_.size();
    ++number_;
    return true;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front()))
        text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back()))
        text.remove_suffix(1);
    return text;
}

bool is_passed_over(std::string_view line) {
    const std::string_view text = trimmed(line);
    return text.empty() || text.front() == '#';
}

std::string_view without_mark(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    return text;
}

bool begins_as_number(std::string_view line) {
    line = trimmed(line);
    if (line.starts_with('"')) line.remove_prefix(1);
    const char c = line.empty() ? 'x' : line.front();
    return (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.';
}

std::string shown(std::string_view text) {
    std::string out = "\"";
    for (const char c : text.substr(0, kLongestShown))
        out += c >= ' ' && c <= '~' ? c : '?';
    out += text.size() > kLongestShown ? "...\"" : "\"";
    return out;
}

}  // namespace tinsmith::api::csv
