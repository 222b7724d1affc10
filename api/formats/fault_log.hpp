// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>

#include "api/fault.hpp"

namespace tinsmith::api {

/// Collects the faults of one input up to a number, and what they add up to.
class FaultLog {
  public:
    explicit FaultLog(std::size_t most) : most_(most == 0 ? 1 : most) {}

    /// Beyond the number the fault is dropped: it is not even counted.
    void add(FaultKind kind, Fault fault) {
        if (full()) return;
        if (faults_.empty() || rank(kind) > rank(kind_)) kind_ = kind;
        faults_.push_back(std::move(fault));
    }

    std::size_t size() const { return faults_.size(); }
    bool empty() const { return faults_.empty(); }
    bool full() const { return faults_.size() >= most_; }

    /// Requires: !empty().
    template <typename T>
    Parsed<T> refusal() && {
        return Parsed<T>(kind_, std::move(faults_));
    }

  private:
    /// Of several kinds the one is told that makes the others doubtful.
    static int rank(FaultKind kind) {
        switch (kind) {
            case FaultKind::Unsupported:
                return 0;
            case FaultKind::Parameter:
            case FaultKind::Invalid:
                return 1;
            case FaultKind::TooLarge:
                return 2;
            case FaultKind::Syntax:
                return 3;
            case FaultKind::Stopped:
                return 4;
        }
        return 0;
    }

    std::size_t most_;
    FaultKind kind_ = FaultKind::Invalid;
    Faults faults_;
};

}  // namespace tinsmith::api
