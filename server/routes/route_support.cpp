// SPDX-License-Identifier: Apache-2.0
#include "server/routes/route_support.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "api/media_type.hpp"
#include "api/problem.hpp"
#include "server/reply.hpp"

namespace tinsmith::server {

namespace {

/// The shortest text that reads back to the same number.
std::string text_of(double value) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    return {digits.data(), end};
}

api::ProblemType problem_of(api::EncodeFault fault) {
    switch (fault) {
        case api::EncodeFault::BadOption:
        case api::EncodeFault::ToleranceTooFine:
            return api::ProblemType::InvalidParameter;
        case api::EncodeFault::TooLarge:
            return api::ProblemType::BudgetExceeded;
        case api::EncodeFault::BadMesh:
        case api::EncodeFault::Codec:
            return api::ProblemType::Internal;
    }
    return api::ProblemType::Internal;
}

/// The version in `"<birth>-<version>"`, perhaps with a suffix for a representation.
std::optional<std::uint64_t> version_in(std::string_view tag, const std::string& birth) {
    if (tag.size() < 2 || tag.front() != '"' || tag.back() != '"') return std::nullopt;
    tag = tag.substr(1, tag.size() - 2);
    if (!tag.starts_with(birth + '-')) return std::nullopt;
    tag.remove_prefix(birth.size() + 1);
    std::uint64_t version = 0;
    const char* end = tag.data() + tag.size();
    const auto [stop, error] = std::from_chars(tag.data(), end, version);
    const bool whole = stop == end || *stop == '-';
    return error == std::errc() && whole ? std::optional(version) : std::nullopt;
}

/// The elements of a list such as `"a-1", "b-2"`. A comma within a tag, which ours never have,
/// makes two of it that match nothing.
std::vector<std::string_view> listed(std::string_view text) {
    std::vector<std::string_view> tags;
    for (std::size_t end = 0; end != text.npos;
         text.remove_prefix(std::min(end + 1, text.size()))) {
        end = text.find(',');
        std::string_view tag = text.substr(0, end);
        tag.remove_prefix(std::min(tag.find_first_not_of(" \t"), tag.size()));
        tags.push_back(tag.substr(0, tag.find_last_not_of(" \t") + 1));
    }
    return tags;
}

}  // namespace

Step<std::shared_ptr<Session>> require_session(Services& services, const Request& request,
                                               const std::string& id) {
    if (auto session = services.sessions.find(id)) return session;
    return no_such_session(request, id);
}

Response no_such_session(const Request& request, const std::string& id) {
    return refuse(request, api::ProblemType::NoSuchSession,
                  "No session has the id \"" + id.substr(0, 64) +
                      "\". GET /v1/sessions lists them; they are gone when the server stops.");
}

Step<std::optional<std::uint64_t>> require_if_match(const Request& request,
                                                    const Session& session) {
    const std::uint64_t current = session.view().version;
    std::optional<std::uint64_t> named;
    bool asked = false;
    for (const auto& [name, value] : request.headers) {
        if (name != "if-match") continue;
        if (value == "*") return std::nullopt;
        asked = true;
        for (const std::string_view tag : listed(value)) {
            const auto version = version_in(tag, session.facts().birth);
            if (version && named != current) named = version;
        }
    }
    if (!asked || named) return named;
    return version_mismatch(request, session, current);
}

Response version_mismatch(const Request& request, const Session& session, std::uint64_t current) {
    Response response =
        refuse(request, api::ProblemType::VersionMismatch,
               "If-Match does not name the current version, which is " + std::to_string(current) +
                   ": look at the session again, then repeat with the ETag of this answer.");
    response.with("ETag", session.etag(current));
    return response;
}

std::string etag_of(const Session& session, std::uint64_t version, std::string_view suffix) {
    std::string tag = session.etag(version);
    tag.insert(tag.size() - 1, suffix);
    return tag;
}

Step<std::size_t> require_media_type(const Request& request,
                                     std::span<const std::string_view> offers) {
    std::string accept;
    for (const auto& [name, value] : request.headers) {
        if (name == "accept") accept += (accept.empty() ? "" : ", ") + value;
    }
    if (const auto chosen = api::choose_media_type(accept, offers)) return *chosen;
    std::string known;
    for (const std::string_view offer : offers) {
        known += known.empty() ? "" : ", ";
        known += offer;
    }
    return refuse(request, api::ProblemType::NotAcceptable,
                  "Accept names nothing that can be sent here; there is: " + known + ".");
}

Response refuse_media_type(const Request& request, const std::string& type, std::string_view what,
                           std::string_view known, std::string_view curl_hint) {
    std::string detail = type.empty() ? std::string("There is no Content-Type.")
                                      : "The Content-Type " + type + " is not read here.";
    detail.append(" Send ").append(what).append(" as one of: ").append(known).append(".");
    if (type == "application/x-www-form-urlencoded") {
        detail.append(" That type is what curl says unless told otherwise: add ");
        detail.append(curl_hint).append(".");
    }
    return refuse(request, api::ProblemType::UnsupportedMediaType, std::move(detail));
}

std::vector<api::NamedOption> options_of_query(const Request& request) {
    std::vector<api::NamedOption> options;
    for (const auto& [name, value] : request.query)
        options.push_back({name, value, {}});
    return options;
}

Response glb_response(const Request& request, const core::MeshData& mesh,
                      const api::GltfOptions& options, const std::string& note) {
    auto written = api::write_glb(mesh, options);
    if (const auto* error = std::get_if<api::EncodeError>(&written)) {
        return refuse(request, problem_of(error->fault), error->detail + note);
    }
    auto& glb = std::get<api::GltfResult>(written);
    Response response = ok(kGlb, std::move(glb.bytes));
    response.with("Tinsmith-Max-Error", text_of(glb.max_error))
        .with("Tinsmith-Flipped-Triangles", std::to_string(glb.flipped))
        .with("Tinsmith-Collapsed-Triangles", std::to_string(glb.collapsed))
        .with("Tinsmith-Position-Bits", std::to_string(glb.bits))
        .with("Tinsmith-Origin",
              text_of(glb.origin[0]) + " " + text_of(glb.origin[1]) + " " + text_of(glb.origin[2]));
    return response;
}

Response delta_response(const Request& request, const Session& session, std::uint64_t version,
                        const std::optional<api::MeshDelta>& delta) {
    if (delta) return ok(kDelta, api::write_delta(*delta));
    return refuse(request, api::ProblemType::OutOfMemory,
                  "There is no memory to send the delta now: get it later from /v1/sessions/" +
                      session.facts().id + "/mesh?since=" + std::to_string(version - 1) +
                      ". The edit was made: the session has version " + std::to_string(version) +
                      ".");
}

std::string history_link(const Session& session, std::uint64_t version) {
    return "</v1/sessions/" + session.facts().id + "/history/" + std::to_string(version) +
           ">; rel=\"describedby\"";
}

std::optional<std::uint64_t> parse_version(std::string_view text) {
    std::uint64_t version = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, version);
    return error == std::errc() && stop == end ? std::optional(version) : std::nullopt;
}

Response version_ahead(const Request& request, const VersionAhead& ahead) {
    return refuse(request, api::ProblemType::NoSuchVersion,
                  "Versions are whole numbers from 1 to the current one, which is " +
                      std::to_string(ahead.current) + ".");
}

Response version_gone(const Request& request, const Session& session, const VersionGone& gone) {
    return refuse(request, api::ProblemType::VersionGone,
                  "That version is no longer kept. The oldest kept is " +
                      std::to_string(gone.oldest) + "; /v1/sessions/" + session.facts().id +
                      "/mesh?since=0 is the whole mesh.");
}

std::optional<Response> refusal_of_memory(const Services& services, const Request& request) {
    const std::size_t most = services.limits.max_memory_bytes;
    if (services.sessions.memory_bytes() <= most) return std::nullopt;
    return refuse(request, api::ProblemType::OutOfMemory,
                  "All meshes together have passed the limit max_memory_bytes of " +
                      std::to_string(most) + ". DELETE sessions that are not needed.");
}

}  // namespace tinsmith::server
