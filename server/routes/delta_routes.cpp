// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <utility>

#include "server/reply.hpp"
#include "server/routes/handlers.hpp"
#include "server/routes/route_support.hpp"

namespace tinsmith::server {

namespace {

constexpr std::array<std::string_view, 2> kDeltaTypes{kJson, kDelta};

Response refuse_parameter(const Request& request, const std::string& name, std::string detail) {
    api::Faults faults{{"INVALID_VALUE", detail, {}, {}, {}, name}};
    return refuse(request,
                  {api::ProblemType::InvalidParameter, std::move(detail), std::move(faults)});
}

/// The version to start from. It goes alone: a delta is of the session's own doubles and slots.
Step<std::uint64_t> require_since(const Request& request) {
    for (const auto& [name, value] : request.query) {
        if (name != "since") {
            return refuse_parameter(request, name,
                                    "\"" + name +
                                        "\" has no meaning beside since: a delta holds full "
                                        "doubles, z up. Leave one of them out.");
        }
    }
    const auto since = parse_version(request.parameter("since").value_or(""));
    if (since) return *since;
    return refuse_parameter(request, "since",
                            "since is the version that the client has, or 0 for the whole mesh.");
}

}  // namespace

Response get_delta(Services& services, const Request& request, const PathArguments& arguments) {
    const auto found = require_session(services, request, arguments[0]);
    if (const auto* refusal = std::get_if<Response>(&found)) return *refusal;
    const auto type = require_media_type(request, kDeltaTypes);
    if (const auto* refusal = std::get_if<Response>(&type)) return *refusal;
    const auto since = require_since(request);
    if (const auto* refusal = std::get_if<Response>(&since)) return *refusal;
    const Session& session = *std::get<0>(found);
    const auto copy = session.delta_since(std::get<0>(since));
    if (const auto* gone = std::get_if<VersionGone>(&copy)) {
        return version_gone(request, session, *gone);
    }
    if (const auto* ahead = std::get_if<VersionAhead>(&copy)) {
        return version_ahead(request, *ahead);
    }
    const auto& delta = std::get<api::MeshDelta>(copy);
    const bool as_json = std::get<0>(type) == 0;
    const EncodeMeter meter(services.metrics, EncodeFormat::Delta);
    const std::string suffix =
        "-since" + std::to_string(std::get<0>(since)) + (as_json ? "-json" : "-delta");
    return ok(std::string(kDeltaTypes[std::get<0>(type)]),
              as_json ? api::write_delta_json(delta) : api::write_delta(delta))
        .with("ETag", etag_of(session, delta.to, suffix))
        .with("Vary", "Accept");
}

}  // namespace tinsmith::server
