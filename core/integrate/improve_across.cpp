// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/improve_across.hpp"

#include <algorithm>

#include "core/integrate/swap_candidates.hpp"
#include "core/integrate/swap_criterion.hpp"
#include "core/types/ulp.hpp"

namespace tinsmith::core {

CrossFacetImprover::Outcome CrossFacetImprover::improve(Surgery& surgery,
                                                        std::span<const VertexId> vertices) {
    Outcome outcome;
    SwapCandidates candidates(surgery.tin());
    for (const VertexId v : vertices) {
        candidates.add_around(v);
        while (!candidates.empty()) {
            const Side s = candidates.take();
            if (surgery.tin().is_fixed(s)) continue;
            if (surgery.tin().next_facet() + std::size_t{2} > most_facets_) {
                outcome.has_facets = false;
                return outcome;
            }
            const Side diagonal = swap_if_better(surgery, s);
            if (!diagonal.valid()) continue;
            ++outcome.edges_swapped;
            outcome.max_deviation =
                std::max(outcome.max_deviation, carried(surgery.tin(), diagonal));
            candidates.add_outer(diagonal);
        }
    }
    edges_swapped_ += outcome.edges_swapped;
    max_deviation_ = std::max(max_deviation_, outcome.max_deviation);
    return outcome;
}

/// The new edge, or an invalid side where the old one stays.
Side CrossFacetImprover::swap_if_better(Surgery& surgery, Side s) {
    const Tin& tin = surgery.tin();
    const SwapQuad quad = quad_around(tin, s);
    // The cheapest question that most edges fail comes first.
    if (!improves_aspect(quad) || !can_swap(quad)) return {};
    if (!tin.separates_facets(s)) return surgery.swap_edge(s);
    if (!bends_no_more(quad) || leaves_set_vertices(tin, s)) return {};
    double deviation = std::max(carried(tin, s), carried(tin, tin.twin(s)));
    // Rounded up, so that no number of swaps adds up to less than the truth.
    if (const double gap = vertical_gap(quad); gap > 0.0)
        deviation = neighbour(deviation + gap, true);
    if (deviation > limit_) return {};
    const Side diagonal = surgery.swap_edge(s);
    carry(surgery.give_fresh_facet(diagonal.triangle()), deviation);
    carry(surgery.give_fresh_facet(tin.twin(diagonal).triangle()), deviation);
    return diagonal;
}

/// Whether a triangle here touches a set vertex and one after the swap does not.
bool CrossFacetImprover::leaves_set_vertices(const Tin& tin, Side s) const {
    if (set_vertices_.empty()) return false;
    const auto is_set = [this](VertexId v) {
        return std::binary_search(set_vertices_.begin(), set_vertices_.end(), v);
    };
    const bool a = is_set(tin.origin(s)), b = is_set(tin.destination(s));
    // Both new triangles have the new diagonal; one has a, the other b.
    return (a != b) && !is_set(tin.apex(s)) && !is_set(tin.apex(tin.twin(s)));
}

double CrossFacetImprover::carried(const Tin& tin, Side s) const {
    // Facets from before the first fresh one wrap around to numbers past the end.
    const std::uint32_t i = tin.facet(s.triangle()).value - first_facet_;
    return i < carried_.size() ? carried_[i] : 0.0;
}

void CrossFacetImprover::carry(FacetId fresh, double deviation) {
    if (carried_.empty()) first_facet_ = fresh.value;
    carried_.resize(fresh.value - first_facet_, 0.0);
    carried_.push_back(deviation);
}

}  // namespace tinsmith::core
