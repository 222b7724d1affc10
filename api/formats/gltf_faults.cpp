// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gltf_faults.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "api/parts.hpp"
#include "core/types/range.hpp"

namespace tinsmith::api {
namespace {

/// Draco counts corners in ints.
constexpr std::size_t kMostTriangles = std::numeric_limits<std::int32_t>::max() / 3;
/// 2^32 - 1 is no index in glTF.
constexpr std::size_t kMostVertices = std::numeric_limits<std::uint32_t>::max() - 1;
/// A thousand kilometres: keeps every length in metres well inside float32's range.
constexpr double kLargestUnit = 1e6;

/// All without a branch: hardly ever is there one that is not.
constexpr auto is_usable = [](const core::Point3& v) {
    const auto fits = [](double coordinate) {
        return std::fabs(coordinate) <= core::kCoordinateLimit ? 1U : 0U;
    };
    return (fits(v.x) & fits(v.y) & fits(v.z)) != 0;
};

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

}  // namespace

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

}  // namespace tinsmith::api
