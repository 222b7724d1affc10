// SPDX-License-Identifier: Apache-2.0
// Any bytes as the body of an edit: the reader answers with a value or with faults, in bounded
// memory; what it read has no contradiction in it.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "api/formats/edit_json.hpp"

namespace {

using namespace tinsmith;

void require(bool holds) {
    if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const api::ReadLimits limits;
    const auto edit = api::read_edit_request({reinterpret_cast<const char*>(data), size}, limits);
    if (!edit) {
        require(!edit.faults().empty() && edit.faults().size() <= limits.max_faults);
        return 0;
    }
    require(!edit->polygon.empty() && !api::edit_name(edit->operation).empty());
    require(std::isfinite(edit->by) && std::isfinite(edit->plane.at.z));
    require(std::isfinite(edit->plane.per_x) && std::isfinite(edit->plane.per_y));
    require(edit->passes >= 1 && edit->passes <= api::kMostPasses);
    require(!(edit->rim && edit->taper) && !(edit->rim && edit->moves_border));
    require(!edit->rim || *edit->rim > 0.0);
    require(!edit->taper || *edit->taper > 0.0);
    return 0;
}
