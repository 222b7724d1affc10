// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/integrator.hpp"

namespace tinsmith::core {

Result<Report> integrate(Tin&, std::span<const Shape>, const IntegrateOptions&) {
    return Error{ErrorCode::OutsideMesh, "to come", {}};
}

}  // namespace tinsmith::core
