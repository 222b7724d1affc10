// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "core/types/ids.hpp"

namespace tinsmith::core {

/// A value for each of a mesh's triangles, T{} until it is set: in pages that are made when first
/// used, so that a small part of a large mesh costs little. Asking costs no search.
template <typename T>
class TriangleMap {
  public:
    explicit TriangleMap(std::size_t triangle_count) : pages_(triangle_count / kPage + 1) {}

    T& at(TriangleId t) {
        std::unique_ptr<Page>& page = pages_[t.index() / kPage];
        if (!page) page = std::make_unique<Page>();
        return (*page)[t.index() % kPage];
    }
    T value(TriangleId t) const {
        const std::unique_ptr<Page>& page = pages_[t.index() / kPage];
        return page ? (*page)[t.index() % kPage] : T{};
    }

  private:
    static constexpr std::size_t kPage = 1U << 10;
    using Page = std::array<T, kPage>;
    std::vector<std::unique_ptr<Page>> pages_;
};

}  // namespace tinsmith::core
