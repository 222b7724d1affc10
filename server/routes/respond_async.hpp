// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/router.hpp"
#include "server/services.hpp"

namespace tinsmith::server {

/// What the path of a route names first, if it names anything.
enum class Names {
    Session,     ///< one that must be there
    NewSession,  ///< one that the request may make
};

/// The handler of a request that may take long, made to answer 202 with a job where the client says
/// Prefer: respond-async (RFC 7240).
///
/// Laws: the handler is called once, on another thread, with the same request; what it answers is
/// the job's result; but never is it called for a session that took the place of the one that was
/// there when the job was asked for. A path that names no session is answered at once whatever the
/// method, and so is a request without the preference. No room for a job: 503, and nothing was
/// begun; with Retry-After where there may be room later.
Handler deferrable(Services& services, Handler handler, Names names = Names::Session);

}  // namespace tinsmith::server
