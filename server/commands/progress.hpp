// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace tinsmith::server {

/// A bar on standard error of how far work has come, and nothing at all where that is no terminal.
class ProgressBar {
  public:
    ProgressBar();
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// What is being done from now on.
    void name(std::string_view stage);
    /// So much of all is done, from 0 to 1.
    void show(double done);

    /// Takes the bar away, so that other lines can be written.
    void clear();

  private:
    void draw() const;

    const bool visible_;
    std::string stage_;
    double done_ = 0.0;
};

}  // namespace tinsmith::server
