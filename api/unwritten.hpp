// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>
#include <vector>

namespace tinsmith::api {

/// Items that are made without a value are not written: who makes them gives them one.
template <typename T>
class UnwrittenAllocator {
  public:
    using value_type = T;

    UnwrittenAllocator() = default;
    template <typename U>
    // NOLINTNEXTLINE(google-explicit-constructor)
    UnwrittenAllocator(const UnwrittenAllocator<U>& /*other*/) {}

    T* allocate(std::size_t count) { return std::allocator<T>().allocate(count); }
    void deallocate(T* memory, std::size_t count) { std::allocator<T>().deallocate(memory, count); }

    template <typename U>
    void construct(U* /*item*/) {
        static_assert(std::is_trivially_copyable_v<U> && std::is_trivially_destructible_v<U>);
    }

    friend bool operator==(const UnwrittenAllocator&, const UnwrittenAllocator&) { return true; }
};

/// A list that is resized first and written then, once.
template <typename T>
using Unwritten = std::vector<T, UnwrittenAllocator<T>>;

}  // namespace tinsmith::api
