// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "server/http_message.hpp"
#include "server/routes/step.hpp"
#include "server/services.hpp"

namespace tinsmith::server {

// Conditions on a session, by RFC 9110 13. Its tags are `"<birth>-<version>"`, with a suffix inside
// the quotes for each representation of what belongs to it and a last one, "-gzip", for its coding:
// strong tags have to differ wherever bytes do. A condition on an edit is about the version, so any
// suffix will do there.

/// The tag of one representation: the session's, with a suffix inside the quotes.
std::string etag_of(const Session& session, std::uint64_t version, std::string_view suffix);

/// The version that If-Match asks for; nothing where there is no If-Match or it is "*". Of several
/// the one that is current counts. 412 where it names none of this session's life (weak tags name
/// nothing), 400 where it cannot be read.
Step<std::optional<std::uint64_t>> require_if_match(const Request& request, const Session& session);

/// 428 where the operator wants every edit to say which version it means, and this one does not.
std::optional<Response> refusal_of_blind_edit(const Services& services, const Request& request,
                                              const Session& session);

/// 412, with the current version as ETag.
Response version_mismatch(const Request& request, const Session& session, std::uint64_t current);

/// What ends a read before anything is encoded: 304 with the tag that matched, 412, or 400. Weak
/// comparison, and where the client takes gzip the tag of that coding will do too. Nothing: send
/// the representation.
std::optional<Response> answer_to_conditions(const Request& request, const Session& session,
                                             std::uint64_t version, std::string_view suffix);

/// The same for what belongs to no session and has that tag: 304, 400, or nothing.
std::optional<Response> answer_where_unmodified(const Request& request, const std::string& etag);

}  // namespace tinsmith::server
