// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/build.hpp"

namespace tinsmith::core {

Result<Tin> build_tin(const MeshData&) { return Error{ErrorCode::MeshEmpty, "to come", {}}; }

}  // namespace tinsmith::core
