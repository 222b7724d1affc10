// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace tinsmith::api {

/// One thing wrong in a request, in the caller's own words and numbers.
struct Fault {
    std::string code;     ///< stable, for programs: "RING_NOT_CLOSED"
    std::string detail;   ///< for people: what is wrong and what to do; always valid UTF-8
    std::string pointer;  ///< JSON Pointer (RFC 6901) into the body; empty: the body as a whole
    std::optional<std::array<double, 2>> coordinate = std::nullopt;  ///< plan position, if any
    std::optional<std::uint64_t> index = std::nullopt;  ///< of a vertex or triangle, if any
    std::string parameter = {};  ///< of the query or command line, where that is at fault
    std::string limit = {};      ///< that was met, as /v1/limits calls it; empty: by its code
};

/// All faults of one input in the order they were met; never more than `kMaxFaults`.
using Faults = std::vector<Fault>;
inline constexpr std::size_t kMaxFaults = 100;

/// What sort of "no" the faults add up to; the status number is chosen elsewhere.
enum class FaultKind {
    Syntax,       ///< the bytes are not the format they claim to be
    Invalid,      ///< well formed, but not what was asked for
    TooLarge,     ///< beyond a limit of this server
    Unsupported,  ///< right and meaningful, but not done by this version
    Stopped,      ///< the caller said so: nothing is known to be wrong
    Parameter,    ///< an option given outside the body has a value it cannot have
};

/// Either a value, or a kind and at least one fault; never both, never neither.
template <typename T>
class [[nodiscard]] Parsed {
  public:
    // Implicit, so that a reader returns what it read as it is.
    Parsed(T value) : state_(std::move(value)) {}  // NOLINT(google-explicit-constructor)
    Parsed(FaultKind kind, Fault fault) : state_(Refusal{kind, {}}) {
        std::get<Refusal>(state_).faults.push_back(std::move(fault));
    }
    /// Requires: `faults` is not empty.
    Parsed(FaultKind kind, Faults faults) : state_(Refusal{kind, std::move(faults)}) {
        assert(!this->faults().empty());
    }

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
    FaultKind kind() const { return std::get<Refusal>(state_).kind; }
    Faults& faults() { return std::get<Refusal>(state_).faults; }
    const Faults& faults() const { return std::get<Refusal>(state_).faults; }

  private:
    struct Refusal {
        FaultKind kind = FaultKind::Invalid;
        Faults faults;
    };
    std::variant<T, Refusal> state_;
};

}  // namespace tinsmith::api
