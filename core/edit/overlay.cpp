// SPDX-License-Identifier: Apache-2.0
#include "core/edit/overlay.hpp"

#include "core/predicates/orientation.hpp"

namespace tinsmith::core {

namespace {

/// Whether one edge of `a` has all of `b` beyond it or on it.
bool parts(const Triangle2& a, const Triangle2& b) {
    for (std::size_t i = 0; i < 3; ++i) {
        const Point2 from = a[i], to = a[(i + 1) % 3];
        if (!is_left(from, to, b[0]) && !is_left(from, to, b[1]) && !is_left(from, to, b[2]))
            return true;
    }
    return false;
}

Point2 minus(Point2 p, Point2 origin) {
    return {p.x - origin.x, p.y - origin.y};
}

/// What is left of from -> to.
ConvexPiece left_part(const ConvexPiece& piece, Point2 from, Point2 to) {
    ConvexPiece kept;
    std::array<double, ConvexPiece::kMost> side{};
    for (std::size_t i = 0; i < piece.size; ++i)
        side[i] = compensated_doubled_area(from, to, piece.corners[i]);
    for (std::size_t i = 0; i < piece.size; ++i) {
        const std::size_t next = i + 1 == piece.size ? 0 : i + 1;
        const Point2 p = piece.corners[i], q = piece.corners[next];
        if (side[i] >= 0.0 && kept.size < ConvexPiece::kMost) kept.corners[kept.size++] = p;
        const bool crosses =
            (side[i] > 0.0 && side[next] < 0.0) || (side[i] < 0.0 && side[next] > 0.0);
        if (!crosses || kept.size == ConvexPiece::kMost) continue;
        const double share = side[i] / (side[i] - side[next]);
        kept.corners[kept.size++] = {p.x + (q.x - p.x) * share, p.y + (q.y - p.y) * share};
    }
    return kept;
}

}  // namespace

bool overlap(const Triangle2& a, const Triangle2& b) {
    return !parts(a, b) && !parts(b, a);
}

ConvexPiece common_part(const Triangle2& a, const Triangle2& b) {
    ConvexPiece piece;
    for (const Point2& corner : a)
        piece.corners[piece.size++] = minus(corner, a[0]);
    for (std::size_t i = 0; i < 3; ++i)
        piece = left_part(piece, minus(b[i], a[0]), minus(b[(i + 1) % 3], a[0]));
    return piece;
}

}  // namespace tinsmith::core
