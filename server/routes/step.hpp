// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "server/http_message.hpp"

namespace tinsmith::server {

/// A value on the way through a handler, or the answer that ends it.
template <typename T>
using Step = std::variant<T, Response>;

}  // namespace tinsmith::server
