// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gltf.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "api/formats/gltf_scene.hpp"
#include "api/formats/gltf_writer.hpp"
#include "api/formats/quantization.hpp"
#include "core/predicates/orientation.hpp"
#include "core/types/range.hpp"

namespace tinsmith::api {
namespace {

/// Draco counts corners in ints.
constexpr std::size_t kMostTriangles = std::numeric_limits<std::int32_t>::max() / 3;
/// 2^32 - 1 is no index in glTF.
constexpr std::size_t kMostVertices = std::numeric_limits<std::uint32_t>::max() - 1;
/// Jobs on fewer triangles take no longer than a thread takes to start.
constexpr std::size_t kWorthHelp = std::size_t{1} << 16;
/// A thousand kilometres: keeps every length in metres well inside float32's range.
constexpr double kLargestUnit = 1e6;

std::string as_text(double number) {
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
    return {text.data(), end};
}

bool usable(double coordinate) {
    return std::fabs(coordinate) <= core::kCoordinateLimit;
}

template <std::size_t N>
bool names_vertices(const std::array<std::uint32_t, N>& corners, std::size_t vertices) {
    for (std::size_t i = 0; i < N; ++i) {
        if (corners[i] >= vertices || corners[i] == corners[(i + 1) % N]) return false;
    }
    return true;
}

EncodeError bad_mesh(const char* what, std::size_t index) {
    return {EncodeFault::BadMesh, what + std::to_string(index)};
}

std::optional<EncodeError> find_wild_vertex(const core::MeshData& mesh) {
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const core::Point3& v = mesh.vertices[i];
        if (!usable(v.x) || !usable(v.y) || !usable(v.z))
            return bad_mesh("a coordinate that is not finite or too large at vertex ", i);
    }
    return std::nullopt;
}

std::optional<EncodeError> find_wrong_index(const core::MeshData& mesh) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (!names_vertices(mesh.triangles[i], mesh.vertices.size()))
            return bad_mesh("a wrong vertex index in triangle ", i);
    }
    for (std::size_t i = 0; i < mesh.constraints.size(); ++i) {
        if (!names_vertices(mesh.constraints[i], mesh.vertices.size()))
            return bad_mesh("a wrong vertex index in constraint ", i);
    }
    return std::nullopt;
}

/// Draco's encoder is not hardened: what it takes for granted is looked at here. The bounds come by
/// the way.
std::optional<EncodeError> find_fault(const core::MeshData& mesh, const GltfOptions& options,
                                      const RegionPartition* regions,
                                      const core::Executor& executor, Box<double>& bounds) {
    if (regions != nullptr && regions->features.size() > kMostRegionFeatures)
        return EncodeError{EncodeFault::BadOption,
                           "regions=true numbers at most " + std::to_string(kMostRegionFeatures) +
                               " polygons, there are " + std::to_string(regions->features.size())};
    if (!(options.tolerance > 0.0) || !std::isfinite(options.tolerance))
        return EncodeError{EncodeFault::BadOption, "tolerance must be a positive number of metres"};
    if (!(options.unit_to_metre > 0.0 && options.unit_to_metre <= kLargestUnit))
        return EncodeError{EncodeFault::BadOption, "the unit must be a positive length"};
    if (mesh.triangles.empty())
        return EncodeError{EncodeFault::BadMesh, "the mesh has no triangle"};
    if (mesh.triangles.size() > kMostTriangles || mesh.vertices.size() > kMostVertices)
        return EncodeError{EncodeFault::TooLarge, "the mesh is too large; ask for a smaller bbox"};
    std::optional<EncodeError> of_vertices, of_indices;
    const std::array<core::Job, 3> jobs{
        [&] { bounds = bounds_in_metres(mesh, options.unit_to_metre); },
        [&] { of_indices = find_wrong_index(mesh); },
        [&] { of_vertices = find_wild_vertex(mesh); }};
    executor(jobs);
    return of_vertices ? of_vertices : of_indices;
}

std::vector<std::pair<std::string, GlbExtra>> extras_of(const core::MeshData& mesh,
                                                        const GltfOptions& options,
                                                        const GltfResult& result) {
    std::vector<std::pair<std::string, GlbExtra>> extras{
        {"origin", result.origin},
        {"up", options.up == UpAxis::Y ? std::string("y") : std::string("z")},
        {"unit_to_metre", options.unit_to_metre},
        {"tolerance", options.tolerance},
        {"step", result.step},
        {"position_bits", std::size_t{result.bits}},
        {"max_error", result.max_error},
        {"axis_error", result.axis_error},
        {"vertices", mesh.vertices.size()},
        {"triangles", mesh.triangles.size()},
        {"constraints", mesh.constraints.size()},
        {"primitives", result.primitives},
        {"flipped", result.flipped},
        {"collapsed", result.collapsed}};
    if (!options.crs.empty()) extras.emplace_back("crs", options.crs);
    return extras;
}

/// What Draco drops or what rounds too far is an error here, not a surprise for a client.
std::optional<EncodeError> count_primitives(const core::MeshData& mesh, const GltfOptions& options,
                                            const std::vector<GlbNode>& nodes, GltfResult& result) {
    std::size_t triangles = 0;
    result.nodes = nodes.size();
    for (const GlbNode& node : nodes) {
        for (const GlbPrimitive& primitive : node.primitives) {
            if (primitive.mode != GlbMode::Triangles) continue;
            ++result.primitives;
            triangles += primitive.draco     ? primitive.draco->triangles
                         : primitive.meshopt ? primitive.meshopt->indices.count / 3
                                             : primitive.plain_indices().size() / 3;
            if (primitive.draco)
                result.bits = std::max(result.bits, primitive.draco->position_bits);
        }
    }
    if (triangles != mesh.triangles.size())
        return EncodeError{EncodeFault::Codec, "Draco kept " + std::to_string(triangles) + " of " +
                                                   std::to_string(mesh.triangles.size()) +
                                                   " triangles"};
    result.max_error = *std::max_element(result.axis_error.begin(), result.axis_error.end());
    if (result.max_error > options.tolerance)
        return EncodeError{EncodeFault::ToleranceTooFine,
                           "positions of this extent are off by up to " +
                               as_text(result.max_error) + " m; ask for tolerance=" +
                               as_text(result.max_error) + " or coarser, or for a smaller bbox"};
    return std::nullopt;
}

/// Where the vertices are in the file: float32 from the origin, or on a grid.
using Plainly = std::vector<std::array<float, 3>>;
using Placed = std::variant<Plainly, GridPositions, EncodeError>;

Placed place_on_grid(const core::MeshData& mesh, const GltfOptions& options,
                     const Box<double>& bounds, GltfResult& result) {
    const std::optional<PositionGrid> coarsest = grid_for(bounds, options.tolerance);
    if (!coarsest)
        return EncodeError{EncodeFault::ToleranceTooFine,
                           "too fine for a mesh of this extent; ask for tolerance=" +
                               as_text(finest_tolerance(bounds)) + " or coarser"};
    GridPositions placed =
        best_positions(mesh, options.unit_to_metre, *coarsest,
                       options.compression == Compression::Draco ? kDracoSteps : kMeshoptSteps);
    result.origin = placed.grid.origin;
    result.step = placed.grid.step();
    result.axis_error = largest_error(mesh, options.unit_to_metre, placed.grid, placed.points);
    result.flipped = placed.check.flipped;
    result.collapsed = placed.check.collapsed;
    return placed;
}

Placed place_plainly(const core::MeshData& mesh, const GltfOptions& options,
                     const Box<double>& bounds, GltfResult& result) {
    const double unit = options.unit_to_metre;
    const std::array<double, 3> origin = whole_metre_middle(bounds);
    std::array<double, 3> largest{};
    Plainly positions(mesh.vertices.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const core::Point3& vertex = mesh.vertices[i];
        const std::array<double, 3> metres{vertex.x * unit, vertex.y * unit, vertex.z * unit};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto rounded = static_cast<float>(metres[axis] - origin[axis]);
            const double error = origin[axis] + double{rounded} - metres[axis];
            largest[axis] = std::max(largest[axis], std::fabs(error));
            positions[i][axis] = rounded;
        }
    }
    const auto plan = [&](std::uint32_t vertex) {
        return core::Point2{double{positions[vertex][0]}, double{positions[vertex][1]}};
    };
    for (const auto& [a, b, c] : mesh.triangles) {
        const core::Orientation side = core::orientation(plan(a), plan(b), plan(c));
        if (side == core::Orientation::Clockwise) ++result.flipped;
        if (side == core::Orientation::Collinear) ++result.collapsed;
    }
    result.origin = origin;
    result.axis_error = largest;
    return positions;
}

std::variant<std::vector<GlbNode>, EncodeError> nodes_of(const SceneInput& input,
                                                         const Placed& placed,
                                                         const core::Executor& executor,
                                                         const GltfResult& result) {
    if (const auto* error = std::get_if<EncodeError>(&placed)) return *error;
    if (const auto* on_grid = std::get_if<GridPositions>(&placed))
        return grid_nodes(input, on_grid->grid, on_grid->points, executor);
    std::vector<GlbNode> nodes;
    nodes.push_back(plain_node(input, result.origin, std::get<Plainly>(placed)));
    return nodes;
}

std::variant<GltfResult, EncodeError> write(const core::MeshData& mesh, const GltfOptions& options,
                                            const RegionPartition* regions,
                                            const core::Executor& helpers,
                                            GltfContainer container) {
    static const core::Executor kAlone = core::one_after_another;
    const core::Executor& executor = mesh.triangles.size() < kWorthHelp ? kAlone : helpers;
    Box<double> bounds;
    if (std::optional<EncodeError> fault = find_fault(mesh, options, regions, executor, bounds))
        return *std::move(fault);
    GltfResult result;
    Placed placed;
    std::vector<std::array<float, 3>> normals;
    std::vector<core::Job> jobs;
    if (options.normals) jobs.emplace_back([&] { normals = smooth_normals(mesh, options.up); });
    jobs.emplace_back([&] {
        placed = options.compression == Compression::None
                     ? place_plainly(mesh, options, bounds, result)
                     : place_on_grid(mesh, options, bounds, result);
    });
    executor(jobs);
    // Where no polygon has an inside there is nothing to tell apart.
    const bool has_regions = regions != nullptr && !regions->features.empty();
    std::vector<SceneGroup> groups;
    if (has_regions) groups = groups_of(*regions);
    const SceneInput input{mesh, options, normals, groups};
    auto nodes = nodes_of(input, placed, executor, result);
    if (auto* error = std::get_if<EncodeError>(&nodes)) return std::move(*error);
    GlbScene scene;
    scene.generator = "Tinsmith";
    scene.nodes = std::get<std::vector<GlbNode>>(std::move(nodes));
    if (has_regions) scene.table = property_table(*regions);
    if (regions != nullptr) scene.regions = regions_extras(*regions);
    if (auto error = count_primitives(mesh, options, scene.nodes, result)) return *std::move(error);
    scene.extras = extras_of(mesh, options, result);
    auto file = write_gltf_file(scene, container);
    if (auto* error = std::get_if<EncodeError>(&file)) return std::move(*error);
    result.bytes = std::get<std::string>(std::move(file));
    return result;
}

}  // namespace

std::variant<GltfResult, EncodeError> write_glb(const core::MeshData& mesh,
                                                const GltfOptions& options,
                                                const RegionPartition* regions,
                                                const core::Executor& executor) {
    return write(mesh, options, regions, executor, GltfContainer::Glb);
}

std::variant<GltfResult, EncodeError> write_gltf(const core::MeshData& mesh,
                                                 const GltfOptions& options,
                                                 const RegionPartition* regions,
                                                 const core::Executor& executor) {
    return write(mesh, options, regions, executor, GltfContainer::Json);
}

}  // namespace tinsmith::api
