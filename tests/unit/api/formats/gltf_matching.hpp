// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "api/formats/gltf.hpp"
#include "tests/unit/api/formats/gltf_decoding.hpp"

namespace tinsmith::api::testing {

inline GltfResult written(const core::MeshData& mesh, const GltfOptions& options) {
    auto result = write_glb(mesh, options);
    if (const auto* error = std::get_if<EncodeError>(&result)) {
        ADD_FAILURE() << error->detail;
        return {};
    }
    return std::get<GltfResult>(std::move(result));
}

/// Hills over columns x rows cells, posts off the lattice, so that nothing is round by chance.
inline core::MeshData hills(std::uint32_t columns, std::uint32_t rows, double cell,
                            core::Point3 corner = {702113.37, 4029551.81, 411.3}) {
    core::MeshData mesh;
    for (std::uint32_t row = 0; row <= rows; ++row) {
        for (std::uint32_t column = 0; column <= columns; ++column) {
            const double u = column + 0.3 * std::sin(7.0 * row + column);
            const double v = row + 0.3 * std::sin(5.0 * column + 2.0 * row);
            mesh.vertices.push_back({corner.x + u * cell, corner.y + v * cell,
                                     corner.z + 80 * std::sin(u / 9) * std::cos(v / 7)});
        }
    }
    for (std::uint32_t row = 0; row < rows; ++row) {
        for (std::uint32_t column = 0; column < columns; ++column) {
            const std::uint32_t a = row * (columns + 1) + column;
            mesh.triangles.push_back({a, a + 1, a + columns + 2});
            mesh.triangles.push_back({a, a + columns + 2, a + columns + 1});
        }
    }
    for (std::uint32_t column = 0; column < columns; ++column)
        mesh.constraints.push_back({columns + 1 + column, columns + 2 + column});
    return mesh;
}

inline bool within(const core::Point3& a, const core::Point3& b, double tolerance) {
    return std::fabs(a.x - b.x) <= tolerance && std::fabs(a.y - b.y) <= tolerance &&
           std::fabs(a.z - b.z) <= tolerance;
}

/// The session's vertices in metres, found by decoded position.
class NearestVertex {
  public:
    NearestVertex(const core::MeshData& mesh, double unit, double tolerance)
        : tolerance_(tolerance) {
        for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
            const auto& v = mesh.vertices[i];
            by_x_.emplace(v.x * unit,
                          std::pair(core::Point3{v.x * unit, v.y * unit, v.z * unit}, i));
        }
    }
    /// The one vertex within the tolerance on each axis; a failure when there is none.
    std::uint32_t operator()(const core::Point3& p) const {
        for (auto at = by_x_.lower_bound(p.x - tolerance_);
             at != by_x_.end() && at->first <= p.x + tolerance_; ++at) {
            if (within(at->second.first, p, tolerance_)) return at->second.second;
        }
        ADD_FAILURE() << "no vertex near " << p.x << ", " << p.y << ", " << p.z;
        return 0;
    }

  private:
    double tolerance_;
    std::multimap<double, std::pair<core::Point3, std::uint32_t>> by_x_;
};

inline std::array<std::uint32_t, 3> smallest_first(std::array<std::uint32_t, 3> t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

/// Every decoded triangle is one of the mesh, turned the same way, each exactly once; bounds in the
/// accessors are those of the decoded values; normals are unit and look up.
inline void expect_same_mesh(const core::MeshData& mesh, const GltfOptions& options,
                             const DecodedGlb& glb) {
    const NearestVertex nearest(mesh, options.unit_to_metre, options.tolerance);
    std::vector<std::array<std::uint32_t, 3>> found, expected;
    const bool y_up = options.up == UpAxis::Y;
    for (const DecodedPrimitive& primitive : glb.primitives) {
        std::array<double, 3> low{1e30, 1e30, 1e30}, high{-1e30, -1e30, -1e30};
        for (const auto& p : primitive.positions) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                low[axis] = std::min(low[axis], double{p[axis]});
                high[axis] = std::max(high[axis], double{p[axis]});
            }
        }
        EXPECT_EQ(primitive.position_accessor.at("min"), nlohmann::json(low));
        EXPECT_EQ(primitive.position_accessor.at("max"), nlohmann::json(high));
        EXPECT_EQ(primitive.position_accessor.at("count"), primitive.positions.size());
        for (const double metre : primitive.translation)
            EXPECT_EQ(metre, std::nearbyint(metre));
        if (primitive.mode != 4) continue;
        EXPECT_EQ(primitive.normals.size(), options.normals ? primitive.positions.size() : 0);
        for (const auto& n : primitive.normals) {
            EXPECT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1.0,
                        options.compression == Compression::Meshopt ? 5e-4 : 1e-4);
            EXPECT_GE(n[y_up ? 1 : 2], 0.0);
        }
        for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
            std::array<std::uint32_t, 3> t{};
            for (std::size_t k = 0; k < 3; ++k)
                t[k] = nearest(placed(primitive, primitive.indices[i + k], y_up));
            found.push_back(smallest_first(t));
        }
    }
    for (const auto& t : mesh.triangles)
        expected.push_back(smallest_first(t));
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(found, expected);
}

inline void expect_same_lines(const core::MeshData& mesh, const GltfOptions& options,
                              const DecodedGlb& glb) {
    // The lines' vertices are, bit for bit, positions of the triangles.
    std::set<std::array<double, 3>> triangle_positions;
    const NearestVertex nearest(mesh, options.unit_to_metre, options.tolerance);
    std::vector<std::array<std::uint32_t, 2>> found;
    for (const bool lines : {false, true}) {
        for (const DecodedPrimitive& primitive : glb.primitives) {
            if ((primitive.mode == 1) != lines) continue;
            for (std::uint32_t i = 0; i < primitive.positions.size(); ++i) {
                const auto p = placed(primitive, i, options.up == UpAxis::Y);
                if (!lines) triangle_positions.insert({p.x, p.y, p.z});
                EXPECT_TRUE(triangle_positions.contains({p.x, p.y, p.z}));
            }
            for (std::size_t i = 0; lines && i < primitive.indices.size(); i += 2) {
                const auto at = [&](std::size_t k) {
                    return nearest(
                        placed(primitive, primitive.indices[k], options.up == UpAxis::Y));
                };
                found.push_back({at(i), at(i + 1)});
            }
        }
    }
    auto expected = mesh.constraints;
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(found, expected);
}

}  // namespace tinsmith::api::testing
