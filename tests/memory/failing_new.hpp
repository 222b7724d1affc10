// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tinsmith::memory {

/// While it lives, memory is short for all threads but the one that made it: of the times that they
/// ask operator new from now on, number `first` and the `count - 1` after it fail. One at a time.
class Shortage {
  public:
    explicit Shortage(long first, long count = 1);
    ~Shortage();
    Shortage(const Shortage&) = delete;
    Shortage& operator=(const Shortage&) = delete;

    /// Whether anybody was refused by now.
    bool was_felt() const;
};

}  // namespace tinsmith::memory
