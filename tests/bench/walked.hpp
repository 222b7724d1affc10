// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/integrate/report.hpp"
#include "core/mesh/line_allocator.hpp"
#include "core/mesh/tin.hpp"

namespace tinsmith::bench {

/// What an operation cannot do without: the triangles that it changed or made, looked at in the
/// order of the path, each with its corners, and what it wrote into them. No geometry, no
/// decisions, no record of what was there.
class Walked {
  public:
    /// `after` is `before` with the chains in it.
    Walked(const core::Tin& before, const core::Tin& after, const std::vector<core::Chain>& chains);

    /// Slots of a mesh as Tinsmith keeps them, with room for what comes.
    struct Slots {
        std::vector<core::Tin::Vertex, core::LineAllocator<core::Tin::Vertex>> vertices;
        std::vector<core::Tin::Triangle, core::LineAllocator<core::Tin::Triangle>> triangles;
    };
    Slots copy_of(const core::Tin& before) const;

    /// Goes the way and writes. `dependent`: as a walk does, which learns from a triangle where the
    /// next one is; otherwise all places are known before. The sum keeps the compiler honest.
    double go(Slots& slots, bool dependent) const;

    std::size_t triangle_count() const { return way_.size(); }
    std::size_t bytes_written() const;

  private:
    struct Step {
        std::uint32_t slot = 0;
        bool is_new = false;
        core::Tin::Triangle written;
    };
    struct Moved {
        std::uint32_t slot = 0;
        core::Tin::Vertex written;
    };

    std::vector<Step> way_;
    std::vector<Moved> vertices_;  ///< old ones that were written to, and new ones behind them
    std::size_t old_vertices_ = 0;
};

}  // namespace tinsmith::bench
