// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "tests/verify/checks.hpp"

namespace tinsmith::verify {

/// Follows a mesh through requests and says what is wrong after each, by arithmetic and structures
/// of its own: plain buffers in, words out.
class Verifier {
  public:
    /// Requires: the mesh is valid (`faults_of` says).
    explicit Verifier(core::MeshData mesh);

    /// What is wrong with a mesh by itself.
    static Faults faults_of(const core::MeshData& mesh);

    /// Checks the mesh that a request left, and takes it as the one before the next request.
    /// `certified`: the vertical deviation that the report promised. `forced`: see check_economy;
    /// kUncounted where the mesh has facets from before, so that its edges are not what counts.
    Faults step(core::MeshData after, std::span<const core::Shape> shapes,
                const core::IntegrateOptions& options, double certified, std::size_t forced = 0);

    const core::MeshData& mesh() const { return now_->data; }

  private:
    std::shared_ptr<const Snapshot> origin_;
    std::shared_ptr<const Snapshot> now_;
    std::vector<core::Shape> all_;           ///< what was asked since `origin_`
    std::vector<ActualCrossing> crossings_;  ///< of those requests
    double widest_reach_ = 0.0;              ///< of those requests
    double widest_snap_ = 0.0;               ///< likewise
};

}  // namespace tinsmith::verify
