// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/router.hpp"
#include "server/services.hpp"

namespace tinsmith::server {

/// The handler of a request that may take long, made to answer 202 with a job where the client says
/// Prefer: respond-async (RFC 7240).
///
/// Laws: the handler is called once, on another thread, with the same request; what it answers is
/// the job's result. A path that names no session is answered at once, and so is a request without
/// the preference. No room for a job: 503, and nothing was begun; with Retry-After where
/// there may be room later.
Handler deferrable(Services& services, Handler handler);

}  // namespace tinsmith::server
