// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/large_blocks.hpp"

#include <cstdint>
#include <new>

#include "core/mesh/large_pages.hpp"

#if __has_include(<sys/mman.h>)
#include <sys/mman.h>
#endif

namespace tinsmith::core {

namespace {

std::size_t in_whole_pages(std::size_t bytes) {
    if (bytes > static_cast<std::size_t>(-1) - 2 * kLargePage) throw std::bad_alloc();
    return in_large_pages(bytes);
}

}  // namespace

#if defined(MADV_HUGEPAGE)

void* allocate_large_block(std::size_t bytes) {
    // With room to begin at a large page; what is beside it goes back.
    const std::size_t size = in_whole_pages(bytes);
    void* const mapped = mmap(nullptr, size + kLargePage, PROT_READ | PROT_WRITE,
                              MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (mapped == MAP_FAILED) throw std::bad_alloc();
    char* const begin = static_cast<char*>(mapped);
    const std::size_t before =
        (kLargePage - reinterpret_cast<std::uintptr_t>(begin) % kLargePage) % kLargePage;
    if (before > 0) munmap(begin, before);
    munmap(begin + before + size, kLargePage - before);
    madvise(begin + before, size, MADV_HUGEPAGE);  // where it fails, pages are the usual ones
    return begin + before;
}

void free_large_block(void* block, std::size_t bytes) noexcept {
    munmap(block, (bytes + kLargePage - 1) / kLargePage * kLargePage);
}

#else

void* allocate_large_block(std::size_t bytes) {
    return ::operator new (in_whole_pages(bytes), std::align_val_t{kLargePage});
}

void free_large_block(void* block, std::size_t /*bytes*/) noexcept {
    ::operator delete (block, std::align_val_t{kLargePage});
}

#endif

}  // namespace tinsmith::core
