// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/mesh/tin.hpp"
#include "tests/support/case_file.hpp"
#include "tests/verify/verifier.hpp"

namespace tinsmith::test {

/// What came of one request.
struct Verdict {
    std::vector<std::string> broken;  ///< guarantees, in words; the first word names which
    bool refused = false;

    /// The word that two failures of one kind share: "G2", "STEP_BUDGET"; empty for none.
    std::string kind() const;
};

/// A mesh that takes requests, all guarantees checked after each.
class Trial {
  public:
    /// Empty with `broken()` set where the mesh is refused.
    explicit Trial(const core::MeshData& mesh);

    const std::vector<std::string>& broken() const { return broken_; }
    const core::MeshData& mesh() const { return verifier_->mesh(); }
    /// Requires: the mesh was not refused.
    const core::Tin& tin() const { return *tin_; }
    Verdict apply(const Request& request);

  private:
    std::optional<core::Tin> tin_;
    std::optional<verify::Verifier> verifier_;
    std::vector<std::string> broken_;
};

/// The first verdict of the case's requests that is not good, else the last.
Verdict replay(const Case& replayed);

}  // namespace tinsmith::test
