// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/support/case_file.hpp"
#include "tests/support/random_input.hpp"
#include "tests/support/trial.hpp"

namespace tinsmith::test {

/// Of a million requests on meshes of a kind, how many may be refused because no mesh of doubles
/// was found to hold them. These numbers only ever shrink.
std::uint64_t unrepresentable_per_million(MeshKind kind);

/// What a seed stands for: a mesh, and a few requests that may look at the mesh as it is by then.
class RandomCase {
  public:
    explicit RandomCase(std::uint64_t seed);

    MeshKind kind() const { return kind_; }
    const core::MeshData& mesh() const { return mesh_; }
    bool more() const { return left_ > 0; }
    Request next(const core::MeshData& now);

  private:
    Random random_;
    MeshKind kind_;
    core::MeshData mesh_;
    int left_ = 0;
};

}  // namespace tinsmith::test
