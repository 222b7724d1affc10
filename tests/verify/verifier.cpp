// SPDX-License-Identifier: Apache-2.0
#include "tests/verify/verifier.hpp"

#include <algorithm>

namespace tinsmith::verify {

namespace {

void append(Faults& to, Faults more) {
    std::move(more.begin(), more.end(), std::back_inserter(to));
}

bool brings_elevations(const core::Shape& shape) {
    return std::any_of(shape.paths.begin(), shape.paths.end(),
                       [](const core::Path& path) { return !path.elevations.empty(); });
}

}  // namespace

Verifier::Verifier(core::MeshData mesh)
    : origin_(std::make_shared<Snapshot>(std::move(mesh))), now_(origin_) {}

Faults Verifier::faults_of(const core::MeshData& mesh) {
    Faults faults = check_indices(mesh);
    if (faults.empty()) faults = check_validity(Snapshot(mesh));
    return faults;
}

Faults Verifier::step(core::MeshData after, std::span<const core::Shape> shapes,
                      const core::IntegrateOptions& options, double certified, std::size_t forced) {
    if (Faults faults = check_indices(after); !faults.empty()) return faults;
    const auto next = std::make_shared<const Snapshot>(std::move(after));
    Faults faults = check_validity(*next);
    if (!faults.empty()) return faults;
    const Edit edit{*now_, *next, shapes, options, certified};
    Change change;
    faults = check_coverage(edit, change);
    // What follows a shape that brings elevations lies on a surface that is in neither mesh.
    const auto bending = std::find_if(shapes.begin(), shapes.end(), brings_elevations);
    const bool comparable = bending == shapes.end() || bending + 1 == shapes.end();
    if (faults.empty() && comparable) append(faults, check_surface(edit, change));
    append(faults, check_chains(edit));
    if (comparable) append(faults, check_elevations(edit));
    // Facets outlive requests, so the mesh's edges are those of the first mesh, and the segments
    // all that were given since; but new elevations and swaps across facets bend the surface along
    // edges of the new mesh.
    const bool swaps =
        options.improve == core::Improve::Paper || options.improve == core::Improve::Bounded;
    all_.insert(all_.end(), shapes.begin(), shapes.end());
    // The constraints of the first mesh are edges of it, which count as such.
    if (forced != kUncounted && now_ != origin_) {
        const double flat = 1e-9 * now_->grid.extent();
        add_actual_crossings(*now_, shapes, flat, crossings_);
    }
    widest_reach_ = std::max(widest_reach_, 2 * chain_reach(edit));
    widest_snap_ = std::max(widest_snap_, edit.options.snap);
    if (forced != kUncounted && comparable && (!swaps || shapes.size() == 1))
        append(faults, check_economy(*origin_, next->data, all_, crossings_, widest_reach_,
                                     widest_snap_, forced));
    if (swaps || bending != shapes.end()) {
        origin_ = next;
        all_.clear();
        crossings_.clear();
        widest_reach_ = 0.0;
        widest_snap_ = 0.0;
    }
    now_ = next;
    return faults;
}

}  // namespace tinsmith::verify
