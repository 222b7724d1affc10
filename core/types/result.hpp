// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <utility>
#include <variant>
#include <vector>

#include "core/types/error.hpp"

namespace tinsmith::core {

/// All faults found in one input, in the input's order; never more than `kMaxFaults`.
using Errors = std::vector<Error>;
inline constexpr std::size_t kMaxFaults = 100;

/// Either a value or at least one error; never both, never neither.
template <typename T>
class [[nodiscard]] Result {
  public:
    // Implicit, so that a function returns a value or an error as it is.
    // NOLINTBEGIN(google-explicit-constructor)
    Result(T value) : state_(std::move(value)) {}
    Result(Error error) : state_(Errors{std::move(error)}) {}
    /// Requires: `errors` is not empty.
    Result(Errors errors) : state_(std::move(errors)) { assert(!this->errors().empty()); }
    // NOLINTEND(google-explicit-constructor)

    bool ok() const { return std::holds_alternative<T>(state_); }
    explicit operator bool() const { return ok(); }

    /// Requires: ok().
    T& value() { return std::get<T>(state_); }
    const T& value() const { return std::get<T>(state_); }
    T& operator*() { return value(); }
    const T& operator*() const { return value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

    /// Requires: !ok().
    Errors& errors() { return std::get<Errors>(state_); }
    const Errors& errors() const { return std::get<Errors>(state_); }

  private:
    std::variant<T, Errors> state_;
};

}  // namespace tinsmith::core
