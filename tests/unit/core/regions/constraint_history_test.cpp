// SPDX-License-Identifier: Apache-2.0
#include "core/regions/constraint_history.hpp"

#include "core/mesh/surgery.hpp"
#include "core/mesh/walk.hpp"
#include "tests/unit/core/regions/integrated.hpp"

namespace tinsmith::core {
namespace {

using test::integrated;
using Vertices = std::vector<VertexId>;

/// Each vertex of the chain is joined to the next by a constrained edge.
void expect_joined(const Tin& tin, const Vertices& chain) {
    for (std::size_t i = 1; i < chain.size(); ++i) {
        const Side edge = find_edge(tin, chain[i - 1], chain[i]);
        ASSERT_TRUE(edge.valid()) << "step " << i;
        EXPECT_TRUE(tin.is_constrained(edge)) << "step " << i;
    }
}

TEST(ConstraintHistory, LeavesAChainThatNothingSplitAsItIs) {
    Tin tin = test::built(test::grid(4, 4));
    const auto line = integrated(tin, test::line({{0.5, 0.25}, {3.5, 3.25}}));
    const Vertices& chain = line.report.chains[0].vertices;
    EXPECT_EQ(ConstraintHistory(tin).expand(chain), chain);
    EXPECT_EQ(ConstraintHistory(tin).expand({}), Vertices{});
    const Vertices one{{7}};
    EXPECT_EQ(ConstraintHistory(tin).expand(one), one);
}

TEST(ConstraintHistory, InsertsTheVerticesOfSplitsInOrder) {
    MeshData data = test::one_triangle(16);
    data.constraints = {{0, 1}};
    Tin tin = test::built(data);
    Surgery surgery(tin);
    // Split at 8, then 4 from the one side, 12 from the other, 2 and 14.
    const VertexId at8 = surgery.split_edge(find_edge(tin, {0}, {1}), {8, 0, 0});
    const VertexId at4 = surgery.split_edge(find_edge(tin, {0}, at8), {4, 0, 0});
    const VertexId at12 = surgery.split_edge(find_edge(tin, {1}, at8), {12, 0, 0});
    const VertexId at2 = surgery.split_edge(find_edge(tin, at4, {0}), {2, 0, 0});
    const VertexId at14 = surgery.split_edge(find_edge(tin, {1}, at12), {14, 0, 0});
    surgery.commit();
    const ConstraintHistory history(tin);
    const Vertices there{{0}, at2, at4, at8, at12, at14, {1}};
    const Vertices back(there.rbegin(), there.rend());
    const Vertices out{{0}, {1}}, home{{1}, {0}}, spike{{0}, {1}, {0}};
    EXPECT_EQ(history.expand(out), there);
    EXPECT_EQ(history.expand(home), back);
    Vertices both = there;
    both.insert(both.end(), back.begin() + 1, back.end());
    EXPECT_EQ(history.expand(spike), both);
    const Vertices middle{at8, {1}};
    EXPECT_EQ(history.expand(middle), (Vertices{at8, at12, at14, {1}}));
}

TEST(ConstraintHistory, SurvivesAHundredThousandSplitsOfOneEdge) {
    const double end = 0x1p17;
    Tin tin = test::built(MeshData{{{0, 0, 0}, {end, 0, 0}, {end / 2, end, 0}, {end / 2, -end, 0}},
                                   {{0, 1, 2}, {1, 0, 3}},
                                   {{0, 1}}});
    Surgery surgery(tin);
    VertexId last{0};
    constexpr std::uint32_t kSplits = 100'000;
    for (std::uint32_t i = 1; i <= kSplits; ++i)
        last = surgery.split_edge(find_edge(tin, last, {1}), {static_cast<double>(i), 0, 0});
    surgery.commit();
    const Vertices ends{{0}, {1}};
    const Vertices chain = ConstraintHistory(tin).expand(ends);
    ASSERT_EQ(chain.size(), kSplits + 2u);
    for (std::uint32_t i = 1; i <= kSplits; ++i)
        ASSERT_EQ(tin.plan(chain[i]).x, static_cast<double>(i));
}

/// A needle of an apex 2^-50 above the edge from 0 to 1, which is constrained.
MeshData needle() {
    return {{{0, 0, 0}, {4, 0, 0}, {2, 0x1p-50, 0}, {2, -3, 5}, {2, 3, 5}},
            {{0, 1, 2}, {1, 0, 3}, {2, 1, 4}, {0, 2, 4}},
            {{0, 1}}};
}

TEST(ConstraintHistory, GoesByTheApexThatAnEdgeAbsorbed) {
    Tin tin = test::built(needle());
    Surgery surgery(tin);
    surgery.absorb_apex({{0}, 0});
    surgery.commit();
    const Vertices ends{{0}, {1}};
    EXPECT_EQ(ConstraintHistory(tin).expand(ends), (Vertices{{0}, {2}, {1}}));
}

TEST(ConstraintHistory, TakesAnEdgeThatCameBack) {
    // After 0-1 gave way to 0-2-1, a swap brings it back: unconstrained it is not the line,
    // constrained it is, and split again it is by its newest split.
    Tin tin = test::built(needle());
    Surgery surgery(tin);
    surgery.absorb_apex({{0}, 0});
    const Side back = surgery.swap_edge(find_edge(tin, {2}, {3}));
    const Vertices ends{{0}, {1}};
    ASSERT_TRUE(find_edge(tin, {0}, {1}).valid());
    EXPECT_EQ(ConstraintHistory(tin).expand(ends), (Vertices{{0}, {2}, {1}}));
    surgery.mark_constrained(back);
    EXPECT_EQ(ConstraintHistory(tin).expand(ends), ends);
    const VertexId p = surgery.split_edge(back, {1, 0, 0});
    surgery.commit();
    const Vertices now = ConstraintHistory(tin).expand(ends);
    EXPECT_EQ(now, (Vertices{{0}, p, {1}}));
    expect_joined(tin, now);
    // Its first parts are constrained still, and along the line.
    using Edge = std::pair<VertexId, VertexId>;
    auto along = ConstraintHistory(tin).edges_along(ends);
    std::sort(along.begin(), along.end());
    EXPECT_EQ(along, (std::vector<Edge>{{{0}, {2}}, {{0}, p}, {{2}, {1}}, {p, {1}}}));
}

TEST(ConstraintHistory, HoldsThroughCrossingsSwapsAndUndo) {
    Tin tin = test::built(test::grid(8, 8, test::Diagonals::Alternate));
    const auto ring = integrated(tin, {{test::closed({{1.1, 1.3}, {6.7, 2.9}, {4.3, 6.9}})}});
    const auto cross = integrated(tin, {{test::box(2.2, 0.4, 5.1, 7.3)}});
    const Vertices& chain = ring.report.chains[0].vertices;
    const Vertices before = ConstraintHistory(tin).expand(chain);
    EXPECT_GT(before.size(), chain.size());
    expect_joined(tin, before);
    const auto line = integrated(tin, test::line({{0.5, 4.3}, {7.5, 1.2}}));
    const Vertices after = ConstraintHistory(tin).expand(chain);
    EXPECT_GT(after.size(), before.size());
    expect_joined(tin, after);
    take_back(tin, line.undo);
    EXPECT_EQ(ConstraintHistory(tin).expand(chain), before);
    take_back(tin, cross.undo);
    EXPECT_EQ(ConstraintHistory(tin).expand(chain), chain);
}

}  // namespace
}  // namespace tinsmith::core
