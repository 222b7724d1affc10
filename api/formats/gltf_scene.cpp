// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gltf_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

namespace tinsmith::api {
namespace {

using Items = std::vector<std::uint32_t>;

template <std::size_t N>
using Corners = std::array<std::uint32_t, N>;

/// Part of the mesh with its own vertex numbers: vertex i of the piece is mesh vertex vertices[i].
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

Items all_of(std::size_t count) {
    Items items(count);
    std::iota(items.begin(), items.end(), std::uint32_t{0});
    return items;
}

template <typename T>
void append(std::vector<T>& to, const std::array<T, 3>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

/// Fills the plain arrays. `position_of` gives a mesh vertex's float32 position in session axes.
template <std::size_t N, typename PositionOf>
GlbPrimitive plain_primitive(const SceneInput& input, const Piece<N>& piece,
                             const PositionOf& position_of) {
    GlbPrimitive primitive;
    primitive.mode = N == 2 ? GlbMode::Lines : GlbMode::Triangles;
    const bool with_normals = N == 3 && !input.normals.empty();
    primitive.positions.reserve(piece.vertices.size() * 3);
    if (with_normals) primitive.normals.reserve(piece.vertices.size() * 3);
    Box<double> box;
    for (const std::uint32_t vertex : piece.vertices) {
        const std::array<float, 3> position = to_axes(position_of(vertex), input.options.up);
        box.add({position[0], position[1], position[2]});
        append(primitive.positions, position);
        if (with_normals)
            append(primitive.normals, to_axes(input.normals[vertex], input.options.up));
    }
    primitive.low = box.low;
    primitive.high = box.high;
    primitive.indices.reserve(piece.corners.size() * N);
    for (const Corners<N>& corners : piece.corners)
        primitive.indices.insert(primitive.indices.end(), corners.begin(), corners.end());
    return primitive;
}

/// Makes the primitives and nodes of one mesh on its grid.
class DracoSceneBuilder {
  public:
    DracoSceneBuilder(const SceneInput& input, const PositionGrid& grid,
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
        if (fits_tile_ && one_node_) {
            add_tile(all_of(input_.mesh.triangles.size()));
        } else {
            const std::vector<Box<std::int32_t>> boxes = boxes_of<3>(input_.mesh.triangles);
            Tiling tiling = split_into_tiles(boxes, kDracoSteps);
            for (const Items& tile : tiling.tiles)
                add_tile(tile);
            add_plain<3>(input_.mesh.triangles, std::move(tiling.too_large));
        }
        if (input_.options.constraints)
            add_plain<2>(input_.mesh.constraints, all_of(input_.mesh.constraints.size()));
        if (error_) return *std::move(error_);
        return std::move(nodes_);
    }

  private:
    template <std::size_t N>
    std::vector<Box<std::int32_t>> boxes_of(std::span<const Corners<N>> all) const {
        std::vector<Box<std::int32_t>> boxes(all.size());
        for (std::size_t item = 0; item < all.size(); ++item) {
            for (const std::uint32_t vertex : all[item])
                boxes[item].add(points_[vertex]);
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

    void add_tile(std::span<const std::uint32_t> triangles) {
        const Piece<3> piece = cutter_.cut<3>(input_.mesh.triangles, triangles);
        const GridPoint shift = shift_for(piece.vertices);
        const UpAxis up = input_.options.up;
        std::vector<GridPoint> positions;
        std::vector<std::array<float, 3>> normals;
        positions.reserve(piece.vertices.size());
        if (!input_.normals.empty()) normals.reserve(piece.vertices.size());
        Box<std::int32_t> box;
        for (const std::uint32_t vertex : piece.vertices) {
            positions.push_back(to_axes(local(vertex, shift), up));
            box.add(positions.back());
            if (!input_.normals.empty()) normals.push_back(to_axes(input_.normals[vertex], up));
        }
        auto encoded = encode_draco({positions, normals, piece.corners, grid_.exponent});
        if (const auto* error = std::get_if<EncodeError>(&encoded)) {
            error_ = *error;
            return;
        }
        GlbPrimitive primitive;
        primitive.draco = std::get<DracoBytes>(std::move(encoded));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            primitive.low[axis] = grid_.step() * box.low[axis];
            primitive.high[axis] = grid_.step() * box.high[axis];
        }
        node_at(shift).push_back(std::move(primitive));
    }

    /// Triangles or edges without compression, on the same grid. More nodes have a tiling of their
    /// own: float32 reaches kFloatSteps to both sides of a node that is half a metre off the
    /// middle.
    template <std::size_t N>
    void add_plain(std::span<const Corners<N>> all, Items items) {
        if (items.empty()) return;
        if (one_node_) return add_plain_piece<N>(all, items);
        std::vector<Box<std::int32_t>> boxes;
        const std::vector<Box<std::int32_t>> all_boxes = boxes_of<N>(all);
        for (const std::uint32_t item : items)
            boxes.push_back(all_boxes[item]);
        Tiling tiling = split_into_tiles(boxes, 2 * (kFloatSteps - grid_.period()));
        if (!tiling.too_large.empty()) {
            error_ = EncodeError{EncodeFault::ToleranceTooFine,
                                 "an edge is too long for float32 at this tolerance; ask for a "
                                 "coarser tolerance"};
            return;
        }
        for (Items& tile : tiling.tiles) {
            for (std::uint32_t& item : tile)
                item = items[item];
            add_plain_piece<N>(all, tile);
        }
    }

    template <std::size_t N>
    void add_plain_piece(std::span<const Corners<N>> all, std::span<const std::uint32_t> items) {
        const Piece<N> piece = cutter_.cut<N>(all, items);
        const GridPoint shift = shift_for(piece.vertices);
        const float step = static_cast<float>(grid_.step());
        node_at(shift).push_back(plain_primitive(input_, piece, [&](std::uint32_t vertex) {
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
    std::vector<GlbNode> nodes_;
    std::optional<EncodeError> error_;
};

}  // namespace

std::vector<std::array<float, 3>> smooth_normals(const core::MeshData& mesh) {
    std::vector<std::array<double, 3>> sums(mesh.vertices.size());
    for (const auto& corners : mesh.triangles) {
        const core::Point3& a = mesh.vertices[corners[0]];
        const core::Point3& b = mesh.vertices[corners[1]];
        const core::Point3& c = mesh.vertices[corners[2]];
        const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
        const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
        // The cross product's length is twice the area: the weight comes by itself.
        const std::array<double, 3> normal{uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx};
        for (const std::uint32_t vertex : corners) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                sums[vertex][axis] += normal[axis];
        }
    }
    std::vector<std::array<float, 3>> normals;
    normals.reserve(sums.size());
    for (const auto& [x, y, z] : sums) {
        const double length = std::sqrt(x * x + y * y + z * z);
        // Triangles of a session are never flat in plan; only rounding to zero comes here.
        if (!(length > 0.0) || !std::isfinite(length)) {
            normals.push_back({0.0F, 0.0F, 1.0F});
            continue;
        }
        normals.push_back({static_cast<float>(x / length), static_cast<float>(y / length),
                           static_cast<float>(z / length)});
    }
    return normals;
}

std::variant<std::vector<GlbNode>, EncodeError> draco_nodes(const SceneInput& input,
                                                            const PositionGrid& grid,
                                                            std::span<const GridPoint> points) {
    return DracoSceneBuilder(input, grid, points).build();
}

GlbNode plain_node(const SceneInput& input, const std::array<double, 3>& origin,
                   std::span<const std::array<float, 3>> positions) {
    const auto position_of = [&](std::uint32_t vertex) { return positions[vertex]; };
    GlbNode node{"terrain", to_axes(origin, input.options.up), {}};
    const Piece<3> whole{all_of(positions.size()), input.mesh.triangles};
    node.primitives.push_back(plain_primitive(input, whole, position_of));
    if (input.options.constraints && !input.mesh.constraints.empty()) {
        const Piece<2> lines =
            PieceCutter(positions.size())
                .cut<2>(input.mesh.constraints, all_of(input.mesh.constraints.size()));
        node.primitives.push_back(plain_primitive(input, lines, position_of));
    }
    return node;
}

}  // namespace tinsmith::api
