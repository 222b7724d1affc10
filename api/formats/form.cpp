// SPDX-License-Identifier: Apache-2.0
#include "api/formats/form.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "api/field_list.hpp"
#include "api/media_type.hpp"

namespace tinsmith::api {

namespace {

constexpr std::size_t kMostParts = 16;
constexpr std::size_t kLongestHead = 8192;    ///< all headers of one part
constexpr std::size_t kLongestBoundary = 70;  ///< RFC 2046 5.1.1
constexpr std::string_view kLine = "\r\n";

Fault malformed(std::string detail) {
    return {"FORM_MALFORMED", std::move(detail), {}};
}

/// The value of a parameter, `name="a;b"` or `name=ab`; separators within quotes belong to it.
std::optional<std::string> parameter_of(std::string_view field, std::string_view wanted) {
    std::size_t at = field.find(';');
    while (at < field.size()) {
        ++at;
        const std::size_t equals = field.find('=', at);
        if (equals == field.npos) return std::nullopt;
        const std::string name = lower_case(trimmed(field.substr(at, equals - at)));
        std::string value;
        at = equals + 1;
        if (at < field.size() && field[at] == '"') {
            for (++at; at < field.size() && field[at] != '"'; ++at) {
                if (field[at] == '\\' && at + 1 < field.size()) ++at;
                value.push_back(field[at]);
            }
            at = field.find(';', std::min(at, field.size()));
        } else {
            const std::size_t end = std::min(field.find(';', at), field.size());
            value = trimmed(field.substr(at, end - at));
            at = end;
        }
        if (name == wanted) return value;
    }
    return std::nullopt;
}

/// The headers of one part. False: it has no name.
bool read_head(std::string_view head, FormPart& part) {
    bool named = false;
    while (!head.empty()) {
        const std::size_t end = std::min(head.find(kLine), head.size());
        std::string_view line = head.substr(0, end);
        head.remove_prefix(std::min(end + kLine.size(), head.size()));
        const std::string name = lower_case(take_part(line, ':'));
        if (name == "content-disposition") {
            if (auto given = parameter_of(line, "name")) {
                part.name = *std::move(given);
                named = true;
            }
        } else if (name == "content-type") {
            part.media_type = media_type_of(line);
        }
    }
    return named;
}

}  // namespace

Parsed<std::vector<FormPart>> read_form(std::string_view body, std::string_view content_type) {
    const auto boundary = parameter_of(content_type, "boundary");
    if (!boundary || boundary->empty() || boundary->size() > kLongestBoundary) {
        return {FaultKind::Syntax,
                malformed("Content-Type names no boundary: let the client make it, as curl -F and "
                          "FormData do.")};
    }
    const std::string dashes = "--" + *boundary;
    // What stands before the first boundary is passed over.
    std::size_t at = body.starts_with(dashes) ? 0 : body.find(std::string(kLine) + dashes);
    if (at == body.npos) {
        return {FaultKind::Syntax, malformed("The boundary of the Content-Type is nowhere in the "
                                             "body.")};
    }
    if (at != 0) at += kLine.size();
    std::vector<FormPart> parts;
    for (;;) {
        at += dashes.size();
        if (body.substr(at).starts_with("--")) return parts;
        const std::size_t begin = body.find(kLine, at);
        const std::size_t blank = begin == body.npos ? begin : body.find("\r\n\r\n", begin);
        if (blank == body.npos || blank - begin > kLongestHead) {
            return {FaultKind::Syntax, malformed("A part has no headers that end.")};
        }
        FormPart part;
        const std::size_t head = begin + kLine.size();
        if (blank < head || !read_head(body.substr(head, blank - head), part)) {
            return {FaultKind::Syntax, malformed("A part has no name in its Content-Disposition.")};
        }
        const std::size_t content = blank + 2 * kLine.size();
        const std::size_t end = body.find(std::string(kLine) + dashes, content);
        if (end == body.npos) {
            return {FaultKind::Syntax, malformed("The part \"" + part.name.substr(0, 64) +
                                                 "\" does not end: the last boundary is missing.")};
        }
        part.body = body.substr(content, end - content);
        if (parts.size() == kMostParts) {
            return {FaultKind::TooLarge, malformed("No more than 16 parts are taken.")};
        }
        parts.push_back(std::move(part));
        at = end + kLine.size();
    }
}

}  // namespace tinsmith::api
