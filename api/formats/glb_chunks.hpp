// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "api/formats/fault_log.hpp"

namespace tinsmith::api {

/// The parts of a GLB, as views into it.
struct GlbChunks {
    std::string_view json;
    std::optional<std::string_view> bin;
};

/// Takes a GLB apart; bytes that do not begin as one are JSON altogether. Chunks of other types are
/// passed over. Nothing: a fault was added.
std::optional<GlbChunks> split_glb(std::string_view bytes, FaultLog& log);

}  // namespace tinsmith::api
