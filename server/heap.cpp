// SPDX-License-Identifier: Apache-2.0
#include "server/heap.hpp"

#include <malloc.h>

namespace tinsmith::server {

namespace {

/// From so many bytes on a block goes back by itself. Smaller ones are made and freed by the
/// hundred while a mesh is encoded, where that would cost system calls.
constexpr int kOwnPages = 8 << 20;
constexpr int kKeptAtTheEnd = 1 << 20;

}  // namespace

void bound_kept_memory() {
    ::mallopt(M_MMAP_THRESHOLD, kOwnPages);
    ::mallopt(M_TRIM_THRESHOLD, kKeptAtTheEnd);
}

void give_back_memory() {
    ::malloc_trim(0);
}

}  // namespace tinsmith::server
