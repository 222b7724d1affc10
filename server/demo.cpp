// SPDX-License-Identifier: Apache-2.0
#include "server/demo.hpp"

#include <filesystem>
#include <utility>

#include "server/file_io.hpp"
#include "server/terrain_reading.hpp"

namespace tinsmith::server {

std::string bundled_terrain() {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    const fs::path installed =
        program.parent_path().parent_path() / "share" / "tinsmith" / "jacksboro.tif";
    if (!error && fs::exists(installed, error)) return installed.string();
    return TINSMITH_BUNDLED_TERRAIN;
}

std::string load_demo(Services& services, const std::string& path) {
    std::string error;
    const auto bytes = read_file(path, error);
    if (!bytes) return error;
    auto terrain = load_terrain(*bytes, terrain_format_of(*bytes), {}, services.read_limits());
    if (!terrain) return path + ": " + terrain.faults().front().detail;
    if (path == bundled_terrain()) terrain->about.name = "Jacksboro fault";
    const auto added = services.sessions.add(std::move(terrain->tin), terrain->about, {}, "demo");
    if (!std::holds_alternative<std::shared_ptr<Session>>(added)) {
        return path + ": does not fit into the limits max_sessions and max_memory_bytes";
    }
    return {};
}

}  // namespace tinsmith::server
