// SPDX-License-Identifier: Apache-2.0
#include "server/request_key.hpp"

#include <utility>

namespace tinsmith::server {

namespace {

RequestKey& own_key() {
    thread_local RequestKey key;
    return key;
}

}  // namespace

const RequestKey& current_request_key() {
    return own_key();
}

RequestKeyScope::RequestKeyScope(RequestKey key)
    : before_(std::exchange(own_key(), std::move(key))) {}

RequestKeyScope::~RequestKeyScope() {
    own_key() = std::move(before_);
}

}  // namespace tinsmith::server
