// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "api/fault.hpp"
#include "api/formats/read_limits.hpp"
#include "core/types/point.hpp"

namespace tinsmith::api {

inline constexpr std::string_view kDeltaMediaType = "application/vnd.tinsmith.delta";

/// Slots first, first + 1, ... first + count - 1.
struct SlotRun {
    std::uint32_t first = 0;
    std::uint32_t count = 0;

    friend bool operator==(const SlotRun&, const SlotRun&) = default;
};

/// What turns the buffers of a mesh at version `from` into those at version `to`: cut or lengthen
/// them to the new counts, then write the slots that are named. Slots beyond the new counts are
/// gone, all new ones are named. Vertices are the session's doubles, z up; triangles name their
/// corners by slot, counter-clockwise. Slot order is that of the JSON mesh.
///
/// Runs are in order of slot and neither touch nor overlap; `vertices` has one entry for each slot
/// of `vertex_runs`, in order, and `triangles` likewise.
struct MeshDelta {
    std::uint64_t from = 0;
    std::uint64_t to = 0;
    bool whole = false;  ///< every slot is named: what the client had before does not matter
    std::uint32_t old_vertices = 0;
    std::uint32_t old_triangles = 0;
    std::uint32_t new_vertices = 0;
    std::uint32_t new_triangles = 0;
    std::vector<SlotRun> vertex_runs;
    std::vector<SlotRun> triangle_runs;
    std::vector<core::Point3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// How much a delta names.
struct DeltaSize {
    std::size_t vertex_runs = 0;
    std::size_t vertices = 0;
    std::size_t triangle_runs = 0;
    std::size_t triangles = 0;
};

/// Bytes of the binary encoding.
std::size_t delta_bytes(const DeltaSize& size);

/// The binary encoding, little-endian throughout:
///
///     offset  bytes
///          0      4  "TNDL"
///          4      2  format version, 1
///          6      2  flags; bit 0: whole; the others are 0
///          8      8  session version from
///         16      8  session version to
///         24     16  old vertices, old triangles, new vertices, new triangles, 4 bytes each
///         40      8  V, the number of vertex runs, and T, that of triangle runs, 4 bytes each
///         48    8 V  vertex runs: first slot and count, 4 bytes each
///              8 T  triangle runs, likewise
///             24 n  x, y, z of each vertex named, as doubles
///             12 m  the three corners of each triangle named, 4 bytes each
///
/// Doubles begin at multiples of 8 and the rest at multiples of 4, so that typed arrays can lie
/// over the bytes. Nothing follows. The same delta gives the same bytes.
std::string write_delta(const MeshDelta& delta);

/// {"from", "to", "whole", "vertex_count": {"old", "new"}, "triangle_count": likewise,
///  "vertices": [{"first", "positions": [[x,y,z],...]},...],
///  "triangles": [{"first", "corners": [[a,b,c],...]},...]}
/// Requires: finite coordinates.
std::string write_delta_json(const MeshDelta& delta);

/// Reads the binary encoding and refuses whatever breaks a law of `MeshDelta`. No memory is taken
/// on the word of a count: the bytes have to be there.
Parsed<MeshDelta> read_delta(std::string_view bytes, const ReadLimits& limits = {});

}  // namespace tinsmith::api
