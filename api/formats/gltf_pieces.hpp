// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

namespace tinsmith::api {

/// Numbers of triangles or edges.
using Items = std::vector<std::uint32_t>;

template <std::size_t N>
using Corners = std::array<std::uint32_t, N>;

/// Part of a mesh with its own vertex numbers: vertex i of the piece is mesh vertex vertices[i].
template <std::size_t N>
struct Piece {
    std::vector<std::uint32_t> vertices;
    std::vector<Corners<N>> corners;
};

/// Takes pieces out of one mesh. Numbers go by first use; cost is the piece's, not the mesh's.
class PieceCutter {
  public:
    explicit PieceCutter(std::size_t vertices) : number_(vertices, kNone) {}

    template <std::size_t N>
    Piece<N> cut(std::span<const Corners<N>> all, std::span<const std::uint32_t> chosen) {
        Piece<N> piece;
        piece.corners.reserve(chosen.size());
        // A triangulation has about half as many vertices as triangles.
        piece.vertices.reserve(std::min(number_.size(), chosen.size() / 2 + N));
        for (const std::uint32_t item : chosen) {
            Corners<N>& corners = piece.corners.emplace_back();
            for (std::size_t i = 0; i < N; ++i) {
                std::uint32_t& number = number_[all[item][i]];
                if (number == kNone) {
                    number = static_cast<std::uint32_t>(piece.vertices.size());
                    piece.vertices.push_back(all[item][i]);
                }
                corners[i] = number;
            }
        }
        for (const std::uint32_t vertex : piece.vertices)
            number_[vertex] = kNone;
        return piece;
    }

  private:
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> number_;
};

inline Items all_of(std::size_t count) {
    Items items(count);
    std::iota(items.begin(), items.end(), std::uint32_t{0});
    return items;
}

}  // namespace tinsmith::api
