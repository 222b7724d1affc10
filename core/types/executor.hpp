// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

namespace tinsmith::core {

using Job = std::function<void()>;

/// Does all the jobs, at the same time where it can, and comes back when all are done; throws what
/// the first of them threw, by their order. Nothing that a job makes may depend on which others are
/// done, so that the result is the same however they are spread.
using Executor = std::function<void(std::span<const Job>)>;

inline void one_after_another(std::span<const Job> jobs) {
    for (const Job& job : jobs)
        job();
}

}  // namespace tinsmith::core
