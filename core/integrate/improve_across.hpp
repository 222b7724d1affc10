// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/mesh/surgery.hpp"

namespace tinsmith::core {

/// Swaps edges across facets for better triangles: the criterion of Stanchev & Paraskevov 2023,
/// section 3.4, stated exactly. An edge is swapped when
///   1. both triangles are strictly positive in plan afterwards (exact);
///   2. the worse of their two aspects, longest edge by shortest height in 3D, gets strictly
///   better;
///   3. the surface bends along the new edge no more than along the old (inside a facet: flat);
///   4. what the surface has moved there, all swaps together, stays within the limit, if any;
///   5. no ground that touched a vertex whose elevation the request set is left to a triangle that
///      touches none: what such a vertex moves is its triangles alone.
/// Boundary, constrained and locked edges never swap.
///
/// Such swaps move the surface; how far is certified. Each triangle that comes from a swap across
/// facets gets a facet of its own, and with it carries a bound on its vertical distance from the
/// surface where this object began: the larger of what the two triangles before carried, plus
/// `vertical_gap`. A swap inside a facet moves nothing but what the facet's rounding does: that is
/// not counted here, and comes on top of the limit.
///
/// One object lives for a whole request. It starts when all the shapes are in the mesh, so that
/// these cross no edge but those of the mesh before the request.
class CrossFacetImprover {
  public:
    /// What one call did.
    struct Outcome {
        std::uint64_t edges_swapped = 0;
        double max_deviation = 0.0;  ///< carried by any triangle it made, session unit
        bool has_facets = true;      ///< false: it ended where none was left for another swap
    };

    /// `limit`: no triangle carries more, session unit. Without one: the published criterion.
    explicit CrossFacetImprover(double limit = std::numeric_limits<double>::infinity())
        : limit_(limit) {}

    /// Vertices whose elevation the request set, in order.
    void hold_to(std::vector<VertexId> set_vertices) { set_vertices_ = std::move(set_vertices); }
    /// The mesh may use up so many facets.
    void limit_facets(std::size_t most) { most_facets_ = most; }

    /// Improves around the vertices and as far as swaps reach from there. Ends: by the second
    /// condition the sorted list of all aspects only gets better, and there are finitely many
    /// triangulations. Cost: linear in the swaps.
    Outcome improve(Surgery& surgery, std::span<const VertexId> vertices);

    /// Certified bound on the vertical distance of the surface from the one before the first call,
    /// session unit.
    double max_deviation() const { return max_deviation_; }
    std::uint64_t edges_swapped() const { return edges_swapped_; }

  private:
    Side swap_if_better(Surgery& surgery, Side s);
    bool leaves_set_vertices(const Tin& tin, Side s) const;
    double carried(const Tin& tin, Side s) const;
    void carry(FacetId fresh, double deviation);

    double limit_;
    std::size_t most_facets_ = kMaxFacets;
    double max_deviation_ = 0.0;
    std::uint64_t edges_swapped_ = 0;
    std::uint32_t first_facet_ = 0;  ///< the first fresh one; `carried_` follows it
    std::vector<double> carried_;
    std::vector<VertexId> set_vertices_;
};

}  // namespace tinsmith::core
