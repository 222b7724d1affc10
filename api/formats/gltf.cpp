// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gltf.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "api/formats/gltf_axes.hpp"
#include "api/formats/gltf_faults.hpp"
#include "api/formats/gltf_plan.hpp"
#include "api/formats/gltf_scene.hpp"
#include "api/formats/gltf_writer.hpp"
#include "api/formats/quantization.hpp"
#include "api/parts.hpp"
#include "core/predicates/orientation.hpp"

namespace tinsmith::api {
namespace {

/// Jobs on fewer triangles take no longer than a thread takes to start.
constexpr std::size_t kWorthHelp = std::size_t{1} << 16;

std::string as_text(double number) {
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
    return {text.data(), end};
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

/// Where the vertices are in the file.
using Placed = std::variant<PlainPositions, GridPositions, EncodeError>;

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

/// The box of positions, each rounded to float32 from the origin: rounding keeps the order.
Box<float> rounded_box(const Box<double>& bounds, const std::array<double, 3>& origin, UpAxis up) {
    std::array<float, 3> low{}, high{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = static_cast<float>(bounds.low[axis] - origin[axis]);
        high[axis] = static_cast<float>(bounds.high[axis] - origin[axis]);
    }
    Box<float> box;
    box.add(to_axes(low, up));
    box.add(to_axes(high, up));
    return box;
}

Placed place_plainly(const core::MeshData& mesh, const GltfOptions& options,
                     const Box<double>& bounds, const core::Executor& executor,
                     GltfResult& result) {
    const double unit = options.unit_to_metre;
    const std::array<double, 3> origin = whole_metre_middle(bounds);
    std::array<std::array<double, 3>, kMostParts> errors{};
    PlainPositions positions{Unwritten<std::array<float, 3>>(mesh.vertices.size()), {}};
    in_parts(executor, mesh.vertices.size(), [&](Part part) {
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
            positions.vertices[i] = to_axes(rounded, options.up);
        }
        errors[part.number] = largest;
    });
    for (const std::array<double, 3>& error : errors) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            result.axis_error[axis] = std::max(result.axis_error[axis], error[axis]);
    }
    result.origin = origin;
    positions.box = rounded_box(bounds, origin, options.up);
    return positions;
}

PlanCheck check_plainly(std::span<const std::array<float, 3>> positions,
                        std::span<const std::array<std::uint32_t, 3>> triangles, UpAxis up) {
    const std::size_t north = up == UpAxis::Z ? 1 : 2;
    const float sign = up == UpAxis::Z ? 1.0F : -1.0F;
    // float32 can tell most: each of its seven roundings is by 2^-24 of what is rounded, or by less
    // than the smallest normal number.
    const auto is_plainly_left = [&](const auto& a, const auto& b, const auto& c) {
        const float left = (b[0] - a[0]) * (c[north] - a[north]);
        const float right = (b[north] - a[north]) * (c[0] - a[0]);
        return sign * (left - right) > 0x1p-20F * (std::fabs(left) + std::fabs(right)) + 0x1p-120F;
    };
    const auto plan = [&](std::uint32_t vertex) {
        const std::array<float, 3>& position = positions[vertex];
        return core::Point2{double{position[0]}, double{sign * position[north]}};
    };
    PlanCheck check;
    for (const auto& [a, b, c] : triangles) {
        if (is_plainly_left(positions[a], positions[b], positions[c])) continue;
        const core::Orientation side = core::orientation(plan(a), plan(b), plan(c));
        if (side == core::Orientation::Clockwise) ++check.flipped;
        if (side == core::Orientation::Collinear) ++check.collapsed;
    }
    return check;
}

using Nodes = std::variant<std::vector<GlbNode>, EncodeError>;

/// What becomes nodes, and who does it.
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

std::vector<GlbNode> nodes_placed_plainly(const Work& work, PlainPositions positions,
                                          GltfResult& result) {
    std::vector<NormalSum> normals;
    std::array<PlanCheck, kMostParts> checks;
    const std::span<const std::array<std::uint32_t, 3>> triangles = work.mesh.triangles;
    in_parts(
        work.executor, triangles.size(),
        [&](Part part) {
            checks[part.number] = check_plainly(
                positions.vertices, triangles.subspan(part.begin, part.end - part.begin),
                work.options.up);
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
    return nodes_placed_plainly(work, std::get<PlainPositions>(std::move(placed)), result);
}

std::variant<GltfResult, EncodeError> write(const core::MeshData& mesh, const GltfOptions& options,
                                            const RegionPartition* regions,
                                            const core::Executor& helpers,
                                            GltfContainer container) {
    static const core::Executor kAlone = core::one_after_another;
    const core::Executor& executor = mesh.triangles.size() < kWorthHelp ? kAlone : helpers;
    const Box<double> in_units = bounds_of(mesh, executor);
    if (std::optional<EncodeError> fault = find_fault(mesh, in_units, options, regions, executor))
        return *std::move(fault);
    GltfResult result;
    const Box<double> bounds = in_metres(in_units, options.unit_to_metre);
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
