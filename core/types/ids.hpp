// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>

namespace tinsmith::core {

/// Slot of a vertex. Never a plain integer, so that it cannot be mixed with a triangle's.
struct VertexId {
    std::uint32_t value = UINT32_MAX;

    constexpr bool valid() const { return value != UINT32_MAX; }
    constexpr std::size_t index() const { return value; }
    friend constexpr auto operator<=>(const VertexId&, const VertexId&) = default;
};

/// Slot of a triangle.
struct TriangleId {
    std::uint32_t value = UINT32_MAX;

    constexpr bool valid() const { return value != UINT32_MAX; }
    constexpr std::size_t index() const { return value; }
    friend constexpr auto operator<=>(const TriangleId&, const TriangleId&) = default;
};

/// The piece of the surface (one plane) that a triangle lies in.
struct FacetId {
    std::uint32_t value = UINT32_MAX;

    friend constexpr auto operator<=>(const FacetId&, const FacetId&) = default;
};

/// One side of one triangle: side i runs from the triangle's vertex i to its vertex (i+1) mod 3,
/// with the triangle on the left. An edge inside the mesh is two sides, one of each triangle;
/// a boundary edge is one.
struct Side {
    std::uint32_t code = UINT32_MAX;  ///< 4 * triangle + i; all ones: no side

    constexpr Side() = default;
    constexpr Side(TriangleId triangle, unsigned i) : code(triangle.value * 4 + i) {}

    constexpr bool valid() const { return code != UINT32_MAX; }
    constexpr TriangleId triangle() const { return {code >> 2}; }
    constexpr unsigned index() const { return code & 3U; }
    /// The triangle's next side, counter-clockwise.
    constexpr Side next() const { return {triangle(), next_of(index())}; }
    /// The triangle's previous side, counter-clockwise.
    constexpr Side previous() const { return {triangle(), previous_of(index())}; }
    friend constexpr auto operator<=>(const Side&, const Side&) = default;

    /// From tables of two bits each, 0, 1, 2 to 1, 2, 0 and to 2, 0, 1: a branch would be taken
    /// every third time, which no processor can foresee.
    static constexpr unsigned next_of(unsigned i) { return (0b00'10'01U >> (2 * i)) & 3U; }
    static constexpr unsigned previous_of(unsigned i) { return (0b01'00'10U >> (2 * i)) & 3U; }
};

/// Ids leave room for the side's two bits and for the invalid value.
inline constexpr std::size_t kMaxTriangles = (std::size_t{1} << 30) - 1;
inline constexpr std::size_t kMaxVertices = (std::size_t{1} << 32) - 2;
inline constexpr std::size_t kMaxFacets = (std::size_t{1} << 32) - 2;

/// How many ids of each kind a mesh may use up. Facets are never used again, so a mesh that is
/// edited for long enough comes to their end.
struct IdLimits {
    std::size_t vertices = kMaxVertices;
    std::size_t triangles = kMaxTriangles;
    std::size_t facets = kMaxFacets;
};

}  // namespace tinsmith::core
