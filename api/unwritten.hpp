// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace tinsmith::api {

/// Items that are made without a value are not written: who makes them gives them one.
template <typename T>
class UnwrittenAllocator : public std::allocator<T> {
  public:
    template <typename U>
    struct rebind {
        using other = UnwrittenAllocator<U>;
    };

    UnwrittenAllocator() = default;
    template <typename U>
    UnwrittenAllocator(const UnwrittenAllocator<U>& /*other*/) {
    }  // NOLINT(google-explicit-constructor)

    template <typename U>
    void construct(U* /*item*/) {
        static_assert(std::is_trivially_copyable_v<U> && std::is_trivially_destructible_v<U>);
    }
    template <typename U, typename... Arguments>
    void construct(U* item, Arguments&&... arguments) {
        std::construct_at(item, std::forward<Arguments>(arguments)...);
    }
};

/// A list that is resized first and written then, once.
template <typename T>
using Unwritten = std::vector<T, UnwrittenAllocator<T>>;

}  // namespace tinsmith::api
