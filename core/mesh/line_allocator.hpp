// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <new>

namespace tinsmith::core {

/// Hands out memory that begins where a cache line does, so that slots of half a line never lie
/// across two: on a mesh that is not in the cache each look would else cost a line and a half.
template <typename T>
class LineAllocator {
  public:
    using value_type = T;

    LineAllocator() = default;
    template <typename U>
    LineAllocator(const LineAllocator<U>& /*other*/) {}  // NOLINT(google-explicit-constructor)

    T* allocate(std::size_t count) {
        if (count > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
        return static_cast<T*>(::operator new(count * sizeof(T), kLine));
    }
    void deallocate(T* memory, std::size_t count) {
        ::operator delete(memory, count * sizeof(T), kLine);
    }

    friend bool operator==(const LineAllocator&, const LineAllocator&) { return true; }

  private:
    static constexpr std::align_val_t kLine{64};
};

}  // namespace tinsmith::core
