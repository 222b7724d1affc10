// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/integrate/shape.hpp"
#include "core/types/mesh_data.hpp"
#include "core/types/point.hpp"
#include "tests/digest/dice.hpp"

namespace tinsmith::digest {

/// Square cells in rows and columns, some of them missing, and how they lie in the plane.
/// Sizes are powers of two: then a position is one rounded sum, whatever the compiler fuses, and
/// two programs whose inputs differ cannot pass for two that compute differently.
struct Ground {
    enum class Kind {
        Grid,      ///< every alignment is exact
        Jittered,  ///< moved posts
        Holes,     ///< cells missing anywhere: holes, components, fans that touch
        Needles,   ///< cells squeezed to 2^-30 of their width
        FarAway,   ///< cells of 2^-10 at 5e6
        Steep,     ///< cliffs
        Map,       ///< moved posts at map coordinates
    };
    static constexpr std::uint32_t kKinds = 7;

    Kind kind = Kind::Grid;
    std::uint32_t columns = 1;  ///< and rows
    core::Point2 origin;
    double across = 1.0, along = 1.0;  ///< a cell's size
    double height = 4.0;               ///< elevations are from 0 to this

    /// Where columns and rows, whole or not, lie in the plane.
    core::Point2 at(double column, double row) const {
        return {origin.x + column * across, origin.y + row * along};
    }
};

Ground make_ground(Ground::Kind kind, std::uint32_t columns);

/// Empty where no cell is left.
core::MeshData make_mesh(Dice& dice, const Ground& ground);

/// Rings, lines, holes, points, spikes, slivers: anywhere on the ground and half a cell beyond, on
/// its posts and edges, or a few ulps beside them.
core::Shape make_shape(Dice& dice, const Ground& ground);

/// Elevations of its own for each path; the same where a path comes to a position again.
void give_elevations(Dice& dice, const Ground& ground, core::Shape& shape);

/// A line along posts, for locking.
core::Path make_post_line(Dice& dice, const Ground& ground);

}  // namespace tinsmith::digest
