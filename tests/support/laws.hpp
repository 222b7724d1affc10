// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/mesh/tin.hpp"
#include "tests/support/case_file.hpp"

namespace tinsmith::test {

/// What holds between two integrations, beside the guarantees of each: what is broken, in words,
/// the first of which names the law. Nothing where the request is refused.
///   COPY: a copy of the mesh, and a walk from elsewhere, give the same bytes;
///   UNDO: taking the operation back restores the bytes;
///   TWICE, or TWICE_SNAPPED with a snap distance: the same request again adds nothing (draped
///   paths, Improve::None or Strict);
///   REVERSED: closed paths turned round and begun elsewhere give the same vertices in plan, to
///   within rounding (Improve::None, draped paths, no snap). By G2 the surface is the same too.
std::vector<std::string> check_laws(const core::Tin& tin, const Request& request);

}  // namespace tinsmith::test
