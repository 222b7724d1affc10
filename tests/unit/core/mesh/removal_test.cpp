// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <set>

#include <gtest/gtest.h>

#include "core/mesh/check.hpp"
#include "core/mesh/components.hpp"
#include "core/mesh/surgery.hpp"
#include "core/mesh/walk.hpp"
#include "tests/support/random_input.hpp"
#include "tests/support/same_tin.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith::core {
namespace {

using test::built;

Undo remove(Tin& tin, std::vector<TriangleId> gone) {
    Surgery surgery(tin);
    surgery.remove(gone);
    Undo undo;
    undo.push_back(surgery.commit());
    return undo;
}

/// The triangles by their corners' positions, whatever their slots.
std::multiset<std::array<double, 9>> by_position(const Tin& tin,
                                                 const std::set<std::uint32_t>& without = {}) {
    std::multiset<std::array<double, 9>> found;
    for (std::uint32_t t = 0; t < tin.triangle_count(); ++t) {
        if (without.count(t) != 0) continue;
        std::array<std::array<double, 3>, 3> corners{};
        for (std::size_t i = 0; i < 3; ++i) {
            const Point3 p = tin.vertex(tin.triangle({t}).vertices[i]).point();
            corners[i] = {p.x, p.y, p.z};
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
                    corners.end());
        std::array<double, 9> flat{};
        for (std::size_t i = 0; i < 9; ++i)
            flat[i] = corners[i / 3][i % 3];
        found.insert(flat);
    }
    return found;
}

/// What the indices say, by looking at all that there is.
void expect_indexed(const Tin& tin) {
    EXPECT_EQ(tin.components(), find_components(tin));
    std::set<std::uint32_t> starts, named;
    for (std::uint32_t t = 0; t < tin.triangle_count(); ++t) {
        const auto& [a, b, c] = tin.triangle({t}).vertices;
        const Point2 p = tin.plan(a), q = tin.plan(b), r = tin.plan(c);
        const Point2 centre{(p.x + q.x + r.x) / 3, (p.y + q.y + r.y) / 3};
        ASSERT_LT(tin.hint(centre).index(), tin.triangle_count());
        const Location here = locate(tin, centre, tin.hint(centre));
        EXPECT_EQ(here.side.triangle(), TriangleId{t});
        for (unsigned i = 0; i < 3; ++i) {
            const Side side({t}, i);
            if (tin.twin(side).valid()) continue;
            starts.insert(tin.origin(side).value);
            for (const VertexId v :
                 tin.boundary().near(tin.plan(tin.origin(side)), tin.plan(tin.destination(side))))
                named.insert(v.value);
        }
    }
    EXPECT_EQ(named, starts);
    Bounds box{tin.vertex({0}).point(), tin.vertex({0}).point()};
    for (std::uint32_t v = 0; v < tin.vertex_count(); ++v) {
        const Point3 p = tin.vertex({v}).point();
        box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), std::min(box.min.z, p.z)};
        box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), std::max(box.max.z, p.z)};
    }
    EXPECT_EQ(tin.bounds().min, box.min);
    EXPECT_EQ(tin.bounds().max, box.max);
}

TEST(Removal, MovesTheLastSlotsIntoTheGaps) {
    Tin tin = built(test::grid(2, 2));  // 8 triangles, 9 vertices
    const auto last = tin.triangle({7}).vertices;
    const Tin before = tin;
    const Undo undo = remove(tin, {{0}, {1}});
    EXPECT_TRUE(check_tin(tin).empty());
    EXPECT_EQ(tin.triangle_count(), 6U);
    EXPECT_EQ(tin.vertex_count(), 8U) << "the corner is gone";
    // Vertex 8 went to slot 0, triangle 7 to slot 0 and triangle 6 to slot 1.
    auto corners = last;
    std::replace(corners.begin(), corners.end(), VertexId{8}, VertexId{0});
    EXPECT_EQ(tin.triangle({0}).vertices, corners);
    EXPECT_EQ(tin.name({0}), VertexId{8});
    EXPECT_EQ(tin.plan({0}), (Point2{2, 2}));
    expect_indexed(tin);
    take_back(tin, undo);
    EXPECT_TRUE(test::same_tin(tin, before));
    expect_indexed(tin);
}

/// In destructors nothing may fail: what memory there was is the mesh's again.
TEST(Removal, OfARecordThatIsNotNeededNothingIsCopied) {
    for (const bool again : {false, true}) {
        Tin tin = built(test::grid(4, 4));
        if (again) remove(tin, {{4}, {5}});
        const Tin before = tin;
        const TriangleId* const components = tin.components().data();
        Undo undo = remove(tin, {{0}, {1}});
        EXPECT_NE(tin.components().data(), components);
        take_back(tin, std::move(undo));
        EXPECT_EQ(tin.components().data(), components);
        EXPECT_TRUE(test::same_tin(tin, before));
        expect_indexed(tin);
        {
            Surgery surgery(tin);
            surgery.remove(std::vector<TriangleId>{{0}, {1}});
        }
        EXPECT_EQ(tin.components().data(), components);
        EXPECT_TRUE(test::same_tin(tin, before));
    }
}

TEST(Removal, PartsAVertexBetweenTwoFans) {
    Tin tin = built(test::grid(2, 2));
    // Of the four cells around the middle two that touch there alone are left.
    const Undo undo = remove(tin, {{0}, {1}, {6}, {7}});
    EXPECT_TRUE(check_tin(tin).empty());
    EXPECT_EQ(tin.triangle_count(), 4U);
    EXPECT_EQ(tin.vertex_count(), 8U) << "9, less two corners, and a copy of the middle";
    EXPECT_EQ(tin.components().size(), 2U);
    std::vector<VertexId> middle;
    for (std::uint32_t v = 0; v < tin.vertex_count(); ++v)
        if (tin.plan({v}) == Point2{1, 1}) middle.push_back({v});
    ASSERT_EQ(middle.size(), 2U);
    EXPECT_EQ(tin.name(middle[0]), tin.name(middle[1]));
    expect_indexed(tin);
    // What comes later has a name of its own.
    const Shape point{{{{{1.5, 0.25}}, false}}};
    ASSERT_TRUE(integrate(tin, {&point, 1}, {}).ok());
    EXPECT_EQ(tin.name({8}), VertexId{9});
}

TEST(Removal, LeavesAWholeMeshWhateverGoesAndComesBackBitForBit) {
    for (std::uint64_t seed = 1; seed <= 600; ++seed) {
        SCOPED_TRACE(seed);
        test::Random random(seed);
        const auto kind = static_cast<test::MeshKind>(test::pick(random, test::kMeshKinds));
        const MeshData data = test::random_mesh(random, kind, 2 + test::pick(random, 5));
        if (data.triangles.size() < 2) continue;
        Tin tin = built(data);
        std::vector<std::pair<Tin, Undo>> steps;
        for (int round = 0; round < 4 && tin.triangle_count() > 1; ++round) {
            if (round % 2 == 1) {
                const Shape shape = test::random_shape(random, test::ShapeKind::Ring, data);
                Tin before = tin;
                Undo undo;
                if (integrate(tin, {&shape, 1}, {}, &undo))
                    steps.emplace_back(std::move(before), std::move(undo));
                continue;
            }
            const int one_in = 2 + test::pick(random, 10);
            std::vector<TriangleId> gone;
            std::set<std::uint32_t> out;
            for (std::uint32_t t = 0; t < tin.triangle_count(); ++t) {
                if (test::pick(random, one_in) != 0) continue;
                gone.push_back({t});
                out.insert(t);
            }
            if (gone.size() == tin.triangle_count()) continue;
            const auto expected = by_position(tin, out);
            Tin before = tin;
            steps.emplace_back(std::move(before), remove(tin, gone));
            ASSERT_TRUE(check_tin(tin).empty()) << check_tin(tin)[0].detail;
            ASSERT_EQ(by_position(tin), expected);
            expect_indexed(tin);
            // A mesh that is read from these buffers is the same, no vertex more: fans are parted.
            const auto again = build_tin(tin.to_data());
            ASSERT_TRUE(again.ok());
            EXPECT_EQ(again->vertex_count(), tin.vertex_count());
        }
        for (; !steps.empty(); steps.pop_back()) {
            take_back(tin, steps.back().second);
            ASSERT_TRUE(test::same_tin(tin, steps.back().first));
            expect_indexed(tin);
        }
    }
}

TEST(Removal, IsTakenBackWhereItIsNotKept) {
    Tin tin = built(test::grid(3, 3));
    const Tin before = tin;
    {
        Surgery surgery(tin);
        const std::vector<TriangleId> gone{{3}, {8}, {9}};
        surgery.remove(gone);
        EXPECT_EQ(tin.triangle_count(), 15U);
    }
    EXPECT_TRUE(test::same_tin(tin, before));
}

TEST(Removal, ACopyCanTakeItBack) {
    Tin tin = built(test::grid(6, 6));
    const Tin before = tin;
    std::vector<TriangleId> gone;
    for (std::uint32_t t = 4; t < tin.triangle_count(); ++t)
        gone.push_back({t});
    const Undo undo = remove(tin, gone);
    Tin copy = tin;  // with room for little more than what is left
    take_back(copy, undo);
    EXPECT_TRUE(test::same_tin(copy, before));
    EXPECT_TRUE(check_tin(copy).empty());
}

}  // namespace
}  // namespace tinsmith::core
