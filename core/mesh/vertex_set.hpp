// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <unordered_set>
#include <vector>

#include "core/types/ids.hpp"

namespace tinsmith::core {

/// A set of vertices that is mostly of a few, sometimes of many: asking costs the same however many
/// there are. Goes through them in the order in which they came.
class VertexSet {
  public:
    void insert(VertexId v) {
        if (contains(v)) return;
        vertices_.push_back(v);
        if (vertices_.size() == kFew)
            for (const VertexId each : vertices_)
                known_.insert(each.value);
        else if (vertices_.size() > kFew)
            known_.insert(v.value);
    }
    bool contains(VertexId v) const {
        if (vertices_.size() >= kFew) return known_.count(v.value) != 0;
        return std::find(vertices_.begin(), vertices_.end(), v) != vertices_.end();
    }
    void clear() {
        if (vertices_.size() >= kFew) known_ = {};  // clearing would cost what it once held
        vertices_.clear();
    }

    auto begin() const { return vertices_.begin(); }
    auto end() const { return vertices_.end(); }

  private:
    static constexpr std::size_t kFew = 16;
    std::vector<VertexId> vertices_;
    std::unordered_set<std::uint32_t> known_;  ///< all of them, once they are not few
};

}  // namespace tinsmith::core
