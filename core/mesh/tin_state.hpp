// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/mesh/tin.hpp"

namespace tinsmith::core {

/// The way to all that a TIN is made of, for those who store one and make the same again later, bit
/// for bit: `each` calls `visit` once with references to all members, constant ones of a constant
/// TIN. A TIN made otherwise than by giving every member a value that it had keeps no promise.
struct TinState {
    using BoundaryEntry = BoundaryIndex::Entry;
    using BoundaryChange = BoundaryIndex::Change;
    using BoundaryBox = BoundaryIndex::Box;
    using BoundaryNode = BoundaryIndex::Node;

    /// One to be given all members.
    static Tin blank() { return {}; }
    /// Once it has them: room to grow like that of any other.
    static void make_room(Tin& tin) {
        tin.reserve_growth(tin.vertices_.size(), tin.triangles_.size());
    }

    template <typename Either, typename Visit>
    static void each(Either& tin, Visit visit) {
        visit(tin.vertices_, tin.triangles_, tin.constraint_splits_, tin.named_splits_, tin.names_,
              tin.next_name_, tin.gone_ends_, tin.next_facet_, tin.facet_error_,
              tin.built_vertex_count_, tin.bounds_, tin.boundary_, tin.components_, tin.hints_,
              tin.hint_origin_, tin.hint_columns_, tin.hints_per_x_, tin.hints_per_y_);
    }
    template <typename Either, typename Visit>
    static void each_of_boundary(Either& index, Visit visit) {
        visit(index.box_, index.columns_, index.rows_, index.rounding_, index.entries_,
              index.nodes_, index.halved_, index.filed_, index.changes_);
    }
};

}  // namespace tinsmith::core
