// SPDX-License-Identifier: Apache-2.0
#include "server/http/descriptors.hpp"

#include <algorithm>

#include <sys/resource.h>

namespace tinsmith::server {

namespace {

/// Beside connections: the store, files that are read, the log.
constexpr rlim_t kOthers = 256;

}  // namespace

std::size_t allow_connections(std::size_t wanted) {
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return wanted;
    const rlim_t needed = static_cast<rlim_t>(wanted) + kOthers;
    if (limit.rlim_cur < needed) {
        rlimit raised = limit;
        raised.rlim_cur = std::min(needed, limit.rlim_max);
        if (::setrlimit(RLIMIT_NOFILE, &raised) == 0) limit = raised;
    }
    if (limit.rlim_cur >= needed) return wanted;
    const rlim_t left = limit.rlim_cur > kOthers ? limit.rlim_cur - kOthers : limit.rlim_cur / 2;
    return std::max<std::size_t>(1, static_cast<std::size_t>(left));
}

}  // namespace tinsmith::server
