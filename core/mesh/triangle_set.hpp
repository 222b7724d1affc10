// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bitset>
#include <cstddef>
#include <memory>
#include <vector>

#include "core/types/ids.hpp"

namespace tinsmith::core {

/// A set of a mesh's triangles: bits in pages that are made when first used, so that a small part
/// of a large mesh costs little, and a large part a bit a triangle.
class TriangleSet {
  public:
    explicit TriangleSet(std::size_t triangle_count) : pages_(triangle_count / kPage + 1) {}

    /// True where the triangle was not in the set before.
    bool insert(TriangleId t) {
        std::unique_ptr<Page>& page = pages_[t.index() / kPage];
        if (!page) page = std::make_unique<Page>();
        if ((*page)[t.index() % kPage]) return false;
        page->set(t.index() % kPage);
        return true;
    }
    bool contains(TriangleId t) const {
        const std::unique_ptr<Page>& page = pages_[t.index() / kPage];
        return page && (*page)[t.index() % kPage];
    }

  private:
    static constexpr std::size_t kPage = 1U << 15;
    using Page = std::bitset<kPage>;
    std::vector<std::unique_ptr<Page>> pages_;
};

}  // namespace tinsmith::core
