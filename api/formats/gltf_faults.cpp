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

bool is_usable(double coordinate) {
    return std::fabs(coordinate) <= core::kCoordinateLimit;
}

bool are_usable(std::span<const core::Point3> vertices) {
    return std::ranges::all_of(vertices, [](const core::Point3& v) {
        return is_usable(v.x) && is_usable(v.y) && is_usable(v.z);
    });
}

/// Looks at them together, without a branch: hardly ever is there a wrong one.
template <std::size_t N>
bool name_vertices(std::span<const std::array<std::uint32_t, N>> items, std::uint32_t vertices) {
    std::uint32_t wrong = 0;
    for (const auto& corners : items)
        for (const std::uint32_t corner : corners)
            wrong |= corner >= vertices ? 1U : 0U;
    for (const auto& corners : items)
        for (std::size_t i = 0; i < N; ++i)
            wrong |= corners[i] == corners[(i + 1) % N] ? 1U : 0U;
    return wrong == 0;
}

/// The first of `items` that is not as it should be: are_right(some of them) tells.
template <typename Item, typename AreRight>
std::optional<EncodeError> find_first(const core::Executor& executor, const char* what,
                                      std::span<const Item> items, const AreRight& are_right) {
    constexpr std::size_t kTogether = 1024;
    std::array<std::size_t, kMostParts> found{};
    found.fill(items.size());
    in_parts(executor, items.size(), [&](Part part) {
        std::size_t begin = part.begin;
        const auto next = [&] { return std::min(kTogether, part.end - begin); };
        while (begin < part.end && are_right(items.subspan(begin, next())))
            begin += next();
        if (begin == part.end) return;
        while (are_right(items.subspan(begin, 1)))
            ++begin;
        found[part.number] = begin;
    });
    const std::size_t first = *std::ranges::min_element(found);
    if (first == items.size()) return std::nullopt;
    return EncodeError{EncodeFault::BadMesh, what + std::to_string(first)};
}

std::optional<EncodeError> find_wrong_item(const core::MeshData& mesh, const Box<double>& bounds,
                                           const core::Executor& executor) {
    const auto vertices = static_cast<std::uint32_t>(mesh.vertices.size());
    const auto name = [&](const auto& items) { return name_vertices(items, vertices); };
    std::optional<EncodeError> error;
    if (!std::ranges::all_of(bounds.low, is_usable) || !std::ranges::all_of(bounds.high, is_usable))
        error = find_first(executor, "a coordinate that is not finite or too large at vertex ",
                           std::span(mesh.vertices), are_usable);
    if (!error)
        error = find_first(executor, "a wrong vertex index in triangle ", std::span(mesh.triangles),
                           name);
    if (!error)
        error = find_first(executor, "a wrong vertex index in constraint ",
                           std::span(mesh.constraints), name);
    return error;
}

}  // namespace

std::optional<EncodeError> find_fault(const core::MeshData& mesh, const Box<double>& bounds,
                                      const GltfOptions& options, const RegionPartition* regions,
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
    return find_wrong_item(mesh, bounds, executor);
}

}  // namespace tinsmith::api
