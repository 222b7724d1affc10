// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/check.hpp"

#include <iostream>

#include "server/commands/commands.hpp"
#include "server/commands/complaints.hpp"
#include "server/file_io.hpp"
#include "server/terrain_reading.hpp"

namespace tinsmith::server {

int run_check(const CheckConfig& config) {
    std::string error;
    const auto bytes = read_file(config.mesh, error);
    if (!bytes) {
        complain(error);
        return kExitRefused;
    }
    const auto terrain = load_terrain(*bytes, terrain_format_of(*bytes), {}, {});
    if (!terrain) {
        complain(config.mesh, terrain.faults());
        return kExitRefused;
    }
    const auto violations = core::check_tin(terrain->tin);
    for (const core::Violation& violation : violations) {
        complain(config.mesh + ": " + violation.law + ": " + violation.detail);
    }
    if (!violations.empty()) return kExitRefused;
    std::cout << config.mesh << ": " << terrain->tin.vertex_count() << " vertices, "
              << terrain->tin.triangle_count() << " triangles, every law holds\n";
    return kExitOk;
}

}  // namespace tinsmith::server
