// SPDX-License-Identifier: Apache-2.0
#include "api/formats/glb_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include "api/crs.hpp"
#include "api/formats/draco_decoder.hpp"
#include "api/formats/gltf_accessors.hpp"
#include "api/formats/gltf_count.hpp"
#include "api/formats/gltf_model.hpp"
#include "api/formats/vertex_welder.hpp"

namespace tinsmith::api {

namespace {

using Corners = std::array<std::uint32_t, 3>;

constexpr std::size_t kLines = 1, kTriangles = 4, kStrip = 5, kFan = 6;
constexpr std::size_t kMostDepth = 1000;  ///< of nodes in nodes

/// Points `a` then `b`: the affine part of the product.
GltfMatrix product(const GltfMatrix& a, const GltfMatrix& b) {
    GltfMatrix out{};
    for (std::size_t column = 0; column < 4; ++column)
        for (std::size_t row = 0; row < 4; ++row)
            for (std::size_t i = 0; i < 4; ++i)
                out[column * 4 + row] += a[i * 4 + row] * b[column * 4 + i];
    return out;
}

bool is_mirrored(const GltfMatrix& m) {
    return m[0] * (m[5] * m[10] - m[9] * m[6]) - m[4] * (m[1] * m[10] - m[9] * m[2]) +
               m[8] * (m[1] * m[6] - m[5] * m[2]) <
           0.0;
}

/// Only a translation: then nothing is multiplied, so that infinite and tiny numbers keep their
/// meaning and sums are rounded once.
bool is_moved_only(const GltfMatrix& m) {
    const GltfMatrix plain{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    return std::equal(m.begin(), m.begin() + 12, plain.begin());
}

core::Point3 placed(const GltfMatrix& m, bool moved_only, const core::Point3& p) {
    if (moved_only) return {p.x + m[12], p.y + m[13], p.z + m[14]};
    return {m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12],
            m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13],
            m[2] * p.x + m[6] * p.y + m[10] * p.z + m[14]};
}

struct Geometry {
    std::vector<core::Point3> positions;
    std::vector<Corners> triangles;
    std::vector<std::array<std::uint32_t, 2>> lines;
};

/// The corners of a triangle for each three indices, or for each index after the second.
std::vector<Corners> triangles_of(const std::vector<std::uint32_t>& indices, std::size_t mode) {
    std::vector<Corners> out;
    if (mode == kTriangles) {
        out.reserve(indices.size() / 3);
        for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
            out.push_back({indices[i], indices[i + 1], indices[i + 2]});
        return out;
    }
    for (std::size_t i = 0; i + 2 < indices.size(); ++i) {
        const std::uint32_t a = indices[i], b = indices[i + 1], c = indices[i + 2];
        const Corners corners = mode == kFan ? Corners{indices[0], b, c}
                                : i % 2 == 0 ? Corners{a, b, c}
                                             : Corners{b, a, c};
        // Strips go from one place to another by triangles that name a vertex twice.
        const bool is_bridge =
            corners[0] == corners[1] || corners[1] == corners[2] || corners[0] == corners[2];
        if (!is_bridge) out.push_back(corners);
    }
    return out;
}

class SceneReader {
  public:
    SceneReader(const GltfModel& model, const ReadLimits& limits, FaultLog& log)
        : model_(model), limits_(limits), log_(log), accessors_(model, limits, log) {}

    Terrain read() {
        if (told_triangles(model_, limits_.max_triangles) > limits_.max_triangles)
            stop({"TOO_MANY_TRIANGLES",
                  "The scene shows more than " + std::to_string(limits_.max_triangles) +
                      " triangles, each mesh in each of its places; no more are taken.",
                  "/nodes"});
        walk();
        // Vertices are numbered by triangles only: lines come when all of those are known.
        for (const Line& line : lines_)
            add_constraint(line);
        if (passed_over_ > 0)
            terrain_.notes.push_back(std::to_string(passed_over_) +
                                     " primitives of points or lines were passed over.");
        if (is_skinned_)
            terrain_.notes.push_back("Skins were passed over: the mesh is as it was bound.");
        terrain_.unit_is_said = true;
        if (const auto crs = normalise_crs(model_.crs)) terrain_.crs = *crs;
        terrain_.unit_before = unit_of_length(model_.unit_to_metre).value_or("");
        name_places();
        return std::move(terrain_);
    }

  private:
    using MatrixPtr = std::shared_ptr<const GltfMatrix>;
    struct Placed {
        std::size_t node;
        MatrixPtr around;  ///< of the nodes that it hangs on
        std::size_t depth;
    };
    using Line = std::array<core::Point3, 2>;

    void invalid(std::string detail, std::string pointer) {
        log_.add(FaultKind::Invalid, {"GLTF_INVALID", std::move(detail), std::move(pointer)});
    }

    void walk() {
        std::vector<bool> seen(model_.nodes.size(), false);
        std::vector<Placed> open;
        const auto still = std::make_shared<const GltfMatrix>(
            GltfMatrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
        for (std::size_t i = model_.roots.size(); i-- > 0;)
            open.push_back({model_.roots[i], still, 0});
        std::size_t done = 0;
        while (!open.empty() && !log_.full() && !is_stopped_) {
            const Placed at = open.back();
            open.pop_back();
            const std::string pointer = "/nodes/" + std::to_string(at.node);
            if (at.node >= model_.nodes.size()) {
                invalid("There is no such node.", pointer);
                continue;
            }
            // Each node hangs on one other at most, so that this comes to an end.
            if (seen[at.node] || at.depth > kMostDepth) {
                invalid("Nodes are no tree: this one is met twice, or lies too deep.", pointer);
                continue;
            }
            seen[at.node] = true;
            const GltfNode& node = model_.nodes[at.node];
            const MatrixPtr matrix = node.matrix ? std::make_shared<const GltfMatrix>(within(
                                                       *at.around, model_.matrices[*node.matrix]))
                                                 : at.around;
            for (std::size_t i = node.children.size(); i-- > 0;)
                open.push_back({node.children[i], matrix, at.depth + 1});
            if (node.mesh) read_mesh(*node.mesh, *matrix, pointer);
            is_skinned_ = is_skinned_ || node.is_skinned;
            share_ = static_cast<double>(++done) / static_cast<double>(seen.size());
            if (!is_stopped_ && limits_.progress && !limits_.progress(share_)) stop({});
        }
        if (terrain_.mesh.triangles.empty() && log_.empty())
            invalid("The scene has no triangle.", "/scenes");
    }

    static GltfMatrix within(const GltfMatrix& around, const GltfMatrix& own) {
        return is_moved_only(around) && is_moved_only(own) ? moved(around, own)
                                                           : product(around, own);
    }

    static GltfMatrix moved(GltfMatrix a, const GltfMatrix& b) {
        for (std::size_t i = 12; i < 15; ++i)
            a[i] += b[i];
        return a;
    }

    void read_mesh(std::size_t mesh, const GltfMatrix& matrix, const std::string& pointer) {
        if (mesh >= model_.meshes.size())
            return invalid("There is no mesh " + std::to_string(mesh) + ".", pointer + "/mesh");
        for (const GltfPrimitive& primitive : model_.meshes[mesh]) {
            if (log_.full() || is_stopped_) return;
            read_primitive(primitive, matrix);
            if (limits_.progress && !limits_.progress(share_)) stop({});
        }
    }

    /// Nothing more is read. No code: because the caller says so.
    void stop(Fault fault) {
        is_stopped_ = true;
        if (fault.code.empty())
            log_.add(FaultKind::Stopped, reading_stopped());
        else
            log_.add(FaultKind::TooLarge, std::move(fault));
    }

    void read_primitive(const GltfPrimitive& primitive, const GltfMatrix& matrix) {
        const bool is_ground =
            primitive.mode == kTriangles || primitive.mode == kStrip || primitive.mode == kFan;
        if (primitive.mode > kFan)
            return invalid("There is no mode " + std::to_string(primitive.mode) + ".",
                           primitive.pointer() + "/mode");
        if (!is_ground && !(model_.is_ours && primitive.mode == kLines)) {
            ++passed_over_;
            return;
        }
        auto geometry = primitive.draco ? unpacked(primitive) : plain(primitive);
        if (!geometry) return;
        // Nodes may show one mesh again and again, whose numbers are then got again.
        work_ += geometry->positions.size() + 3 * geometry->triangles.size() +
                 2 * geometry->lines.size();
        if (work_ > 4 * (limits_.max_vertices + 3 * limits_.max_triangles))
            return stop({"TOO_MANY_VERTICES",
                         "All primitives together have more vertices and indices than are taken.",
                         primitive.pointer()});
        add(primitive, std::move(*geometry), matrix);
    }

    std::optional<Geometry> unpacked(const GltfPrimitive& primitive) {
        if (primitive.mode != kTriangles) {
            invalid("Draco holds triangles only.", primitive.pointer());
            return std::nullopt;
        }
        const auto bytes = accessors_.view_bytes(primitive.draco->view, primitive.pointer());
        if (!bytes) return std::nullopt;
        auto decoded = decode_draco(*bytes, primitive.draco->position_id,
                                    std::max(limits_.max_vertices, 3 * limits_.max_triangles),
                                    limits_.max_triangles - terrain_.mesh.triangles.size());
        if (const auto* no = std::get_if<DracoRefusal>(&decoded)) {
            log_.add(no->is_too_large ? FaultKind::TooLarge : FaultKind::Invalid,
                     {"GLTF_DRACO", no->detail, primitive.pointer()});
            return std::nullopt;
        }
        auto& mesh = std::get<DracoMesh>(decoded);
        return Geometry{std::move(mesh.positions), std::move(mesh.triangles), {}};
    }

    std::optional<Geometry> plain(const GltfPrimitive& primitive) {
        if (!primitive.position) {
            invalid("It has no POSITION.", primitive.pointer());
            return std::nullopt;
        }
        auto positions = accessors_.positions(*primitive.position);
        if (!positions) return std::nullopt;
        std::vector<std::uint32_t> indices;
        if (primitive.indices) {
            auto read = accessors_.indices(*primitive.indices);
            if (!read) return std::nullopt;
            indices = std::move(*read);
        } else {
            for (std::uint32_t i = 0; i < positions->size(); ++i)
                indices.push_back(i);
        }
        const auto most = std::max_element(indices.begin(), indices.end());
        if (most != indices.end() && *most >= positions->size()) {
            invalid("Index " + std::to_string(most - indices.begin()) + " names vertex " +
                        std::to_string(*most) + "; there are " + std::to_string(positions->size()) +
                        ".",
                    primitive.pointer() + "/indices");
            return std::nullopt;
        }
        const std::size_t each = primitive.mode == kTriangles ? 3
                                 : primitive.mode == kLines   ? 2
                                                              : 1;
        if (indices.size() % each != 0) {
            invalid("Its " + std::to_string(indices.size()) + " indices are no multiple of " +
                        std::to_string(each) + ".",
                    primitive.pointer() + "/indices");
            return std::nullopt;
        }
        Geometry out{std::move(*positions), {}, {}};
        if (primitive.mode == kLines) {
            for (std::size_t i = 0; i < indices.size(); i += 2)
                out.lines.push_back({indices[i], indices[i + 1]});
        } else {
            out.triangles = triangles_of(indices, primitive.mode);
        }
        return out;
    }

    void add(const GltfPrimitive& primitive, Geometry geometry, const GltfMatrix& matrix) {
        auto& mesh = terrain_.mesh;
        if (geometry.triangles.size() > limits_.max_triangles - mesh.triangles.size())
            return stop({"TOO_MANY_TRIANGLES",
                         "The scene has more than " + std::to_string(limits_.max_triangles) +
                             " triangles; no more are taken.",
                         primitive.pointer()});
        if (geometry.lines.size() > limits_.max_vertices - lines_.size())
            return stop({"TOO_MANY_LINES",
                         "The scene has more than " + std::to_string(limits_.max_vertices) +
                             " lines; no more are taken.",
                         primitive.pointer()});
        const bool moved_only = is_moved_only(matrix);
        for (core::Point3& p : geometry.positions) {
            p = placed(matrix, moved_only, p);
            if (!model_.is_z_up) p = {p.x, 0.0 - p.z, p.y};
        }
        starts_->push_back({mesh.triangles.size(), primitive.pointer()});
        const bool mirrored = is_mirrored(matrix);
        const auto numbers = numbers_of(geometry, primitive);
        if (mesh.vertices.size() > limits_.max_vertices)
            return stop({"TOO_MANY_VERTICES",
                         "The scene has more than " + std::to_string(limits_.max_vertices) +
                             " vertices; no more are taken.",
                         primitive.pointer()});
        for (const auto& [a, b, c] : geometry.triangles) {
            mesh.triangles.push_back({numbers[a], numbers[b], numbers[c]});
            if (mirrored) std::swap(mesh.triangles.back()[1], mesh.triangles.back()[2]);
        }
        for (const auto& [from, to] : geometry.lines)
            lines_.push_back({geometry.positions[from], geometry.positions[to]});
    }

    /// Of the vertices that triangles use, in the order of the vertices.
    std::vector<std::uint32_t> numbers_of(const Geometry& geometry,
                                          const GltfPrimitive& primitive) {
        std::vector<std::uint32_t> numbers(geometry.positions.size(), UINT32_MAX);
        for (const Corners& corners : geometry.triangles)
            for (const std::uint32_t v : corners)
                numbers[v] = 0;
        for (std::uint32_t v = 0; v < numbers.size(); ++v)
            if (numbers[v] == 0 && terrain_.mesh.vertices.size() <= limits_.max_vertices)
                numbers[v] = number_of(v, geometry, primitive);
        return numbers;
    }

    std::uint32_t number_of(std::uint32_t v, const Geometry& geometry,
                            const GltfPrimitive& primitive) {
        const core::Point3& p = geometry.positions[v];
        for (const double value : {p.x, p.y, p.z}) {
            // Also where it is not a number.
            if (std::fabs(value) <= kMaxCoordinate) continue;
            Fault fault{"COORDINATE_OUT_OF_RANGE",
                        "Vertex " + std::to_string(v) +
                            " has a coordinate that is not finite, or beyond 1e9.",
                        primitive.pointer()};
            fault.index = v;
            log_.add(FaultKind::Invalid, std::move(fault));
            return 0;
        }
        return welder_.number_of(p);
    }

    /// Rounding may have brought both ends of a line together, or off the triangles' corners.
    void add_constraint(const Line& line) {
        const std::uint32_t from = welder_.find(line[0]), to = welder_.find(line[1]);
        if (from == UINT32_MAX || to == UINT32_MAX || from == to) return;
        terrain_.mesh.constraints.push_back({from, to});
    }

    void name_places() {
        terrain_.triangle_place = [starts = starts_](std::size_t t) {
            const auto next = std::upper_bound(
                starts->begin(), starts->end(), t,
                [](std::size_t at, const auto& start) { return at < start.first; });
            if (next == starts->begin()) return std::string("a primitive");
            const auto& [first, pointer] = *std::prev(next);
            return "triangle " + std::to_string(t - first) + " of " + pointer;
        };
    }

    const GltfModel& model_;
    const ReadLimits& limits_;
    FaultLog& log_;
    GltfAccessors accessors_;
    Terrain terrain_;
    VertexWelder welder_{terrain_.mesh.vertices};
    std::vector<Line> lines_;
    std::size_t passed_over_ = 0;
    std::size_t work_ = 0;     ///< numbers that were got so far
    double share_ = 0.0;       ///< of the nodes, that has been read
    bool is_stopped_ = false;  ///< a limit is passed, or the caller says so
    bool is_skinned_ = false;
    /// The first triangle of each primitive that was met, and where that stands.
    std::shared_ptr<std::vector<std::pair<std::size_t, std::string>>> starts_ =
        std::make_shared<std::vector<std::pair<std::size_t, std::string>>>();
};

}  // namespace

Parsed<Terrain> read_glb(std::string_view bytes, const ReadLimits& limits) {
    FaultLog log(limits.max_faults);
    const auto model = read_gltf_model(bytes, log);
    if (!model) return std::move(log).refusal<Terrain>();
    Terrain terrain = SceneReader(*model, limits, log).read();
    if (!log.empty()) return std::move(log).refusal<Terrain>();
    return terrain;
}

}  // namespace tinsmith::api
