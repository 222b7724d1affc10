// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gltf_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "api/formats/gltf_pieces.hpp"

namespace tinsmith::api {
namespace {

/// Positions of `count` vertices: `vertex_of` gives
/// a vertex of the mesh, `position_of` that one's float32 position in session axes.
template <std::size_t N, typename VertexOf, typename PositionOf>
GlbPrimitive plain_positions(const SceneInput& input, const SceneGroup* group, std::size_t count,
                             const VertexOf& vertex_of, const PositionOf& position_of) {
    GlbPrimitive primitive;
    if (group != nullptr) {
        primitive.features = group->features;
        primitive.polygons = group->polygons;
    }
    primitive.mode = N == 2 ? GlbMode::Lines : GlbMode::Triangles;
    primitive.positions.resize(count * 3);
    Box<float> box;
    float* to = primitive.positions.data();
    for (std::size_t i = 0; i < count; ++i) {
        const std::array<float, 3> position = to_axes(position_of(vertex_of(i)), input.options.up);
        box.add(position);
        to = std::copy(position.begin(), position.end(), to);
    }
    std::copy(box.low.begin(), box.low.end(), primitive.low.begin());
    std::copy(box.high.begin(), box.high.end(), primitive.high.begin());
    return primitive;
}

template <std::size_t N, typename PositionOf>
GlbPrimitive plain_primitive(const SceneInput& input, const SceneGroup* group,
                             const Piece<N>& piece, const PositionOf& position_of) {
    GlbPrimitive primitive = plain_positions<N>(
        input, group, piece.vertices.size(), [&](std::size_t i) { return piece.vertices[i]; },
        position_of);
    if (N == 3 && !input.normals.empty()) {
        primitive.normals.reserve(piece.vertices.size());
        for (const std::uint32_t vertex : piece.vertices)
            primitive.normals.push_back(input.normals[vertex]);
    }
    primitive.indices.reserve(piece.corners.size() * N);
    for (const Corners<N>& corners : piece.corners)
        primitive.indices.insert(primitive.indices.end(), corners.begin(), corners.end());
    return primitive;
}

/// Makes the primitives and nodes of one mesh on its grid.
class GridSceneBuilder {
  public:
    GridSceneBuilder(const SceneInput& input, const PositionGrid& grid,
                     std::span<const GridPoint> points)
        : input_(input), grid_(grid), points_(points), cutter_(points.size()) {
        Box<std::int32_t> box;
        for (const GridPoint& point : points)
            box.add(point);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            fits_tile_ = fits_tile_ && box.high[axis] - box.low[axis] <= kDracoSteps;
            one_node_ = one_node_ && box.low[axis] >= -kFloatSteps && box.high[axis] <= kFloatSteps;
        }
    }

    std::variant<std::vector<GlbNode>, EncodeError> build() {
        if (input_.groups.empty()) {
            add_group({all_of(input_.mesh.triangles.size()), {}, {}});
        } else {
            for (const SceneGroup& group : input_.groups)
                add_group(group);
        }
        group_ = nullptr;
        if (input_.options.constraints)
            add_spread<2>(input_.mesh.constraints, all_of(input_.mesh.constraints.size()));
        if (error_) return *std::move(error_);
        return std::move(nodes_);
    }

  private:
    void add_group(const SceneGroup& group) {
        group_ = &group;
        const std::span<const Corners<3>> all = input_.mesh.triangles;
        if (input_.options.compression == Compression::Meshopt)
            return add_spread<3>(all, group.triangles);
        if (fits_tile_ && one_node_) return add_tile(group.triangles);
        Tiling tiling = split_into_tiles(boxes_of<3>(all, group.triangles), kDracoSteps);
        for (Items* items : pointers_to(tiling)) {
            for (std::uint32_t& item : *items)
                item = group.triangles[item];
        }
        for (const Items& tile : tiling.tiles)
            add_tile(tile);
        add_spread<3>(all, std::move(tiling.too_large));
    }

    static std::vector<Items*> pointers_to(Tiling& tiling) {
        std::vector<Items*> all{&tiling.too_large};
        for (Items& tile : tiling.tiles)
            all.push_back(&tile);
        return all;
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

    /// Where a piece's node stands, in steps: the session's origin while float32 reaches the whole
    /// mesh from there, else whole metres near the middle of the piece.
    GridPoint shift_for(std::span<const std::uint32_t> vertices) const {
        if (one_node_) return {};
        Box<std::int32_t> box;
        for (const std::uint32_t vertex : vertices)
            box.add(points_[vertex]);
        GridPoint shift{};
        const std::int32_t period = grid_.period();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int32_t middle = box.low[axis] + (box.high[axis] - box.low[axis]) / 2;
            shift[axis] = middle / period * period;
        }
        return shift;
    }

    std::vector<GlbPrimitive>& node_at(const GridPoint& shift) {
        if (nodes_.empty() || !one_node_) {
            std::array<double, 3> translation = grid_.origin;
            for (std::size_t axis = 0; axis < 3; ++axis)
                translation[axis] += grid_.step() * shift[axis];
            const std::string name =
                one_node_ ? "terrain" : "terrain " + std::to_string(nodes_.size());
            nodes_.push_back({name, to_axes(translation, input_.options.up), {}});
        }
        return nodes_.back().primitives;
    }

    GridPoint local(std::uint32_t vertex, const GridPoint& shift) const {
        const GridPoint& point = points_[vertex];
        return {point[0] - shift[0], point[1] - shift[1], point[2] - shift[2]};
    }

    /// A piece as it lies on the grid, in the file's axes.
    struct OnGrid {
        std::vector<GridPoint> positions;
        std::vector<std::array<float, 3>> normals;
        Box<std::int32_t> box;
    };

    OnGrid on_grid(const Piece<3>& piece, const GridPoint& shift) const {
        const UpAxis up = input_.options.up;
        OnGrid made;
        made.positions.reserve(piece.vertices.size());
        if (!input_.normals.empty()) made.normals.reserve(piece.vertices.size());
        for (const std::uint32_t vertex : piece.vertices) {
            made.positions.push_back(to_axes(local(vertex, shift), up));
            made.box.add(made.positions.back());
            if (!input_.normals.empty()) made.normals.push_back(input_.normals[vertex]);
        }
        return made;
    }

    void add_compressed(const GridPoint& shift, const OnGrid& piece, GlbPrimitive primitive) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            primitive.low[axis] = grid_.step() * piece.box.low[axis];
            primitive.high[axis] = grid_.step() * piece.box.high[axis];
        }
        primitive.features = group_->features;
        primitive.polygons = group_->polygons;
        node_at(shift).push_back(std::move(primitive));
    }

    void add_tile(std::span<const std::uint32_t> triangles) {
        const Piece<3> piece = cutter_.cut<3>(input_.mesh.triangles, triangles);
        const GridPoint shift = shift_for(piece.vertices);
        const OnGrid made = on_grid(piece, shift);
        auto encoded = encode_draco(
            {made.positions, made.normals, piece.corners, grid_.exponent, group_->features});
        if (const auto* error = std::get_if<EncodeError>(&encoded)) {
            error_ = *error;
            return;
        }
        GlbPrimitive primitive;
        primitive.draco = std::get<DracoBytes>(std::move(encoded));
        add_compressed(shift, made, std::move(primitive));
    }

    /// Triangles or edges without Draco, on the same grid. More nodes have a tiling of their own:
    /// float32 reaches kFloatSteps to both sides of a node that is half a metre off the middle.
    template <std::size_t N>
    void add_spread(std::span<const Corners<N>> all, Items items) {
        if (items.empty()) return;
        if (one_node_) return add_spread_piece<N>(all, items);
        Tiling tiling =
            split_into_tiles(boxes_of<N>(all, items), 2 * (kFloatSteps - grid_.period()));
        if (!tiling.too_large.empty()) {
            error_ = EncodeError{EncodeFault::ToleranceTooFine,
                                 "an edge is too long for float32 at this tolerance; ask for a "
                                 "coarser tolerance"};
            return;
        }
        for (Items& tile : tiling.tiles) {
            for (std::uint32_t& item : tile)
                item = items[item];
            add_spread_piece<N>(all, tile);
        }
    }

    template <std::size_t N>
    void add_spread_piece(std::span<const Corners<N>> all, std::span<const std::uint32_t> items) {
        const Piece<N> piece = cutter_.cut<N>(all, items);
        const GridPoint shift = shift_for(piece.vertices);
        if constexpr (N == 3) {
            if (input_.options.compression == Compression::Meshopt) {
                const OnGrid made = on_grid(piece, shift);
                GlbPrimitive primitive;
                primitive.meshopt = encode_meshopt({made.positions, made.normals, piece.corners,
                                                    grid_.exponent, group_->features});
                return add_compressed(shift, made, std::move(primitive));
            }
        }
        const float step = static_cast<float>(grid_.step());
        node_at(shift).push_back(plain_primitive(input_, group_, piece, [&](std::uint32_t vertex) {
            const GridPoint n = local(vertex, shift);
            return std::array<float, 3>{static_cast<float>(n[0]) * step,
                                        static_cast<float>(n[1]) * step,
                                        static_cast<float>(n[2]) * step};
        }));
    }

    const SceneInput& input_;
    const PositionGrid& grid_;
    std::span<const GridPoint> points_;
    PieceCutter cutter_;
    bool fits_tile_ = true;
    bool one_node_ = true;
    const SceneGroup* group_ = nullptr;  ///< that triangles are being added of
    std::vector<GlbNode> nodes_;
    std::optional<EncodeError> error_;
};

}  // namespace

std::variant<std::vector<GlbNode>, EncodeError> grid_nodes(const SceneInput& input,
                                                           const PositionGrid& grid,
                                                           std::span<const GridPoint> points) {
    return GridSceneBuilder(input, grid, points).build();
}

GlbNode plain_node(const SceneInput& input, const std::array<double, 3>& origin,
                   std::span<const std::array<float, 3>> positions) {
    const auto position_of = [&](std::uint32_t vertex) { return positions[vertex]; };
    GlbNode node{"terrain", to_axes(origin, input.options.up), {}};
    if (input.groups.empty()) {
        const auto itself = [](std::size_t i) { return static_cast<std::uint32_t>(i); };
        node.primitives.push_back(
            plain_positions<3>(input, nullptr, positions.size(), itself, position_of));
        static_assert(sizeof(input.mesh.triangles[0]) == 3 * sizeof(std::uint32_t));
        node.primitives.back().shared_normals = input.normals;
        node.primitives.back().shared_indices = {input.mesh.triangles[0].data(),
                                                 input.mesh.triangles.size() * 3};
    }
    PieceCutter cutter(positions.size());
    for (const SceneGroup& group : input.groups) {
        const Piece<3> piece = cutter.cut<3>(input.mesh.triangles, group.triangles);
        node.primitives.push_back(plain_primitive(input, &group, piece, position_of));
    }
    if (input.options.constraints && !input.mesh.constraints.empty()) {
        const Piece<2> lines =
            cutter.cut<2>(input.mesh.constraints, all_of(input.mesh.constraints.size()));
        node.primitives.push_back(plain_primitive(input, nullptr, lines, position_of));
    }
    return node;
}

std::vector<SceneGroup> groups_of(const RegionPartition& regions) {
    std::vector<SceneGroup> all(regions.sets.size());
    for (std::uint32_t t = 0; t < regions.set_of.size(); ++t)
        all[regions.set_of[t]].triangles.push_back(t);
    std::vector<SceneGroup> groups;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].triangles.empty()) continue;
        const std::vector<std::uint32_t>& set = regions.sets[i];
        for (const std::uint32_t feature : set)
            all[i].polygons.push_back(regions.features[feature].id);
        for (std::size_t k = 0; k < std::min(set.size(), kMostFeatureSets); ++k)
            all[i].features.push_back(static_cast<std::uint16_t>(set[set.size() - 1 - k]));
        if (set.empty())
            all[i].features.push_back(static_cast<std::uint16_t>(regions.features.size()));
        groups.push_back(std::move(all[i]));
    }
    return groups;
}

}  // namespace tinsmith::api
