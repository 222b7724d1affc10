// SPDX-License-Identifier: Apache-2.0
#include "server/routes/preconditions.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include "api/content_coding.hpp"
#include "server/entity_tag.hpp"
#include "server/reply.hpp"

namespace tinsmith::server {

namespace {

/// The version in `<birth>-<version>`, perhaps with a suffix.
std::optional<std::uint64_t> version_in(std::string_view tag, const std::string& birth) {
    if (!tag.starts_with(birth + '-')) return std::nullopt;
    tag.remove_prefix(birth.size() + 1);
    std::uint64_t version = 0;
    const char* end = tag.data() + tag.size();
    const auto [stop, error] = std::from_chars(tag.data(), end, version);
    const bool whole = stop == end || *stop == '-';
    return error == std::errc() && whole ? std::optional(version) : std::nullopt;
}

/// The tags of that field, empty where there is none, or 400.
Step<std::optional<EntityTags>> require_tags(const Request& request, const std::string& field) {
    const auto value = combined_field(request, field);
    if (!value) return std::optional<EntityTags>();
    auto tags = parse_entity_tags(*value);
    if (tags) return std::optional(std::move(*tags));
    return refuse(request, api::ProblemType::BadRequest,
                  "The header " + field +
                      " takes \"*\" alone, or entity tags in their quotes with commas between: "
                      "send ETag as it came.");
}

std::string quoted(const std::string& opaque) {
    return '"' + opaque + '"';
}

/// The tag that If-None-Match and the representation have in common; nothing: none.
std::optional<std::string> matched(const EntityTags& asked, const std::string& tag,
                                   const Request& request) {
    if (asked.any) return tag;
    const std::string plain = tag.substr(1, tag.size() - 2);
    const auto has = [&asked](const std::string& opaque) {
        return std::any_of(asked.tags.begin(), asked.tags.end(),
                           [&opaque](const EntityTag& one) { return one.opaque == opaque; });
    };
    const std::string coded = plain + std::string(kGzipSuffix);
    if (api::accepts_gzip(combined_field(request, "accept-encoding").value_or("")) && has(coded)) {
        return quoted(coded);
    }
    return has(plain) ? std::optional(tag) : std::nullopt;
}

}  // namespace

std::string etag_of(const Session& session, std::uint64_t version, std::string_view suffix) {
    std::string tag = session.etag(version);
    tag.insert(tag.size() - 1, suffix);
    return tag;
}

Step<std::optional<std::uint64_t>> require_if_match(const Request& request,
                                                    const Session& session) {
    const auto asked = require_tags(request, "if-match");
    if (const auto* refusal = std::get_if<Response>(&asked)) return *refusal;
    const auto& list = std::get<0>(asked);
    if (!list || list->any) return std::optional<std::uint64_t>();
    const std::uint64_t current = session.view().version;
    std::optional<std::uint64_t> named;
    for (const EntityTag& tag : list->tags) {
        const auto version = version_in(tag.opaque, session.facts().birth);
        if (!tag.weak && version && named != current) named = version;
    }
    if (named) return named;
    return version_mismatch(request, session, current);
}

std::optional<Response> refusal_of_blind_edit(const Services& services, const Request& request,
                                              const Session& session) {
    if (!services.policy.require_if_match || request.header("if-match")) return std::nullopt;
    const std::string tag = session.etag(session.view().version);
    Response response = refuse(request, api::ProblemType::PreconditionRequired,
                               "Every edit has to say which version it means: send If-Match with "
                               "the session's ETag, which is now " +
                                   tag + ".");
    response.with("ETag", tag);
    return response;
}

Response version_mismatch(const Request& request, const Session& session, std::uint64_t current) {
    Response response =
        refuse(request, api::ProblemType::VersionMismatch,
               "If-Match does not name the current version, which is " + std::to_string(current) +
                   ": look at the session again, then repeat with the ETag of this answer.");
    response.with("ETag", session.etag(current));
    return response;
}

std::optional<Response> answer_to_conditions(const Request& request, const Session& session,
                                             std::uint64_t version, std::string_view suffix) {
    const auto expected = require_if_match(request, session);
    if (const auto* refusal = std::get_if<Response>(&expected)) return *refusal;
    if (const auto wanted = std::get<0>(expected); wanted && *wanted != version) {
        return version_mismatch(request, session, version);
    }
    return answer_where_unmodified(request, etag_of(session, version, suffix));
}

std::optional<Response> answer_where_unmodified(const Request& request, const std::string& etag) {
    const auto asked = require_tags(request, "if-none-match");
    if (const auto* refusal = std::get_if<Response>(&asked)) return *refusal;
    if (!std::get<0>(asked)) return std::nullopt;
    const auto tag = matched(*std::get<0>(asked), etag, request);
    return tag ? std::optional(not_modified(*tag)) : std::nullopt;
}

}  // namespace tinsmith::server
