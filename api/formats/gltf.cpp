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

#include "api/formats/gltf_axes.hpp"
#include "api/formats/gltf_plan.hpp"
#include "api/formats/gltf_scene.hpp"
#include "api/formats/gltf_writer.hpp"
#include "api/formats/quantization.hpp"
#include "api/parts.hpp"
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

/// All without a branch: hardly ever is there one that is not.
bool is_usable(const core::Point3& v) {
    const auto fits = [](double coordinate) {
        return std::fabs(coordinate) <= core::kCoordinateLimit ? 1U : 0U;
    };
    return (fits(v.x) & fits(v.y) & fits(v.z)) != 0;
}

template <std::size_t N>
bool names_vertices(const std::array<std::uint32_t, N>& corners, std::size_t vertices) {
    unsigned wrong = 0;
    for (std::size_t i = 0; i < N; ++i) {
        wrong |= corners[i] >= vertices ? 1U : 0U;
        wrong |= corners[i] == corners[(i + 1) % N] ? 1U : 0U;
    }
    return wrong == 0;
}

/// The first of `items` that is not as it should be.
template <typename Item, typename IsRight>
std::optional<EncodeError> find_first(const core::Executor& executor, const char* what,
                                      std::span<const Item> items, const IsRight& is_right) {
    std::array<std::size_t, kMostParts> found{};
    found.fill(items.size());
    in_parts(executor, items.size(), [&](Part part) {
        for (std::size_t i = part.begin; i < part.end; ++i) {
            if (is_right(items[i])) continue;
            found[part.number] = i;
            return;
        }
    });
    const std::size_t first = *std::ranges::min_element(found);
    if (first == items.size()) return std::nullopt;
    return EncodeError{EncodeFault::BadMesh, what + std::to_string(first)};
}

std::optional<EncodeError> find_wrong_item(const core::MeshData& mesh,
                                           const core::Executor& executor) {
    const auto names = [&](const auto& corners) {
        return names_vertices(corners, mesh.vertices.size());
    };
    auto error = find_first(executor, "a coordinate that is not finite or too large at vertex ",
                            std::span(mesh.vertices), is_usable);
    if (!error)
        error = find_first(executor, "a wrong vertex index in triangle ", std::span(mesh.triangles),
                           names);
    if (!error)
        error = find_first(executor, "a wrong vertex index in constraint ",
                           std::span(mesh.constraints), names);
    return error;
}

/// Draco's encoder is not hardened: what it takes for granted is looked at here.
std::optional<EncodeError> find_fault(const core::MeshData& mesh, const GltfOptions& options,
                                      const RegionPartition* regions,
                                      const core::Executor& executor) {
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
    return find_wrong_item(mesh, executor);
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

/// Where the vertices are in the file: float32 from the origin, in its axes, or on a grid.
using Plainly = std::vector<std::array<float, 3>>;
using Placed = std::variant<Plainly, GridPositions, EncodeError>;

Placed place_on_grid(const core::MeshData& mesh, const GltfOptions& options,
                     const Box<double>& bounds, const core::Executor& executor,
                     GltfResult& result) {
    const std::optional<PositionGrid> coarsest = grid_for(bounds, options.tolerance);
    if (!coarsest)
        return EncodeError{EncodeFault::ToleranceTooFine,
                           "too fine for a mesh of this extent; ask for tolerance=" +
                               as_text(finest_tolerance(bounds)) + " or coarser"};
    GridPositions placed = best_positions(
        mesh, options.unit_to_metre, *coarsest,
        options.compression == Compression::Draco ? kDracoSteps : kMeshoptSteps, executor);
    result.origin = placed.grid.origin;
    result.step = placed.grid.step();
    result.axis_error = placed.vertices.axis_error;
    result.flipped = placed.check.flipped;
    result.collapsed = placed.check.collapsed;
    return placed;
}

Placed place_plainly(const core::MeshData& mesh, const GltfOptions& options,
                     const Box<double>& bounds, const core::Executor& executor,
                     GltfResult& result) {
    const double unit = options.unit_to_metre;
    const std::array<double, 3> origin = whole_metre_middle(bounds);
    std::array<std::array<double, 3>, kMostParts> errors{};
    Plainly positions(mesh.vertices.size());
    in_parts(executor, positions.size(), [&](Part part) {
        std::array<double, 3> largest{};
        for (std::size_t i = part.begin; i < part.end; ++i) {
            const core::Point3& vertex = mesh.vertices[i];
            const std::array<double, 3> metres{vertex.x * unit, vertex.y * unit, vertex.z * unit};
            std::array<float, 3> rounded{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                rounded[axis] = static_cast<float>(metres[axis] - origin[axis]);
                const double error = origin[axis] + double{rounded[axis]} - metres[axis];
                largest[axis] = std::max(largest[axis], std::fabs(error));
            }
            positions[i] = to_axes(rounded, options.up);
        }
        errors[part.number] = largest;
    });
    for (const std::array<double, 3>& error : errors) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            result.axis_error[axis] = std::max(result.axis_error[axis], error[axis]);
    }
    result.origin = origin;
    return positions;
}

PlanCheck check_plainly(const Plainly& positions,
                        std::span<const std::array<std::uint32_t, 3>> triangles, UpAxis up) {
    const auto plan = [&, north = up == UpAxis::Z ? 1U : 2U,
                       sign = up == UpAxis::Z ? 1.0 : -1.0](std::uint32_t vertex) {
        const std::array<float, 3>& position = positions[vertex];
        return core::Point2{double{position[0]}, sign * double{position[north]}};
    };
    PlanCheck check;
    for (const auto& [a, b, c] : triangles) {
        const core::Orientation side = core::orientation(plan(a), plan(b), plan(c));
        if (side == core::Orientation::Clockwise) ++check.flipped;
        if (side == core::Orientation::Collinear) ++check.collapsed;
    }
    return check;
}

using Nodes = std::variant<std::vector<GlbNode>, EncodeError>;

struct Work {
    const core::MeshData& mesh;
    const GltfOptions& options;
    std::span<const SceneGroup> groups;
    const core::Executor& executor;
};

/// None where no normals are wanted. One thread sums them up; others meanwhile do what can be done
/// without them.
std::vector<core::Job> jobs_for_normals(const Work& work, std::vector<NormalSum>& normals) {
    std::vector<core::Job> jobs;
    if (work.options.normals) jobs.emplace_back([&] { normals = normal_sums(work.mesh); });
    return jobs;
}

Nodes nodes_on_grid(const Work& work, const GridPositions& placed) {
    std::vector<NormalSum> normals;
    std::variant<ScenePlan, EncodeError> plan;
    const std::span<const GridPoint> points = placed.vertices.points;
    std::vector<core::Job> jobs = jobs_for_normals(work, normals);
    jobs.emplace_back([&] {
        plan = plan_scene({work.mesh, work.options, {}, work.groups}, placed.grid, points);
    });
    work.executor(jobs);
    if (auto* error = std::get_if<EncodeError>(&plan)) return std::move(*error);
    return grid_nodes({work.mesh, work.options, normals, work.groups}, std::get<ScenePlan>(plan),
                      placed.grid, points, work.executor);
}

std::vector<GlbNode> nodes_placed_plainly(const Work& work, Plainly positions, GltfResult& result) {
    std::vector<NormalSum> normals;
    std::array<PlanCheck, kMostParts> checks;
    const std::span<const std::array<std::uint32_t, 3>> triangles = work.mesh.triangles;
    in_parts(
        work.executor, triangles.size(),
        [&](Part part) {
            checks[part.number] = check_plainly(
                positions, triangles.subspan(part.begin, part.end - part.begin), work.options.up);
        },
        jobs_for_normals(work, normals));
    for (const PlanCheck& check : checks) {
        result.flipped += check.flipped;
        result.collapsed += check.collapsed;
    }
    std::vector<GlbNode> nodes;
    nodes.push_back(plain_node({work.mesh, work.options, normals, work.groups}, result.origin,
                               std::move(positions), work.executor));
    return nodes;
}

Nodes nodes_of(const Work& work, Placed placed, GltfResult& result) {
    if (auto* error = std::get_if<EncodeError>(&placed)) return std::move(*error);
    if (const auto* on_grid = std::get_if<GridPositions>(&placed))
        return nodes_on_grid(work, *on_grid);
    return nodes_placed_plainly(work, std::get<Plainly>(std::move(placed)), result);
}

std::variant<GltfResult, EncodeError> write(const core::MeshData& mesh, const GltfOptions& options,
                                            const RegionPartition* regions,
                                            const core::Executor& helpers,
                                            GltfContainer container) {
    static const core::Executor kAlone = core::one_after_another;
    const core::Executor& executor = mesh.triangles.size() < kWorthHelp ? kAlone : helpers;
    if (std::optional<EncodeError> fault = find_fault(mesh, options, regions, executor))
        return *std::move(fault);
    GltfResult result;
    const Box<double> bounds = bounds_in_metres(mesh, options.unit_to_metre, executor);
    Placed placed = options.compression == Compression::None
                        ? place_plainly(mesh, options, bounds, executor, result)
                        : place_on_grid(mesh, options, bounds, executor, result);
    // Where no polygon has an inside there is nothing to tell apart.
    const bool has_regions = regions != nullptr && !regions->features.empty();
    std::vector<SceneGroup> groups;
    if (has_regions) groups = groups_of(*regions);
    auto nodes = nodes_of({mesh, options, groups, executor}, std::move(placed), result);
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
