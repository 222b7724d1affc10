// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/support/case_file.hpp"
#include "tests/support/random_input.hpp"
#include "tests/support/trial.hpp"

namespace tinsmith::test {

/// What is let pass on meshes of a kind. These numbers only ever shrink.
struct Allowance {
    std::size_t forced = 0;        ///< vertices at one place beyond those that G8 counts
    double unrepresentable = 0.0;  ///< requests refused for that, of a million
};
Allowance allowance_of(MeshKind kind);

/// What a seed stands for: a mesh, and a few requests that may look at the mesh as it is by then.
class RandomCase {
  public:
    explicit RandomCase(std::uint64_t seed);

    MeshKind kind() const { return kind_; }
    const core::MeshData& mesh() const { return mesh_; }
    Leniency leniency() const;
    bool more() const { return left_ > 0; }
    Request next(const core::MeshData& now);

  private:
    Random random_;
    MeshKind kind_;
    core::MeshData mesh_;
    int left_ = 0;
};

}  // namespace tinsmith::test
