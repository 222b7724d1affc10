// SPDX-License-Identifier: Apache-2.0
// The program over HTTP, on one connection that is kept: an edit against the least one
// and the integrator alone; a mesh that it has made before against nginx with the same bytes in a
// file. README.md in this folder says what came out. Wall time, for both sides are processes.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "api/formats/gltf.hpp"
#include "core/integrate/integrator.hpp"
#include "core/mesh/build.hpp"
#include "tests/bench/dem.hpp"
#include "tests/bench/http_peers.hpp"
#include "tests/bench/terrains.hpp"
#include "tests/bench/timing.hpp"
#include "tests/bench/turns.hpp"
#include "tests/cgal/bundled_data.hpp"

namespace tinsmith::bench {
namespace {

constexpr const char* kUsage =
    "usage: http_bench PART [RUNS]\n"
    "  edit   90 segments into the bundled terrain, the answer a delta\n"
    "  get    a mesh of 1,000,000 triangles for the second time and on; needs nginx\n"
    "  memory what a session of 1,000,000 and of 10,000,000 triangles takes; needs 4 GB\n"
    "  smoke  one edit; fails where it or the least one is refused\n"
    "TINSMITH names the program where it is not that of the release build.\n";

/// A folder that is gone when this ends.
class Folder {
  public:
    Folder() {
        std::string name = (std::filesystem::temp_directory_path() / "http_bench-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("there is no folder to use");
        path_ = name;
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::string of(const char* name) const { return path_ + "/" + name; }
    const std::string& path() const { return path_; }

  private:
    std::string path_;
};

std::string bytes_of(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error(path + " cannot be read");
    return {std::istreambuf_iterator<char>(in), {}};
}

std::string bundled(const std::string& name) {
    return bytes_of(TINSMITH_SOURCE_DIR "/tests/data/" + name);
}

std::vector<std::string> serve_words(const Folder& folder) {
    const char* const named = std::getenv("TINSMITH");
    return {named != nullptr ? named : TINSMITH_PROGRAM,
            "serve",
            "--port",
            "0",
            "--port-file",
            folder.of("port"),
            "--log-level",
            "warning"};
}

/// What `ask` gives, which must be well.
const Answer& well(const Answer& answer) {
    if (answer.status / 100 != 2)
        throw std::runtime_error(std::to_string(answer.status) + ": " + answer.body);
    return answer;
}

/// The least that an edit can be: three points within one triangle, which cross nothing.
std::string least_edit(const core::Tin& tin) {
    const auto& [a, b, c] =
        tin.triangle({static_cast<std::uint32_t>(tin.triangle_count() / 2)}).vertices;
    const auto near = [&](core::VertexId most, core::VertexId less, core::VertexId least) {
        const core::Point2 p = tin.plan(most), q = tin.plan(less), r = tin.plan(least);
        char text[80];
        std::snprintf(text, sizeof text, "[%.3f,%.3f]", 0.5 * p.x + 0.3 * q.x + 0.2 * r.x,
                      0.5 * p.y + 0.3 * q.y + 0.2 * r.y);
        return std::string(text);
    };
    const std::string first = near(a, b, c);
    return "{\"type\":\"Polygon\",\"coordinates\":[[" + first + "," + near(b, c, a) + "," +
           near(c, a, b) + "," + first + "]]}";
}

class Editor {
  public:
    explicit Editor(int port) : connection_(port) {
        well(connection_.ask("PUT", "/v1/sessions/bench", "Content-Type: image/tiff\r\n",
                             bundled("jacksboro.tif")));
    }

    /// Milliseconds until the delta is here; the edit is taken back afterwards.
    double edit(const std::string& geojson) {
        const double start = wall_ms();
        const Answer& answer = well(connection_.ask("POST", "/v1/sessions/bench/polygons",
                                                    "Content-Type: application/geo+json\r\n"
                                                    "Accept: application/vnd.tinsmith.delta\r\n",
                                                    geojson));
        const double ms = wall_ms() - start;
        delta_bytes = answer.body.size();
        well(connection_.ask("POST", "/v1/sessions/bench/undo", ""));
        return ms;
    }

    std::size_t delta_bytes = 0;

  private:
    Connection connection_;
};

int compare_edit(int runs) {
    const Folder folder;
    Program server(serve_words(folder));
    Editor editor(port_in(folder.of("port"), server));
    const auto base = core::build_tin(cgal::bundled_terrain());
    const std::string lake = bundled("lake.geojson"), least = least_edit(*base);
    const core::Shape shape = cgal::bundled_shape("lake");
    std::size_t bytes = 0;
    const Turns turns = take_turns({[&] {
                                        const double ms = editor.edit(lake);
                                        bytes = editor.delta_bytes;
                                        return ms;
                                    },
                                    [&] { return editor.edit(least); },
                                    [&] {
                                        core::Tin tin = *base;
                                        const double start = wall_ms();
                                        const auto report = core::integrate(tin, {&shape, 1}, {});
                                        if (!report)
                                            throw std::runtime_error(report.errors()[0].detail);
                                        return wall_ms() - start;
                                    }},
                                   runs);
    std::vector<double> more;
    for (std::size_t i = 0; i < turns[0].size(); ++i)
        more.push_back(turns[0][i] - turns[1][i] - turns[2][i]);
    std::ranges::sort(more);
    std::printf(
        "| delta bytes | edit ms | least edit ms | integrator alone ms | more than both ms |\n"
        "|--:|--:|--:|--:|--:|\n| %zu | %s | %s | %s | %.3f (%.3f to %.3f) |\n",
        bytes, milliseconds(turns[0]).c_str(), milliseconds(turns[1]).c_str(),
        milliseconds(turns[2]).c_str(), median(more), more[more.size() / 4],
        more[more.size() * 3 / 4]);
    return bytes > 1'000 ? EXIT_SUCCESS : EXIT_FAILURE;
}

/// A mesh of a million triangles as a plain GLB, to make the session of.
std::string million() {
    api::GltfOptions options;
    options.compression = api::Compression::None;
    options.normals = false;
    auto written = api::write_glb(resampled(cgal::bundled_terrain(), 1'000'000, 0.5), options);
    if (const auto* error = std::get_if<api::EncodeError>(&written))
        throw std::runtime_error(error->detail);
    return std::move(std::get<api::GltfResult>(written).bytes);
}

void write_nginx_files(const Folder& folder, int port) {
    std::ofstream(folder.of("nginx.conf"))
        << "daemon off; worker_processes 1; pid " << folder.of("pid") << "; error_log "
        << folder.of("errors")
        << ";\nuser root;\nevents {}\nhttp { access_log off; sendfile on; tcp_nopush on; "
        << "keepalive_requests 1000000;\n  types { model/gltf-binary glb; }\n  server { listen "
           "127.0.0.1:"
        << port << "; root " << folder.path() << "; } }\n";
}

int compare_get(int runs) {
    const Folder folder;
    Program server(serve_words(folder));
    const int port = port_in(folder.of("port"), server);
    Connection ours(port);
    well(ours.ask("PUT", "/v1/sessions/bench", "Content-Type: model/gltf-binary\r\n", million()));
    const int other = port > 32'000 ? port - 1'000 : port + 1'000;
    write_nginx_files(folder, other);
    Program nginx({"nginx", "-c", folder.of("nginx.conf"), "-e", folder.of("errors")});
    std::printf(
        "| GLB | bytes | Tinsmith ms | nginx ms | Tinsmith / nginx |\n|---|--:|--:|--:|--:|\n");
    std::optional<Connection> theirs;
    for (const char* compression : {"draco", "meshopt", "none"}) {
        const std::string path =
            std::string("/v1/sessions/bench/mesh.glb?compression=") + compression;
        const std::string file = std::string("/") + compression + ".glb";
        const std::string bytes = well(ours.ask("GET", path, "")).body;
        std::ofstream(folder.path() + file, std::ios::binary) << bytes;
        if (!theirs) theirs.emplace(other);
        const auto get = [&](Connection& from, const std::string& what) {
            const double start = wall_ms();
            const Answer& answer = well(from.ask("GET", what, ""));
            const double ms = wall_ms() - start;
            if (answer.body != bytes) throw std::runtime_error("other bytes than before");
            return ms;
        };
        const Turns turns =
            take_turns({[&] { return get(ours, path); }, [&] { return get(*theirs, file); }}, runs);
        std::printf("| %s | %zu | %s | %s | %s |\n", compression, bytes.size(),
                    milliseconds(turns[0]).c_str(), milliseconds(turns[1]).c_str(),
                    ratio(turns[0], turns[1]).c_str());
        std::fflush(stdout);
    }
    return EXIT_SUCCESS;
}

/// What the server has more than before it had the session: the mesh, its history, all of it.
int measure_memory() {
    std::printf(
        "| triangles | bytes a triangle at rest | after an edit and its undo | edit ms | most "
        "while "
        "it was read |\n|--:|--:|--:|--:|--:|\n");
    for (const std::size_t wanted : {std::size_t{1'000'000}, std::size_t{10'000'000}}) {
        const Folder folder;
        Program server(serve_words(folder));
        Connection connection(port_in(folder.of("port"), server));
        const std::size_t triangles = write_dem(folder.of("dem.tif"), wanted);
        // What the readers hold for good, once for all sessions, is not this one's.
        well(connection.ask("PUT", "/v1/sessions/first", "Content-Type: image/tiff\r\n",
                            bundled("jacksboro.tif")));
        well(connection.ask("DELETE", "/v1/sessions/first", ""));
        const std::size_t before = server.resident_bytes();
        well(connection.ask("PUT", "/v1/sessions/bench", "Content-Type: image/tiff\r\n",
                            bytes_of(folder.of("dem.tif"))));
        const auto each = [&](std::size_t bytes) {
            return static_cast<double>(bytes - before) / static_cast<double>(triangles);
        };
        const double at_rest = each(server.resident_bytes()), most = each(server.peak_bytes());
        const double start = wall_ms();
        well(connection.ask("POST", "/v1/sessions/bench/polygons",
                            "Content-Type: application/geo+json\r\n", bundled("lake.geojson")));
        const double ms = wall_ms() - start;
        well(connection.ask("POST", "/v1/sessions/bench/undo", ""));
        std::printf("| %zu | %.1f | %.1f | %.2f | %.1f |\n", triangles, at_rest,
                    each(server.resident_bytes()), ms, most);
        std::fflush(stdout);
    }
    return EXIT_SUCCESS;
}

int run(const std::string& part, int runs) {
    if (part == "smoke") return compare_edit(1);
    if (part == "edit") return compare_edit(runs);
    if (part == "get") return compare_get(runs);
    if (part == "memory") return measure_memory();
    std::fputs(kUsage, stderr);
    return 2;
}

}  // namespace
}  // namespace tinsmith::bench

int main(int count, char** arguments) {
    return tinsmith::bench::run_program("http_bench", count, arguments, 200, tinsmith::bench::run);
}
