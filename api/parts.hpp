// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/types/executor.hpp"

namespace tinsmith::api {

/// A list is taken in so many parts at most, so that results of parts fit an array.
inline constexpr std::size_t kMostParts = 8;
/// Shorter parts take no longer than a thread takes to start.
inline constexpr std::size_t kLeastPart = std::size_t{1} << 15;

/// Items from `begin` on, before `end`; parts are numbered from 0 in their order.
struct Part {
    std::size_t number = 0;
    std::size_t begin = 0;
    std::size_t end = 0;
};

/// Calls work(part) for parts of about the same size that together are `count` items, as jobs for
/// the executor; those of `first` go before them. The parts are the same whatever machine it is.
template <typename Work>
void in_parts(const core::Executor& executor, std::size_t count, const Work& work,
              std::vector<core::Job> first = {}) {
    const std::size_t parts = std::clamp(count / kLeastPart, std::size_t{1}, kMostParts);
    std::vector<core::Job> jobs = std::move(first);
    jobs.reserve(jobs.size() + parts);
    for (std::size_t i = 0; i < parts; ++i) {
        const Part part{i, count * i / parts, count * (i + 1) / parts};
        jobs.emplace_back([&work, part] { work(part); });
    }
    executor(jobs);
}

}  // namespace tinsmith::api
