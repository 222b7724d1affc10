// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gltf_scene.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "api/formats/gltf_axes.hpp"
#include "api/formats/gltf_pieces.hpp"
#include "api/formats/gltf_plan.hpp"
#include "api/parts.hpp"
#include "api/unwritten.hpp"

namespace tinsmith::api {
namespace {

GlbPrimitive primitive_of(GlbMode mode, const SceneGroup* group) {
    GlbPrimitive primitive;
    primitive.mode = mode;
    if (group != nullptr) {
        primitive.features = group->features;
        primitive.polygons = group->polygons;
    }
    return primitive;
}

void set_box(GlbPrimitive& primitive, const Box<float>& box) {
    std::ranges::copy(box.low, primitive.low.begin());
    std::ranges::copy(box.high, primitive.high.begin());
}

/// `position_of` gives a vertex's float32 position in the file's axes.
template <std::size_t N, typename PositionOf>
GlbPrimitive plain_primitive(const SceneInput& input, const SceneGroup* group,
                             const Piece<N>& piece, const PositionOf& position_of) {
    GlbPrimitive primitive = primitive_of(N == 2 ? GlbMode::Lines : GlbMode::Triangles, group);
    primitive.positions.reserve(piece.vertices.size());
    Box<float> box;
    for (const std::uint32_t vertex : piece.vertices)
        box.add(primitive.positions.emplace_back(position_of(vertex)));
    set_box(primitive, box);
    if (N == 3 && !input.normals.empty()) {
        primitive.normals.reserve(piece.vertices.size());
        for (const std::uint32_t vertex : piece.vertices)
            primitive.normals.push_back(smooth_normal(input.normals[vertex], input.options.up));
    }
    primitive.indices.reserve(piece.corners.size() * N);
    for (const Corners<N>& corners : piece.corners)
        primitive.indices.insert(primitive.indices.end(), corners.begin(), corners.end());
    return primitive;
}

/// All triangles, in the mesh's own order.
GlbPrimitive whole_primitive(const SceneInput& input, PlainPositions positions,
                             const core::Executor& executor) {
    GlbPrimitive primitive = primitive_of(GlbMode::Triangles, nullptr);
    primitive.positions = std::move(positions.vertices);
    set_box(primitive, positions.box);
    primitive.normals.resize(input.normals.size());
    in_parts(executor, primitive.normals.size(), [&](Part part) {
        for (std::size_t i = part.begin; i < part.end; ++i)
            primitive.normals[i] = smooth_normal(input.normals[i], input.options.up);
    });
    static_assert(sizeof(input.mesh.triangles[0]) == 3 * sizeof(std::uint32_t));
    primitive.shared_indices = {input.mesh.triangles[0].data(), input.mesh.triangles.size() * 3};
    return primitive;
}

/// Piece cutters, one for each thread that needs one at a time: each knows all vertices.
class Cutters {
  public:
    explicit Cutters(std::size_t vertices) : vertices_(vertices) {}

    template <std::size_t N>
    Piece<N> cut(std::span<const Corners<N>> all, std::span<const std::uint32_t> chosen) {
        std::unique_ptr<PieceCutter> cutter = take();
        Piece<N> piece = cutter->cut<N>(all, chosen);
        const std::lock_guard lock(mutex_);
        free_.push_back(std::move(cutter));
        return piece;
    }

  private:
    std::unique_ptr<PieceCutter> take() {
        {
            const std::lock_guard lock(mutex_);
            if (!free_.empty()) {
                std::unique_ptr<PieceCutter> cutter = std::move(free_.back());
                free_.pop_back();
                return cutter;
            }
        }
        return std::make_unique<PieceCutter>(vertices_);
    }

    std::size_t vertices_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<PieceCutter>> free_;
};

/// Makes the primitives of one mesh on its grid, each by itself.
class PrimitiveMaker {
  public:
    PrimitiveMaker(const SceneInput& input, const PositionGrid& grid,
                   std::span<const GridPoint> points, bool one_node)
        : input_(input),
          grid_(grid),
          points_(points),
          one_node_(one_node),
          cutters_(points.size()) {}

    struct Made {
        GridPoint shift{};  ///< where its node stands, in steps
        GlbPrimitive primitive;
        std::optional<EncodeError> error;
    };

    Made make(const PlannedPiece& planned) {
        switch (planned.as) {
            case PlannedPiece::As::Lines:
                return plain<2>(planned, input_.mesh.constraints);
            case PlannedPiece::As::PlainTriangles:
                return plain<3>(planned, input_.mesh.triangles);
            case PlannedPiece::As::Draco:
            case PlannedPiece::As::Meshopt:
                break;
        }
        return compressed(planned);
    }

  private:
    /// The session's origin while float32 reaches the whole mesh from there, else whole metres near
    /// the middle of the piece.
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

    GridPoint local(std::uint32_t vertex, const GridPoint& shift) const {
        const GridPoint& point = points_[vertex];
        return {point[0] - shift[0], point[1] - shift[1], point[2] - shift[2]};
    }

    Made compressed(const PlannedPiece& planned) {
        const Piece<3> piece = cutters_.cut<3>(input_.mesh.triangles, planned.items);
        Made made{shift_for(piece.vertices), {}, {}};
        Unwritten<GridPoint> positions(piece.vertices.size());
        Unwritten<std::array<float, 3>> normals(input_.normals.empty() ? 0 : positions.size());
        Box<std::int32_t> box;
        for (std::size_t i = 0; i < positions.size(); ++i) {
            positions[i] = to_axes(local(piece.vertices[i], made.shift), input_.options.up);
            box.add(positions[i]);
        }
        for (std::size_t i = 0; i < normals.size(); ++i)
            normals[i] = smooth_normal(input_.normals[piece.vertices[i]], input_.options.up);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            made.primitive.low[axis] = grid_.step() * box.low[axis];
            made.primitive.high[axis] = grid_.step() * box.high[axis];
        }
        std::span<const std::uint16_t> features;
        if (planned.group != nullptr) {
            made.primitive.features = planned.group->features;
            made.primitive.polygons = planned.group->polygons;
            features = planned.group->features;
        }
        if (planned.as == PlannedPiece::As::Meshopt) {
            made.primitive.meshopt =
                encode_meshopt({positions, normals, piece.corners, grid_.exponent, features});
            return made;
        }
        auto encoded = encode_draco({positions, normals, piece.corners, grid_.exponent, features});
        if (auto* error = std::get_if<EncodeError>(&encoded)) {
            made.error = std::move(*error);
        } else {
            made.primitive.draco = std::get<DracoBytes>(std::move(encoded));
        }
        return made;
    }

    template <std::size_t N>
    Made plain(const PlannedPiece& planned, std::span<const Corners<N>> all) {
        const Piece<N> piece = cutters_.cut<N>(all, planned.items);
        const GridPoint shift = shift_for(piece.vertices);
        const auto step = static_cast<float>(grid_.step());
        return {shift,
                plain_primitive(input_, planned.group, piece,
                                [&](std::uint32_t vertex) {
                                    const GridPoint n =
                                        to_axes(local(vertex, shift), input_.options.up);
                                    return std::array<float, 3>{static_cast<float>(n[0]) * step,
                                                                static_cast<float>(n[1]) * step,
                                                                static_cast<float>(n[2]) * step};
                                }),
                {}};
    }

    const SceneInput& input_;
    const PositionGrid& grid_;
    std::span<const GridPoint> points_;
    bool one_node_;
    Cutters cutters_;
};

std::array<double, 3> translation_of(const PositionGrid& grid, const GridPoint& shift, UpAxis up) {
    std::array<double, 3> translation = grid.origin;
    for (std::size_t axis = 0; axis < 3; ++axis)
        translation[axis] += grid.step() * shift[axis];
    return to_axes(translation, up);
}

}  // namespace

std::variant<std::vector<GlbNode>, EncodeError> grid_nodes(const SceneInput& input,
                                                           const ScenePlan& plan,
                                                           const PositionGrid& grid,
                                                           std::span<const GridPoint> points,
                                                           const core::Executor& executor) {
    PrimitiveMaker maker(input, grid, points, plan.one_node);
    std::vector<PrimitiveMaker::Made> made(plan.pieces.size());
    std::vector<core::Job> jobs;
    for (std::size_t i = 0; i < made.size(); ++i)
        jobs.emplace_back([&, i] { made[i] = maker.make(plan.pieces[i]); });
    executor(jobs);

    std::vector<GlbNode> nodes;
    for (PrimitiveMaker::Made& piece : made) {
        if (piece.error) return *std::move(piece.error);
        if (nodes.empty() || !plan.one_node) {
            const std::string name =
                plan.one_node ? "terrain" : "terrain " + std::to_string(nodes.size());
            nodes.push_back({name, translation_of(grid, piece.shift, input.options.up), {}});
        }
        nodes.back().primitives.push_back(std::move(piece.primitive));
    }
    return nodes;
}

GlbNode plain_node(const SceneInput& input, const std::array<double, 3>& origin,
                   PlainPositions positions, const core::Executor& executor) {
    const auto position_of = [&](std::uint32_t vertex) { return positions.vertices[vertex]; };
    GlbNode node{"terrain", to_axes(origin, input.options.up), {}};
    PieceCutter cutter(positions.vertices.size());
    for (const SceneGroup& group : input.groups) {
        const Piece<3> piece = cutter.cut<3>(input.mesh.triangles, group.triangles);
        node.primitives.push_back(plain_primitive(input, &group, piece, position_of));
    }
    std::optional<GlbPrimitive> lines;
    if (input.options.constraints && !input.mesh.constraints.empty()) {
        const Piece<2> piece =
            cutter.cut<2>(input.mesh.constraints, all_of(input.mesh.constraints.size()));
        lines = plain_primitive(input, nullptr, piece, position_of);
    }
    if (input.groups.empty())
        node.primitives.push_back(whole_primitive(input, std::move(positions), executor));
    if (lines) node.primitives.push_back(*std::move(lines));
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
