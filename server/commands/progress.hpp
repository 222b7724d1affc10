// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace tinsmith::server {

/// A bar of stages on standard error, and nothing at all where that is no terminal.
class Progress {
  public:
    explicit Progress(int stages);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Begins the next stage.
    void next(std::string_view name);

    /// Takes the bar away, so that other lines can be written.
    void clear();

  private:
    const int stages_;
    const bool visible_;
    int stage_ = 0;
};

}  // namespace tinsmith::server
