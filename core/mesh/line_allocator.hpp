// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <type_traits>

#include "core/mesh/large_blocks.hpp"

namespace tinsmith::core {

/// Hands out memory that begins where a cache line does, so that slots of half a line never lie
/// across two: on a mesh that is not in the cache each look would else cost a line and a half.
/// Large meshes come to lie in large pages.
/// Slots that are made without a value are not written: who makes them gives them one, so that a
/// large mesh is written once.
template <typename T>
class LineAllocator {
  public:
    using value_type = T;

    LineAllocator() = default;
    template <typename U>
    LineAllocator(const LineAllocator<U>& /*other*/) {}  // NOLINT(google-explicit-constructor)

    T* allocate(std::size_t count) {
        if (count > (static_cast<std::size_t>(-1) - kLine) / sizeof(T))
            throw std::bad_array_new_length();
        if (count * sizeof(T) >= kLargeBlock)
            return static_cast<T*>(allocate_large_block(count * sizeof(T)));
        // By hand: aligned `operator new` of glibc leaves pieces that later requests search
        // through.
        char* const whole = static_cast<char*>(::operator new(count * sizeof(T) + kLine));
        char* const aligned = whole + kLine - reinterpret_cast<std::uintptr_t>(whole) % kLine;
        std::memcpy(aligned - sizeof(whole), &whole, sizeof(whole));
        return reinterpret_cast<T*>(aligned);
    }
    void deallocate(T* memory, std::size_t count) {
        if (count * sizeof(T) >= kLargeBlock) return free_large_block(memory, count * sizeof(T));
        char* whole = nullptr;
        std::memcpy(&whole, reinterpret_cast<char*>(memory) - sizeof(whole), sizeof(whole));
        ::operator delete(whole);
    }

    template <typename U>
    void construct(U* /*slot*/) {
        static_assert(std::is_trivially_copyable_v<U> && std::is_trivially_destructible_v<U>);
    }

    friend bool operator==(const LineAllocator&, const LineAllocator&) { return true; }

  private:
    /// Memory from `operator new` is aligned to 16, so that there are 16 bytes before the line.
    static constexpr std::size_t kLine = 64;
    static_assert(__STDCPP_DEFAULT_NEW_ALIGNMENT__ >= sizeof(void*));
};

}  // namespace tinsmith::core
