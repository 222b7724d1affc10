// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/router.hpp"
#include "server/services.hpp"

namespace tinsmith::server {

/// The handler of a POST that changes something, made safe to retry by Idempotency-Key.
///
/// Laws: the key is looked up before the handler sees the request, so before any condition; one
/// scope for each session, by its birth, and one for paths that name none. The same method, path,
/// query, Content-Type and body: the first answer again with Idempotency-Replayed: true. Another:
/// 422. While the first still runs: 409 with Retry-After. A malformed key: 400.
/// Kept are answers below 500 that the same request would get again; what depends on the moment or
/// on other headers (406, 412, 415, 428, 429) did nothing and is judged anew. A job's 202 is kept
/// until the job ends with an answer that would not be.
/// Requests without a key go straight through.
Handler keyed(Services& services, Handler handler);

}  // namespace tinsmith::server
