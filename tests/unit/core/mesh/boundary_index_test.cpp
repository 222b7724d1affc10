// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/boundary_index.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/quad.hpp"

namespace tinsmith {
namespace {

using namespace core;
using test::area;
using test::sign;

struct Edge {
    Point2 p, q;
};

bool boxes_meet(const Edge& a, const Edge& b) {
    return std::max(a.p.x, a.q.x) >= std::min(b.p.x, b.q.x) &&
           std::max(b.p.x, b.q.x) >= std::min(a.p.x, a.q.x) &&
           std::max(a.p.y, a.q.y) >= std::min(b.p.y, b.q.y) &&
           std::max(b.p.y, b.q.y) >= std::min(a.p.y, a.q.y);
}

/// Whether two closed segments share a point, exactly.
bool meet(const Edge& a, const Edge& b) {
    return boxes_meet(a, b) && sign(area(a.p, a.q, b.p)) * sign(area(a.p, a.q, b.q)) <= 0 &&
           sign(area(b.p, b.q, a.p)) * sign(area(b.p, b.q, a.q)) <= 0;
}

/// Edges that meet the segment and that the index does not name.
int missed(const BoundaryIndex& index, const std::vector<Edge>& edges, const Edge& segment) {
    const std::vector<VertexId> near = index.near(segment.p, segment.q);
    EXPECT_TRUE(std::is_sorted(near.begin(), near.end()));
    int count = 0;
    for (std::uint32_t i = 0; i < edges.size(); ++i)
        if (meet(edges[i], segment) && !std::binary_search(near.begin(), near.end(), VertexId{i}))
            ++count;
    return count;
}

BoundaryIndex index_of(const std::vector<Edge>& edges, Point2 min, Point2 max) {
    BoundaryIndex index(min, max, edges.size());
    for (std::uint32_t i = 0; i < edges.size(); ++i)
        index.add({i}, edges[i].p, edges[i].q);
    return index;
}

class Points {
  public:
    Points(Point2 min, Point2 max, std::uint64_t seed) : min_(min), max_(max), random_(seed) {}

    double number(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    /// Anywhere in the box, or up to `beyond` boxes outside of it.
    Point2 point(double beyond) {
        const double width = max_.x - min_.x, height = max_.y - min_.y;
        const double x = number(min_.x - beyond * width, max_.x + beyond * width);
        return {x, number(min_.y - beyond * height, max_.y + beyond * height)};
    }

  private:
    Point2 min_, max_;
    std::mt19937_64 random_;
};

TEST(BoundaryIndex, NamesEveryEdgeThatRandomSegmentsMeet) {
    for (const auto& [min, max] : {std::pair{Point2{0, 0}, Point2{10, 10}},
                                   std::pair{Point2{5e6, 4e5}, Point2{5e6 + 1e-3, 4e5 + 1e-3}},
                                   std::pair{Point2{-1, -1e-6}, Point2{1, 1e-6}}}) {
        Points points(min, max, 3);
        std::vector<Edge> edges;
        for (int i = 0; i < 300; ++i) {
            const Point2 p = points.point(0.0);
            const double width = max.x - min.x, height = max.y - min.y;
            const double dx = width * points.number(-0.1, 0.1);
            edges.push_back({p,
                             {std::clamp(p.x + dx, min.x, max.x),
                              std::clamp(p.y + height * points.number(-0.1, 0.1), min.y, max.y)}});
        }
        const BoundaryIndex index = index_of(edges, min, max);
        for (int i = 0; i < 2000; ++i)
            ASSERT_EQ(missed(index, edges, {points.point(0.5), points.point(0.5)}), 0);
    }
}

TEST(BoundaryIndex, NamesEveryEdgeThatLevelAndUprightSegmentsMeet) {
    std::vector<Edge> edges;
    for (int i = 0; i < 20; ++i)
        for (int k = 0; k < 20; ++k) {
            edges.push_back({{i * 0.5, k * 0.5}, {(i + 1) * 0.5, k * 0.5}});
            edges.push_back({{i * 0.5, k * 0.5}, {i * 0.5, (k + 1) * 0.5}});
        }
    const BoundaryIndex index = index_of(edges, {0, 0}, {10, 10});
    for (int i = 0; i <= 40; ++i) {
        const double at = i * 0.25;
        ASSERT_EQ(missed(index, edges, {{-5, at}, {20, at}}), 0);
        ASSERT_EQ(missed(index, edges, {{at, 20}, {at, -5}}), 0);
        ASSERT_EQ(missed(index, edges, {{at, at}, {at, at}}), 0);
        ASSERT_EQ(missed(index, edges, {{at, 0}, {10 - at, 10}}), 0);
    }
}

TEST(BoundaryIndex, NamesEveryEdgeThatSegmentsTiltedByUlpsMeet) {
    // Where a segment rises by a few ulps over the whole width, the row's border can be crossed
    // anywhere along it.
    for (const double offset : {0.0, 5e6}) {
        const Point2 min{offset, offset}, max{offset + 9.0, offset + 9.0};
        std::vector<Edge> edges;
        for (int i = 0; i < 90; ++i)  // upright, all the way across
            edges.push_back({{offset + i * 0.1, offset}, {offset + i * 0.1, offset + 9.0}});
        std::vector<Edge> shorter;
        for (int i = 0; i < 400; ++i) {
            const double x = offset + (i % 20) * 0.45, y = offset + (i / 20) * 0.45;
            shorter.push_back({{x, y}, {x, y + 0.45}});
            shorter.push_back({{x + 0.2, y + 0.2}, {x + 0.2, y - 0.2 < offset ? offset : y - 0.2}});
        }
        // As many cells as the index has, so that edges end on the borders of its rows.
        std::vector<Edge> aligned;
        for (int i = 0; i < 400; ++i) {
            const double x = offset + (i % 20) * 0.45, y = offset + (i / 20) * 0.45;
            aligned.push_back({{x, y}, {x, y + 0.45}});
        }
        for (const auto& set : {edges, shorter, aligned}) {
            const BoundaryIndex index = index_of(set, min, max);
            const double columns = std::floor(std::sqrt(static_cast<double>(set.size())));
            std::mt19937_64 random(5);
            for (int i = 0; i < 4000; ++i) {
                const double row = static_cast<double>(1 + i % static_cast<int>(columns - 1));
                double low = offset + 9.0 / columns * row, high = low;
                for (std::uint64_t k = 0; k <= random() % 4; ++k)
                    low = std::nextafter(low, -HUGE_VAL);
                for (std::uint64_t k = 0; k <= random() % 4; ++k)
                    high = std::nextafter(high, HUGE_VAL);
                ASSERT_EQ(missed(index, set, {{offset - 1, low}, {offset + 10, high}}), 0) << row;
                ASSERT_EQ(missed(index, set, {{offset + 10, low}, {offset - 1, high}}), 0) << row;
            }
        }
    }
}

TEST(BoundaryIndex, AnEmptyOneNamesNothing) {
    EXPECT_TRUE(BoundaryIndex().near({0, 0}, {1, 1}).empty());
    EXPECT_TRUE(BoundaryIndex({0, 0}, {1, 1}, 10).near({0, 0}, {1, 1}).empty());
}

TEST(BoundaryIndex, TakesTheNewestChangesBack) {
    BoundaryIndex index({0, 0}, {4, 4}, 16);
    index.add({1}, {0, 0}, {4, 4});
    const auto before = index.near({0, 0}, {4, 4});
    const std::size_t changes = index.changes();
    index.add({2}, {0, 4}, {4, 0});
    index.add_split({1}, {0, 0}, {3}, {1, 1}, {4, 4});
    index.add_split({3}, {1, 1}, {4}, {3, 3}, {4, 4});
    EXPECT_EQ(index.near({0, 0}, {0, 0}), (std::vector<VertexId>{{1}, {2}, {3}}));
    index.take_back(changes);
    EXPECT_EQ(index.near({0, 0}, {4, 4}), before);
}

TEST(BoundaryIndex, NamesFewEdgesHoweverOftenOneIsSplit) {
    // From either end, and in halves: every edge is found, and near a place never many.
    for (const int way : {0, 1, 2}) {
        constexpr int kEdges = 4096;
        BoundaryIndex index({0, 0}, {kEdges, 1}, 3);
        index.add({0}, {0, 0}, {kEdges, 0});
        std::vector<std::pair<double, VertexId>> starts{{0.0, {0}}, {kEdges, {UINT32_MAX}}};
        for (std::uint32_t i = 1; i < kEdges; ++i) {
            std::uint32_t at = way == 0 ? i : kEdges - i;
            if (way == 2) {  // bits reversed: always near the middle of what is left
                at = 0;
                for (unsigned bit = 0; bit < 12; ++bit)
                    at |= ((i >> bit) & 1U) << (11 - bit);
            }
            const double x = at;
            const auto next =
                std::lower_bound(starts.begin(), starts.end(), std::pair{x, VertexId{0}});
            const auto [from, v] = *(next - 1);
            const double to = next->first;
            index.add_split(v, {from, 0}, {i}, {x, 0}, {to, 0});
            starts.insert(next, {x, {i}});
        }
        std::size_t most = 0;
        for (std::size_t i = 0; i + 1 < starts.size(); ++i) {
            const double middle = starts[i].first + 0.5;
            const auto found = index.near({middle, -1}, {middle, 1});
            EXPECT_TRUE(std::binary_search(found.begin(), found.end(), starts[i].second)) << i;
            most = std::max(most, found.size());
        }
        EXPECT_LT(most, 300u) << way;
    }
}

TEST(BoundaryIndex, NamesFewEdgesAtAPlaceHoweverUnevenlyTheyLie) {
    // All in one straight line; in a corner of a large box; side by side and long.
    for (const int way : {0, 1, 2}) {
        constexpr std::uint32_t kEdges = 20000;
        const double size = way == 1 ? 1e6 : 1.0;
        BoundaryIndex index({0, 0}, {kEdges * size, kEdges * size}, kEdges);
        std::vector<Edge> edges;
        for (std::uint32_t i = 0; i < kEdges; ++i) {
            const double x = i;
            edges.push_back(way == 2 ? Edge{{x, 0}, {x + 0.5, kEdges}} : Edge{{x, 1}, {x + 1, 1}});
            index.add({i}, edges[i].p, edges[i].q);
        }
        std::size_t most = 0;
        for (std::uint32_t i = 0; i < kEdges; i += 97) {
            const Point2 at = edges[i].p;
            const auto found = index.near({at.x, at.y - 0.5}, {at.x, at.y + 0.5});
            EXPECT_TRUE(std::binary_search(found.begin(), found.end(), VertexId{i}));
            most = std::max(most, found.size());
        }
        EXPECT_LT(most, 64u) << way;
        EXPECT_LT(index.memory_bytes(), std::size_t{1000} * kEdges) << way;
    }
}

TEST(BoundaryIndex, NamesEveryEdgeWithinTheMargin) {
    Points points({0, 0}, {10, 10}, 11);
    std::vector<Edge> edges;
    for (int i = 0; i < 3000; ++i) {
        const Point2 p = points.point(0.0);
        edges.push_back({p, {std::min(p.x + 0.01, 10.0), std::min(p.y + 0.02, 10.0)}});
    }
    const BoundaryIndex index = index_of(edges, {0, 0}, {10, 10});
    for (int i = 0; i < 500; ++i) {
        const Point2 p = points.point(0.1);
        const double margin = points.number(0.0, 1.0);
        const auto found = index.near(p, p, margin);
        for (std::uint32_t e = 0; e < edges.size(); ++e) {
            const double away =
                std::max(std::fabs(edges[e].p.x - p.x), std::fabs(edges[e].p.y - p.y));
            ASSERT_TRUE(away > margin ||
                        std::binary_search(found.begin(), found.end(), VertexId{e}));
        }
    }
}

TEST(BoundaryIndex, IsAsItWasOnceManyChangesAreTakenBack) {
    Points points({0, 0}, {10, 10}, 12);
    BoundaryIndex index({0, 0}, {10, 10}, 40);
    std::vector<std::pair<std::size_t, std::vector<std::vector<VertexId>>>> known;
    const auto ask = [&index] {
        std::vector<std::vector<VertexId>> all;
        for (double x = 0.0; x < 10.0; x += 0.7)
            for (double y = 0.0; y < 10.0; y += 0.7)
                all.push_back(index.near({x, y}, {x + 0.1, y + 0.2}));
        return all;
    };
    for (std::uint32_t i = 0; i < 2000; ++i) {
        if (i % 100 == 0) known.emplace_back(index.changes(), ask());
        const Point2 p = points.point(0.0), q = points.point(0.0);
        const Point2 near{p.x + (q.x - p.x) / 64, p.y + (q.y - p.y) / 64};
        index.add({2 * i}, p, near);
        index.add_split({2 * i}, p, {2 * i + 1}, {(p.x + near.x) / 2, (p.y + near.y) / 2}, near);
    }
    for (auto step = known.rbegin(); step != known.rend(); ++step) {
        index.take_back(step->first);
        ASSERT_EQ(ask(), step->second) << step->first;
    }
    EXPECT_EQ(index.changes(), 0u);
}

}  // namespace
}  // namespace tinsmith
