// SPDX-License-Identifier: Apache-2.0
// Every segment, triangle and quadrangle of small lattices: the cases that nobody thought of are
// among them. The lattices are laid exactly, and so that rounding moves every point a little.
#include <cmath>
#include <iostream>
#include <random>
#include <sstream>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "tests/unit/core/fixtures.hpp"

namespace tinsmith {
namespace {

using namespace core;
using test::Diagonals;

/// Where lattice points come to lie.
struct Frame {
    const char* name;
    Point2 origin, right, up;

    Point2 at(double x, double y) const {
        return {origin.x + x * right.x + y * up.x, origin.y + x * right.y + y * up.y};
    }
};

constexpr Frame kFrames[] = {
    {"exact", {0, 0}, {1, 0}, {0, 1}},
    {"tenths", {0, 0}, {0.1, 0}, {0, 0.1}},
    {"far away", {5e6, 4.5e6}, {0.1, 0}, {0, 0.1}},
    {"turned", {0.3, -0.7}, {0.8660254037844387, 0.5}, {-0.5, 0.8660254037844387}},
    {"turned far away", {5e5, 4.5e6}, {25.98076211353316, 15}, {-15, 25.98076211353316}},
    {"sheared", {1e3, 1e3}, {7.3, 0.1}, {7.1, 0.3}},
};

MeshData laid(MeshData mesh, const Frame& frame) {
    for (Point3& v : mesh.vertices) {
        const Point2 p = frame.at(v.x, v.y);
        v = {p.x, p.y, v.z};
    }
    return mesh;
}

/// Counts what breaks and shows the first few.
class Tries {
  public:
    /// `rough`: where segments lie within ulps of each other, vertices cannot be counted, and a
    /// request that no mesh of doubles holds may be refused.
    explicit Tries(const MeshData& mesh, bool rough = false)
        : mesh_(test::built(mesh)), rough_(rough) {}

    void integrate(const std::vector<Shape>& shapes) {
        IntegrateOptions options;
        options.improve = count_++ % 3 == 0 ? Improve::None : Improve::Strict;
        Tin tin = mesh_;
        const auto outcome = test::integrate_checked(tin, shapes, options, !rough_);
        if (rough_ && outcome.broken.starts_with("NOT_REPRESENTABLE") &&
            !outcome.broken.ends_with("changed")) {
            ++refused_;
            return;
        }
        if (outcome.broken.empty() || outcome.broken.starts_with("OUTSIDE_MESH")) return;
        if (++broken_ > 3) return;
        std::ostringstream text;
        text.precision(17);
        for (const Shape& shape : shapes) {
            for (const Path& path : shape.paths) {
                text << (path.closed ? "ring" : "line");
                for (const Point2 p : path.points)
                    text << "  " << p.x << " " << p.y;
            }
        }
        ADD_FAILURE() << text.str() << "\n" << outcome.broken;
    }
    int count() const { return count_; }
    int broken() const { return broken_; }
    int refused() const { return refused_; }

  private:
    Tin mesh_;
    bool rough_;
    int count_ = 0;
    int refused_ = 0;
    int broken_ = 0;
};

class Lattice : public testing::TestWithParam<std::tuple<Frame, Diagonals>> {
  protected:
    const Frame& frame() const { return std::get<0>(GetParam()); }
    Diagonals diagonals() const { return std::get<1>(GetParam()); }
};

TEST_P(Lattice, EverySegmentBetweenHalfLatticePoints) {
    Tries tries(laid(test::grid(2, 2, diagonals()), frame()));
    for (int i = 0; i < 49; ++i)
        for (int k = 0; k < 49; ++k)
            tries.integrate({test::line({frame().at(i % 7 * 0.5 - 0.5, i / 7 * 0.5 - 0.5),
                                         frame().at(k % 7 * 0.5 - 0.5, k / 7 * 0.5 - 0.5)})});
    EXPECT_EQ(tries.broken(), 0) << "of " << tries.count();
}

TEST_P(Lattice, EverySegmentBetweenHalfLatticePointsAcrossAHole) {
    Tries tries(laid(test::ring_of_cells(diagonals()), frame()));
    for (int i = 0; i < 49; ++i)
        for (int k = 0; k < 49; k += 2)
            tries.integrate({test::line(
                {frame().at(i % 7 * 0.5, i / 7 * 0.5), frame().at(k % 7 * 0.5, k / 7 * 0.5)})});
    EXPECT_EQ(tries.broken(), 0) << "of " << tries.count();
}

TEST_P(Lattice, EveryClosedPathOfFourLatticePoints) {
    // Duplicates, spikes, bow-ties, triangles and quadrangles, convex or not.
    Tries tries(laid(test::grid(2, 2, diagonals()), frame()));
    for (int i = 0; i < 9; ++i)
        for (int k = 0; k < 9; ++k)
            for (int m = 0; m < 9; ++m)
                for (int n = i; n < 9; n += 2)
                    tries.integrate(
                        {test::ring({frame().at(i % 3, i / 3), frame().at(k % 3, k / 3),
                                     frame().at(m % 3, m / 3), frame().at(n % 3, n / 3)})});
    EXPECT_EQ(tries.broken(), 0) << "of " << tries.count();
}

TEST_P(Lattice, PairsOfSegmentsBetweenThirdLatticePoints) {
    Tries tries(laid(test::grid(1, 1, diagonals()), frame()));
    const auto at = [this](int i) { return frame().at(i % 4 / 3.0, i / 4 / 3.0); };
    for (int i = 0; i < 16; ++i)
        for (int k = 0; k < 16; ++k)
            for (int m = 0; m < 16; m += 3)
                for (int n = 0; n < 16; n += 2)
                    tries.integrate({test::line({at(i), at(k)}), test::line({at(m), at(n)})});
    EXPECT_EQ(tries.broken(), 0) << "of " << tries.count();
}

TEST_P(Lattice, SegmentsBetweenPointsSomeUlpsOffTheLattice) {
    // All that rounding can do to points that were meant to be on edges and vertices.
    // Gently sloped: a point ulps outside may be on either neighbour's plane.
    MeshData mesh = laid(test::grid(2, 2, diagonals()), frame());
    for (Point3& v : mesh.vertices)
        v.z *= 0.02 * std::fabs(frame().right.x);
    Tries tries(mesh, true);
    std::mt19937_64 random(1);
    const double size = std::fabs(frame().origin.x) + std::fabs(frame().right.x);
    const auto off = [&random, size](double x) {
        // In ulps of the coordinate, or of the mesh's size where that is all but zero.
        const double from = std::fabs(x) > 1e-6 * size ? x : size;
        const double ulp = std::nextafter(std::fabs(from), HUGE_VAL) - std::fabs(from);
        return x + (static_cast<double>(random() % 7) - 3.0) * ulp;
    };
    const auto point = [&] {
        const auto i = static_cast<double>(random() % 9), k = static_cast<double>(random() % 9);
        const Point2 p = frame().at(i * 0.25, k * 0.25);
        const double x = off(p.x);
        return Point2{x, off(p.y)};
    };
    for (int i = 0; i < 1500; ++i) {
        const Point2 a = point(), b = point(), c = point();
        tries.integrate({test::line({a, b, c}), test::ring({point(), b, {off(a.x), off(a.y)}})});
    }
    EXPECT_EQ(tries.broken(), 0) << "of " << tries.count();
    EXPECT_LE(tries.refused(), 8) << "of " << tries.count();
    std::cout << tries.refused() << " of " << tries.count() << " refused\n";
}

TEST_P(Lattice, LongSequencesOfSegmentsOnOneMesh) {
    // Later operations meet what earlier ones left; the mesh stays valid and its surface the same.
    std::mt19937_64 random(2);
    int refused = 0;
    for (int round = 0; round < 6; ++round) {
        Tin tin = test::built(laid(test::ring_of_cells(diagonals()), frame()));
        for (int step = 0; step < 30; ++step) {
            const auto point = [&] {
                const auto i = static_cast<double>(random() % 13);
                return frame().at(i / 3.0 - 0.5, static_cast<double>(random() % 13) / 3.0 - 0.5);
            };
            const Point2 a = point(), b = point(), c = point();
            const auto outcome = test::integrate_checked(tin, {test::line({a, b, c})}, {}, false);
            if (outcome.broken.starts_with("OUTSIDE_MESH")) continue;
            if (outcome.broken.starts_with("NOT_REPRESENTABLE") &&
                !outcome.broken.ends_with("changed")) {
                ++refused;
                continue;
            }
            ASSERT_EQ(outcome.broken, "") << "round " << round << " step " << step;
        }
    }
    EXPECT_LE(refused, 1);
}

std::string name_of(const testing::TestParamInfo<std::tuple<Frame, Diagonals>>& info) {
    std::string name = std::get<0>(info.param).name;
    for (char& letter : name)
        if (letter == ' ') letter = '_';
    const Diagonals diagonals = std::get<1>(info.param);
    return name + (diagonals == Diagonals::Rising ? "_rising" : "_alternate");
}

INSTANTIATE_TEST_SUITE_P(Frames, Lattice,
                         testing::Combine(testing::ValuesIn(kFrames),
                                          testing::Values(Diagonals::Rising, Diagonals::Alternate)),
                         name_of);

}  // namespace
}  // namespace tinsmith
