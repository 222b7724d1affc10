// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/mesh/tin.hpp"
#include "core/mesh/walk.hpp"

namespace tinsmith::core {

/// Edges that wait to be looked at for a swap, each by one of its sides; the newest comes first.
/// A side that a swap moved names another edge of the same two triangles, all of whose edges that
/// swap added anew: looking at it costs time, never a miss.
class SwapCandidates {
  public:
    explicit SwapCandidates(const Tin& tin) : tin_(tin) {}

    bool empty() const { return sides_.empty(); }

    Side take() {
        const Side s = sides_.back();
        sides_.pop_back();
        return s;
    }

    /// The edges at the vertex, and those across from it in its triangles.
    void add_around(VertexId v) {
        for_each_side_at(tin_, v, [this](Side s) {
            add(s);
            add(s.next());
        });
    }

    /// The four edges around the two triangles beside the edge, after it was swapped.
    void add_outer(Side diagonal) {
        const Side across = tin_.twin(diagonal);
        add(diagonal.next());
        add(diagonal.previous());
        add(across.next());
        add(across.previous());
    }

  private:
    void add(Side s) {
        if (!tin_.is_fixed(s)) sides_.push_back(s);
    }

    const Tin& tin_;
    std::vector<Side> sides_;
};

}  // namespace tinsmith::core
