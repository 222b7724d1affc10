// SPDX-License-Identifier: Apache-2.0
// The operators new and delete of this program. Those that are not here call these.
#include "tests/memory/failing_new.hpp"

#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>

namespace tinsmith::memory {

namespace {

constexpr long kNever = std::numeric_limits<long>::max();

std::atomic<long> before_first{kNever};
std::atomic<long> to_refuse{0};
std::atomic<bool> felt{false};
thread_local bool is_spared = false;

bool is_refused() {
    if (is_spared || before_first == kNever) return false;
    if (before_first.fetch_sub(1) > 0 || to_refuse.fetch_sub(1) <= 0) return false;
    felt = true;
    return true;
}

void* allocate(std::size_t size) {
    if (is_refused()) return nullptr;
    return std::malloc(size == 0 ? 1 : size);
}

}  // namespace

Shortage::Shortage(long first, long count) {
    is_spared = true;
    felt = false;
    to_refuse = count;
    before_first = first;
}

Shortage::~Shortage() {
    before_first = kNever;
    is_spared = false;
}

bool Shortage::was_felt() const {
    return felt;
}

}  // namespace tinsmith::memory

void* operator new(std::size_t size) {
    if (void* place = tinsmith::memory::allocate(size)) return place;
    throw std::bad_alloc();
}

void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
    return tinsmith::memory::allocate(size);
}

void operator delete(void* place) noexcept {
    std::free(place);
}

void operator delete(void* place, std::size_t /*size*/) noexcept {
    std::free(place);
}
