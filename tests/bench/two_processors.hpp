// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/types/executor.hpp"

namespace tinsmith::bench {

/// An executor of two threads, each on a processor of its own: on a machine that others use as well
/// the system would move a thread that lives for milliseconds too late. Threads are started anew
/// each time, as `api::side_by_side` does it. Jobs are taken in their order by whoever is free.
void on_two_processors(std::span<const core::Job> jobs);

}  // namespace tinsmith::bench
