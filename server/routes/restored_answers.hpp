// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "server/services.hpp"

namespace tinsmith::server {

/// Has answers to requests with an Idempotency-Key outlive the process: those that are kept are
/// stored, and those that were stored, or whose change alone was, are there again. Of a change the
/// answer is its report then, whatever the first one was asked as. Requires: a vault, and that
/// nobody asks yet; `take_up` of the sessions comes after it, and `restore_answers` last.
void store_answers(Services& services);
/// Throws StorageFault.
void restore_answers(Services& services);

}  // namespace tinsmith::server
