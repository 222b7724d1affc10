// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gltf_plan.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <utility>

#include "api/unwritten.hpp"

namespace tinsmith::api {
namespace {

class ScenePlanner {
  public:
    ScenePlanner(const SceneInput& input, const PositionGrid& grid,
                 std::span<const GridPoint> points)
        : input_(input), grid_(grid), points_(points) {
        for (const GridPoint& point : points)
            box_.add(point);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            fits_tile_ = fits_tile_ && box_.high[axis] - box_.low[axis] <= kDracoSteps;
            plan_.one_node =
                plan_.one_node && box_.low[axis] >= -kFloatSteps && box_.high[axis] <= kFloatSteps;
        }
    }

    std::variant<ScenePlan, EncodeError> plan() {
        if (input_.groups.empty()) add_group(nullptr, all_of(input_.mesh.triangles.size()));
        for (const SceneGroup& group : input_.groups)
            add_group(&group, group.triangles);
        if (input_.options.constraints)
            add_spread<2>(As::Lines, nullptr, input_.mesh.constraints,
                          all_of(input_.mesh.constraints.size()));
        if (error_) return *std::move(error_);
        return std::move(plan_);
    }

  private:
    using As = PlannedPiece::As;

    void add_group(const SceneGroup* group, Items triangles) {
        const std::span<const Corners<3>> all = input_.mesh.triangles;
        if (input_.options.compression == Compression::Meshopt)
            return add_spread<3>(As::Meshopt, group, all, std::move(triangles));
        if (fits_tile_ && plan_.one_node) return add_halves(As::Draco, group, std::move(triangles));
        Tiling tiling = split_into_tiles(boxes_of<3>(all, triangles), kDracoSteps);
        for (Items& tile : tiling.tiles)
            add_halves(As::Draco, group, named(std::move(tile), triangles));
        add_spread<3>(As::PlainTriangles, group, all,
                      named(std::move(tiling.too_large), triangles));
    }

    /// Places in a list become what is there.
    static Items named(Items places, const Items& list) {
        for (std::uint32_t& place : places)
            place = list[place];
        return places;
    }

    template <std::size_t N>
    std::vector<Box<std::int32_t>> boxes_of(std::span<const Corners<N>> all,
                                            std::span<const std::uint32_t> items) const {
        std::vector<Box<std::int32_t>> boxes(items.size());
        for (std::size_t i = 0; i < items.size(); ++i) {
            for (const std::uint32_t vertex : all[items[i]])
                boxes[i].add(points_[vertex]);
        }
        return boxes;
    }

    /// Triangles or edges without Draco, on the same grid. More nodes have a tiling of their own:
    /// float32 reaches kFloatSteps to both sides of a node that is half a metre off the middle.
    template <std::size_t N>
    void add_spread(As as, const SceneGroup* group, std::span<const Corners<N>> all, Items items) {
        if (items.empty()) return;
        if (plan_.one_node) return add_halves(as, group, std::move(items));
        Tiling tiling =
            split_into_tiles(boxes_of<N>(all, items), 2 * (kFloatSteps - grid_.period()));
        if (!tiling.too_large.empty()) {
            error_ = EncodeError{EncodeFault::ToleranceTooFine,
                                 "an edge is too long for float32 at this tolerance; ask for a "
                                 "coarser tolerance"};
            return;
        }
        for (Items& tile : tiling.tiles)
            add_halves(as, group, named(std::move(tile), items));
    }

    void add_halves(As as, const SceneGroup* group, Items items) {
        std::vector<Items> pending;
        pending.push_back(std::move(items));
        // Ends: both halves have fewer than what they are halves of.
        while (!pending.empty()) {
            Items piece = std::move(pending.back());
            pending.pop_back();
            std::optional<Items> second;
            if (as == As::Draco || as == As::Meshopt) second = take_second_half(piece);
            if (!second) {
                plan_.pieces.push_back({as, group, std::move(piece)});
                continue;
            }
            pending.push_back(*std::move(second));
            pending.push_back(std::move(piece));
        }
    }

    /// Leaves the triangles on one side of a line across the longer axis of the plan, about half of
    /// them, and gives the others; nothing where there are too few to be halved. A triangle is
    /// where its first corner is; the line is one of many, so that no sorting is needed.
    std::optional<Items> take_second_half(Items& triangles) const {
        if (triangles.size() <= kMostInOnePiece) return std::nullopt;
        const auto corner = [&](std::uint32_t t) -> const GridPoint& {
            return points_[input_.mesh.triangles[t][0]];
        };
        const bool is_whole = triangles.size() == input_.mesh.triangles.size();
        Box<std::int32_t> box;
        if (is_whole) box = box_;
        for (std::size_t i = 0; i < triangles.size() && !is_whole; ++i)
            box.add(corner(triangles[i]));
        const std::int64_t width = std::int64_t{box.high[0]} - box.low[0];
        const std::int64_t height = std::int64_t{box.high[1]} - box.low[1];
        const std::size_t axis = width >= height ? 0 : 1;
        // 2^11 to 2^12 strips, as wide as a power of two.
        constexpr int kStripBits = 12;
        const int shift = std::max(
            0,
            static_cast<int>(std::bit_width(static_cast<std::uint64_t>(std::max(width, height)))) -
                kStripBits);
        Unwritten<std::uint16_t> strips(triangles.size());
        // Neighbours in the list lie in one strip mostly: in turns, so that none waits for the
        // last.
        std::array<std::array<std::uint32_t, 2>, std::size_t{1} << kStripBits> counts{};
        for (std::size_t i = 0; i < strips.size(); ++i) {
            const std::int64_t along = std::int64_t{corner(triangles[i])[axis]} - box.low[axis];
            strips[i] = static_cast<std::uint16_t>(along >> shift);
            ++counts[strips[i]][i % 2];
        }
        const auto count = [&](std::size_t strip) {
            return std::size_t{counts[strip][0]} + counts[strip][1];
        };
        std::size_t line = 0, before = count(0);
        while (before < triangles.size() / 2)
            before += count(++line);
        if (before == triangles.size()) before -= count(line--);
        if (before == 0) return std::nullopt;
        // Each is written to both places and counted in one: no branch that half of them take. The
        // last may be written beyond the second half.
        Items second(triangles.size() - before + 1);
        std::size_t left = 0, right = 0;
        for (std::size_t i = 0; i < strips.size(); ++i) {
            const std::uint32_t t = triangles[i];
            const bool is_first = strips[i] <= line;
            triangles[left] = t;
            second[right] = t;
            left += is_first ? 1 : 0;
            right += is_first ? 0 : 1;
        }
        triangles.resize(left);
        second.resize(right);
        return second;
    }

    const SceneInput& input_;
    const PositionGrid& grid_;
    std::span<const GridPoint> points_;
    Box<std::int32_t> box_;
    bool fits_tile_ = true;
    ScenePlan plan_;
    std::optional<EncodeError> error_;
};

}  // namespace

std::variant<ScenePlan, EncodeError> plan_scene(const SceneInput& input, const PositionGrid& grid,
                                                std::span<const GridPoint> points) {
    return ScenePlanner(input, grid, points).plan();
}

}  // namespace tinsmith::api
