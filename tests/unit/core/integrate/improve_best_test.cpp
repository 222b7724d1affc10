// SPDX-License-Identifier: Apache-2.0
// Strict improvement against all triangulations that there are: no other has better angles.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/quad.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith {
namespace {

using namespace core;
using test::integrate_checked;

using Corners = std::array<std::uint32_t, 3>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;
using Triangulation = std::vector<Corners>;  ///< least corner first, in order
using Angles = std::vector<long double>;     ///< the smallest of each triangle, in order, degrees

Triangulation in_order(Triangulation triangles) {
    for (Corners& t : triangles)
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

/// All triangulations of one facet with its constraints, by swapping every edge that can be: such
/// swaps lead from any of them to any other.
class AllTriangulations {
  public:
    explicit AllTriangulations(const MeshData& data) : data_(data) {
        for (const auto& [v, w] : data.constraints)
            fixed_.insert(std::minmax(v, w));
        found_.insert(in_order({data.triangles.begin(), data.triangles.end()}));
        std::vector<Triangulation> waiting(found_.begin(), found_.end());
        while (!waiting.empty()) {
            const Triangulation now = waiting.back();
            waiting.pop_back();
            for (Triangulation& next : swaps(now))
                if (found_.insert(next).second) waiting.push_back(std::move(next));
        }
    }

    std::size_t count() const { return found_.size(); }

    Angles best() const {
        Angles best = angles(*found_.begin());
        for (const Triangulation& t : found_)
            if (Angles other = angles(t); is_better(other, best)) best = std::move(other);
        return best;
    }

    Angles angles(const Triangulation& triangles) const {
        Angles all;
        for (const auto& [a, b, c] : triangles)
            all.push_back(std::min({angle(a, b, c), angle(b, c, a), angle(c, a, b)}));
        std::sort(all.begin(), all.end());
        return all;
    }

    /// At the first place where they are not the same: to a billionth of a degree, and in needles
    /// to a millionth of themselves.
    static bool is_better(const Angles& one, const Angles& other) {
        for (std::size_t i = 0; i < one.size(); ++i)
            if (std::fabs(one[i] - other[i]) > std::min(1e-9L, 1e-6L * other[i]))
                return one[i] > other[i];
        return false;
    }

  private:
    std::vector<Triangulation> swaps(const Triangulation& triangles) const {
        std::map<Edge, std::size_t> across;
        for (std::size_t t = 0; t < triangles.size(); ++t)
            for (unsigned i = 0; i < 3; ++i)
                across[{triangles[t][i], triangles[t][(i + 1) % 3]}] = t * 3 + i;
        std::vector<Triangulation> found;
        for (const auto& [edge, place] : across) {
            const auto [a, b] = edge;
            const auto other = across.find({b, a});
            if (a > b || other == across.end() || fixed_.contains({a, b})) continue;
            const std::uint32_t c = triangles[place / 3][(place % 3 + 2) % 3];
            const std::uint32_t d = triangles[other->second / 3][(other->second % 3 + 2) % 3];
            if (!is_left(a, d, c) || !is_left(d, b, c)) continue;
            Triangulation next = triangles;
            next[place / 3] = {a, d, c};
            next[other->second / 3] = {d, b, c};
            found.push_back(in_order(std::move(next)));
        }
        return found;
    }

    bool is_left(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
        return test::area(data_.vertices[a].plan(), data_.vertices[b].plan(),
                          data_.vertices[c].plan()) > 0;
    }

    long double angle(std::uint32_t v, std::uint32_t p, std::uint32_t q) const {
        const auto leg = [this, v](std::uint32_t w) {
            const Point3 &from = data_.vertices[v], &to = data_.vertices[w];
            return std::array<long double, 3>{static_cast<long double>(to.x) - from.x,
                                              static_cast<long double>(to.y) - from.y,
                                              static_cast<long double>(to.z) - from.z};
        };
        const auto [ux, uy, uz] = leg(p);
        const auto [vx, vy, vz] = leg(q);
        const long double sine =
            std::hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx);
        return std::atan2(sine, ux * vx + uy * vy + uz * vz) * 57.295779513082320876798L;
    }

    const MeshData& data_;
    std::set<Edge> fixed_;
    std::set<Triangulation> found_;
};

/// How many others were there, and whether one of them was better.
struct Verdict {
    std::size_t triangulations = 0;
    bool best = false;
};

Verdict judge(const MeshData& facet, const std::vector<Shape>& shapes) {
    Tin tin = test::built(facet);
    EXPECT_EQ(integrate_checked(tin, shapes).broken, "");
    const MeshData data = tin.to_data();
    const AllTriangulations all(data);
    const Angles ours = all.angles({data.triangles.begin(), data.triangles.end()});
    return {all.count(), !AllTriangulations::is_better(all.best(), ours)};
}

Shape points(const std::vector<Point2>& positions) {
    Shape shape;
    for (const Point2 p : positions)
        shape.paths.push_back({{p}, false});
    return shape;
}

/// A triangle around everything near the origin, on the plane z = east x + north y.
MeshData facet(double size, double east, double north) {
    const auto at = [=](double x, double y) { return Point3{x, y, east * x + north * y}; };
    return {{at(-3 * size, -2 * size), at(4 * size, -2 * size), at(0, 5 * size)}, {{0, 1, 2}}, {}};
}

TEST(ImproveBest, NoTriangulationOfRandomPointsIsBetter) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> number(-10.0, 10.0);
    std::size_t others = 0;
    for (int trial = 0; trial < 300; ++trial) {
        std::vector<Point2> positions(3 + static_cast<std::size_t>(trial % 3));
        for (Point2& p : positions) {
            p.x = number(random);
            p.y = number(random);
        }
        const double slope = trial % 4 == 0 ? 0.0 : number(random) / 4.0;
        const Verdict verdict = judge(facet(10.0, slope, slope / 3.0), {points(positions)});
        ASSERT_TRUE(verdict.best) << "trial " << trial;
        others += verdict.triangulations - 1;
    }
    EXPECT_GT(others, 3000u);
}

TEST(ImproveBest, NoTriangulationAroundLinesIsBetter) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> number(-10.0, 10.0);
    std::size_t others = 0;
    for (int trial = 0; trial < 300; ++trial) {
        std::vector<Shape> shapes;
        for (int i = 0; i < 2; ++i) {
            std::vector<Point2> ends(2);
            for (Point2& p : ends) {
                p.x = number(random);
                p.y = number(random);
            }
            shapes.push_back(test::line(ends));
        }
        const double slope = number(random) / 2.0;
        const Verdict verdict = judge(facet(10.0, slope, -slope), shapes);
        ASSERT_TRUE(verdict.best) << "trial " << trial;
        others += verdict.triangulations - 1;
    }
    EXPECT_GT(others, 1000u);
}

TEST(ImproveBest, NoTriangulationOfANarrowFacetIsBetter) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> share(0.1, 0.9);
    for (const double width : {1e-3, 1e-6, 1e-9, 1e-12}) {
        for (int trial = 0; trial < 100; ++trial) {
            // The facet's direction is nowhere near an axis: areas are differences of large
            // products. Level, or of known slope: its plane is not at the mercy of rounding.
            const double slope = trial % 2 == 0 || width < 1e-6 ? 0.0 : 0.5;
            const double x = 1.5 - 2 * width, y = 1 + 3 * width;
            const MeshData data{
                {{0, 0, 0}, {3, 2, slope * 5}, {x, y, slope * (x + y)}}, {{0, 1, 2}}, {}};
            std::vector<Point2> positions;
            for (int i = 0; i < 3; ++i) {
                const double along = share(random), up = share(random) * std::min(along, 1 - along);
                positions.push_back({3 * along - 4 * width * up, 2 * along + 6 * width * up});
            }
            ASSERT_TRUE(judge(data, {points(positions)}).best)
                << "width " << width << " trial " << trial;
        }
    }
}

TEST(ImproveBest, NoTriangulationOfFineDetailFarAwayIsBetter) {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> share(0.1, 0.9);
    constexpr double kFar = 5e6, kFine = 1e-3;
    for (int trial = 0; trial < 100; ++trial) {
        const MeshData data{
            {{kFar, kFar, 7}, {kFar + kFine, kFar, 7}, {kFar, kFar + kFine, 7}}, {{0, 1, 2}}, {}};
        std::vector<Point2> positions;
        for (int i = 0; i < 4; ++i) {
            const double x = share(random), y = share(random) * (1 - x);
            positions.push_back({kFar + kFine * x, kFar + kFine * y});
        }
        ASSERT_TRUE(judge(data, {points(positions)}).best) << "trial " << trial;
    }
}

/// Points of a grid of squares in the facet's own plane: level, or rising 3 for 4 to the east.
std::vector<Point2> squares(double east, std::mt19937_64& random, std::size_t count) {
    std::vector<Point2> all;
    for (int i = -2; i <= 2; ++i)
        for (int k = -2; k <= 2; ++k)
            all.push_back(east == 0.0 ? Point2{i * 1.0, k * 1.0} : Point2{i * 4.0, k * 5.0});
    std::shuffle(all.begin(), all.end(), random);
    all.resize(count);
    return all;
}

TEST(ImproveBest, AmongDiagonalsOfOneCircleTheBetterComes) {
    std::mt19937_64 random(5);
    std::size_t others = 0;
    int worse = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const double east = trial % 2 == 0 ? 0.0 : 0.75;
        const Verdict verdict = judge(facet(20.0, east, 0.0), {points(squares(east, random, 5))});
        worse += verdict.best ? 0 : 1;
        others += verdict.triangulations - 1;
    }
    EXPECT_EQ(worse, 0);
    EXPECT_GT(others, 3000u);
}

TEST(ImproveBest, OfFourOnOneCircleTheBetterDiagonalComes) {
    const std::vector<Point2> circle = {{25, 0},  {24, 7},    {20, 15},   {15, 20},  {7, 24},
                                        {0, 25},  {-7, 24},   {-15, 20},  {-20, 15}, {-24, 7},
                                        {-25, 0}, {-20, -15}, {-15, -20}, {0, -25},  {20, -15}};
    std::mt19937_64 random(6);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<Point2> shuffled = circle;
        std::shuffle(shuffled.begin(), shuffled.end(), random);
        const std::vector<Point2> four(shuffled.begin(), shuffled.begin() + 4);
        ASSERT_TRUE(judge(facet(60.0, 0.0, 0.0), {points(four)}).best) << "trial " << trial;
    }
}

}  // namespace
}  // namespace tinsmith
