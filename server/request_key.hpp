// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace tinsmith::server {

/// The Idempotency-Key of a request and what tells it from other requests; empty: it has none.
struct RequestKey {
    std::string key;
    std::string print;
    std::string scope;  ///< the birth of the session that was asked, or the API key, or empty
};

/// Of the request that this thread works on: what it changes is kept with its key.
const RequestKey& current_request_key();

/// While it lives, this thread works on a request with that key.
class RequestKeyScope {
  public:
    explicit RequestKeyScope(RequestKey key);
    ~RequestKeyScope();
    RequestKeyScope(const RequestKeyScope&) = delete;
    RequestKeyScope& operator=(const RequestKeyScope&) = delete;

  private:
    RequestKey before_;
};

}  // namespace tinsmith::server
