// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/check.hpp"

#include <iostream>

#include "api/terrain_options.hpp"
#include "server/commands/commands.hpp"
#include "server/commands/complaints.hpp"
#include "server/file_io.hpp"
#include "server/terrain_reading.hpp"

namespace tinsmith::server {

int run_check(const CheckConfig& config) {
    const auto options = api::parse_terrain_options(config.terrain_options);
    if (!options) {
        complain("options", options.faults());
        return kExitUsage;
    }
    std::string error;
    const auto bytes = read_file(config.mesh, error);
    if (!bytes) {
        complain(error);
        return kExitRefused;
    }
    const auto terrain = load_terrain(*bytes, terrain_format_of(*bytes), *options, {});
    if (!terrain) {
        complain(config.mesh, terrain.faults());
        return kExitRefused;
    }
    tell_of(config.mesh, terrain->about);
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
