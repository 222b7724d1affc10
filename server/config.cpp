// SPDX-License-Identifier: Apache-2.0
#include "server/config.hpp"

#include <algorithm>
#include <array>
#include <iostream>
#include <map>

#include <CLI/CLI.hpp>

#include "api/terrain_options.hpp"
#include "server/config_environment.hpp"
#include "server/config_flags.hpp"
#include "server/config_quotas.hpp"

namespace tinsmith::server {

namespace {

constexpr const char* kTopFooter =
    "Examples:\n"
    "  tinsmith serve --demo\n"
    "  tinsmith integrate terrain.tif parcels.geojson -o out.glb --report report.json\n"
    "  tinsmith check mesh.json\n"
    "  tinsmith backup --data /data /backup/monday\n"
    "  tinsmith key add alice --data /data\n\n"
    "Exit codes: 0 done, 1 the input was refused, 2 wrong usage.";

constexpr const char* kServeFooter =
    "Every flag is also an environment variable, TINSMITH_PORT for --port, and a line in the\n"
    "section [serve] of the file given by --config:\n"
    "  [serve]\n"
    "  port = 9000\n"
    "  demo = true\n"
    "The command line comes first, then the file, then the environment.\n\n"
    "SIGTERM and SIGINT: /readyz says 503, for --drain-delay seconds it still listens, requests\n"
    "under way have --grace seconds to end, then edits give up and nothing of them stays; 5\n"
    "seconds later the process has ended whatever it did. Its exit code is 0. A second signal\n"
    "ends it at once.\n\n"
    "Where there are API keys (tinsmith key), all of /v1 and /metrics want one: Authorization:\n"
    "Bearer KEY. Beyond this machine the server does not start without. SIGHUP: the file of keys "
    "is\n"
    "read again.\n\n"
    "Examples:\n"
    "  tinsmith serve --demo\n"
    "  tinsmith serve --data /data\n"
    "  tinsmith serve --data /data --host 0.0.0.0 --first-key\n"
    "  tinsmith serve --port 0 --port-file /run/tinsmith.port\n"
    "  TINSMITH_MAX_SESSIONS=8 tinsmith serve";

constexpr const char* kIntegrateFooter =
    "TERRAIN is GeoTIFF, ESRI ASCII grid, GLB, OBJ, LandXML, CSV lines x,y,z, or JSON (mesh,\n"
    "points or grid); POLYGONS is GeoJSON in the terrain's coordinates.\n\n"
    "Examples:\n"
    "  tinsmith integrate terrain.tif lake.geojson -o out.glb --report report.json\n"
    "  tinsmith integrate mesh.json road.geojson -o out.glb --elevation own --snap 0.05";

constexpr const char* kKeyFooter =
    "The file has the SHA-256 of each key and not the key. A server that runs reads it again on\n"
    "SIGHUP. What a key makes belongs to its id: whoever has another key does not see it.\n\n"
    "Examples:\n"
    "  tinsmith key add alice --data /data --max-sessions 10\n"
    "  tinsmith key list --keys /etc/tinsmith/keys\n"
    "  tinsmith key renew alice --data /data && kill -HUP $(pidof tinsmith)";

/// A hundred years: beyond, times are no times any more.
constexpr std::uint64_t kLongestLife = std::uint64_t{100} * 365 * 24 * 3600;

std::string variable_of(std::string name) {
    std::transform(name.begin(), name.end(), name.begin(), [](char c) {
        return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    });
    return "TINSMITH_" + name;
}

template <typename T>
CLI::Option* add_setting(CLI::App& app, const std::string& name, T& value,
                         const std::string& text) {
    return app.add_option(flag_of(name), value, text)
        ->envname(variable_of(name))
        ->capture_default_str();
}

/// A limit: where it is kept, and what --help says.
struct NumberFlag {
    const char* name = nullptr;
    std::size_t* value = nullptr;
    const char* text = nullptr;
    bool is_bytes = false;
};

void add_limits(CLI::App& app, Limits& limits) {
    const NumberFlag flags[] = {
        {"max_body_bytes", &limits.max_body_bytes, "Largest request body (256MB, 1GB)", true},
        {"max_memory_bytes", &limits.max_memory_bytes, "Of all meshes together", true},
        {"max_session_bytes", &limits.max_session_bytes, "Of one session", true},
        {"max_sessions", &limits.max_sessions, "Sessions at the same time"},
        {"max_vertices", &limits.max_vertices, "Vertices of a terrain"},
        {"max_triangles", &limits.max_triangles, "Triangles of a session"},
        {"max_polygon_vertices", &limits.max_polygon_vertices, "Positions in one request"},
        {"max_history", &limits.max_history, "Operations that a session can take back"},
        {"max_history_bytes", &limits.max_history_bytes, "What they may hold, for one session",
         true},
        {"max_crossings", &limits.max_crossings, "Edges crossed by one request"},
        {"max_requests", &limits.max_requests, "Requests at the same time"},
        {"max_points", &limits.max_points, "Points of one question for elevations"},
        {"max_profile_crossings", &limits.max_profile_crossings, "Edges crossed by one profile"},
        {"max_jobs", &limits.max_jobs, "Jobs in any state"},
        {"max_queued_jobs", &limits.max_queued_jobs, "Jobs that wait for a thread"},
        {"job_bytes", &limits.job_bytes, "Bytes of their requests and answers", true},
        {"mesh_cache", &limits.mesh_cache, "Bytes of encoded meshes to keep; 0: none", true},
        {"kept_answers", &limits.kept_answers, "Bytes of answers to keep for retries by key", true},
    };
    for (const NumberFlag& flag : flags) {
        CLI::Option* const option = add_setting(app, flag.name, *flag.value, flag.text);
        // What is added last by `transform` is asked first.
        if (flag.is_bytes) option->transform(CLI::AsSizeValue(false));
        option->transform(digit_first());
        // Without an operation kept or a request taken there is nothing to serve.
        if (flag.value == &limits.max_history || flag.value == &limits.max_requests)
            option->check(CLI::PositiveNumber);
    }
    add_setting(app, "max_edit_seconds", limits.max_edit_seconds, "Time for one edit")
        ->check(digit_first())
        ->check(CLI::PositiveNumber);
    add_setting(app, "job_threads", limits.job_threads, "Requests done as jobs at the same time")
        ->check(CLI::Range(1, 64));
    add_setting(app, "job_seconds", limits.job_seconds, "Time for which answers of jobs are kept")
        ->check(digit_first());
    add_setting(app, "session_ttl", limits.session_ttl,
                "Seconds for which a session lives that nobody asks for; 0: for ever")
        ->check(digit_first())
        ->check(CLI::Range(std::uint64_t{0}, kLongestLife));
}

/// "https://maps.example:8443": what browsers send as Origin, to the letter.
std::string fault_of_origin(const std::string& text) {
    const std::size_t slashes = text.find("://");
    const std::string host = slashes == std::string::npos ? "" : text.substr(slashes + 3);
    const bool is_plain = std::none_of(text.begin(), text.end(), [](char c) {
        return c <= ' ' || c > '~' || c == '"' || c == '\\' || (c >= 'A' && c <= 'Z');
    });
    const bool is_origin =
        slashes > 0 && !host.empty() && host.find_first_of("/?#@*,") == host.npos;
    return text == "*" || (is_plain && is_origin)
               ? std::string()
               : "\"" + text + "\" is no origin such as https://maps.example, nor *";
}

/// Newer releases of the library ask for a variable's list as a whole.
CLI::Validator origin() {
    return {[](std::string& text) {
                std::string fault;
                for (const std::string& each : CLI::detail::split(text, ','))
                    if (fault.empty()) fault = fault_of_origin(each);
                return fault;
            },
            "", "origin"};
}

void add_policy(CLI::App& app, Policy& policy) {
    app.add_flag("--require-if-match", policy.require_if_match,
                 "Refuse edits that do not name their version by If-Match")
        ->envname("TINSMITH_REQUIRE_IF_MATCH");
    app.add_option("--cors-origin", policy.cors_origins,
                   "Origin whose pages may call, repeatable; *: any")
        ->envname("TINSMITH_CORS_ORIGIN")
        ->delimiter(',')
        ->check(origin());
}

CLI::App* add_serve(CLI::App& app, ServeConfig& config) {
    CLI::App* serve = app.add_subcommand("serve", "Serve terrains over HTTP");
    serve->footer(kServeFooter);
    HttpOptions& http = config.http;
    add_setting(*serve, "host", http.host, "Address to listen on");
    add_setting(*serve, "port", http.port, "Port to listen on; 0: any free one")
        ->check(CLI::Range(0, 65535));
    add_setting(*serve, "port_file", config.port_file, "Write the port here once it is ready");
    serve->add_flag("--demo", config.demo, "Load the bundled terrain as session \"demo\"")
        ->envname("TINSMITH_DEMO");
    add_setting(*serve, "demo_terrain", config.demo_terrain, "Load this terrain for --demo");
    add_setting(*serve, "viewer", config.viewer, "Folder of the built page for /");
    add_setting(*serve, "data", config.data,
                "Folder to store sessions in, made if need be; none: they end with the process");
    add_setting(*serve, "keys", config.keys,
                "File of API keys; by default \"keys\" in the folder of --data");
    serve
        ->add_flag("--first-key", config.first_key,
                   "Make an API key where there is none, and print it this once")
        ->envname("TINSMITH_FIRST_KEY");
    serve
        ->add_flag("--insecure", config.insecure,
                   "Listen beyond this machine without API keys: everyone may do everything")
        ->envname("TINSMITH_INSECURE");
    add_setting(*serve, "threads", http.threads, "Requests served at the same time")
        ->check(CLI::Range(2, 1024));
    add_setting(*serve, "max_connections", http.max_connections,
                "Connections open at the same time; idle ones make room")
        ->check(digit_first())
        ->check(CLI::Range(1, 1'000'000));
    add_limits(*serve, http.limits);
    add_policy(*serve, config.policy);
    static const std::map<std::string, LogLevel> kLevels{{"debug", LogLevel::Debug},
                                                         {"info", LogLevel::Info},
                                                         {"warning", LogLevel::Warning},
                                                         {"error", LogLevel::Error},
                                                         {"off", LogLevel::Off}};
    serve->add_option("--log-level", config.log_level, "debug, info, warning, error or off")
        ->envname("TINSMITH_LOG_LEVEL")
        ->transform(CLI::CheckedTransformer(kLevels, CLI::ignore_case));
    static const std::map<std::string, LogFormat> kFormats{
        {"auto", LogFormat::Auto}, {"json", LogFormat::Json}, {"text", LogFormat::Text}};
    serve
        ->add_option("--log-format", config.log_format,
                     "json, text, or auto: text on a terminal, else json")
        ->envname("TINSMITH_LOG_FORMAT")
        ->transform(CLI::CheckedTransformer(kFormats, CLI::ignore_case));
    add_setting(*serve, "grace", config.grace,
                "Seconds that requests under way may take when it stops")
        ->check(digit_first())
        ->check(CLI::Range(0.0, 3600.0));
    add_setting(*serve, "drain_delay", config.drain_delay,
                "Seconds for which it still listens then, for balancers to notice")
        ->check(digit_first())
        ->check(CLI::Range(0.0, 3600.0));
    return serve;
}

/// Options of requests as flags of the same names; the values are judged by the requests' parser.
void add_request_options(CLI::App& app, std::span<const std::string_view> names,
                         const std::string& group, std::vector<api::NamedOption>& out) {
    for (const std::string_view name : names) {
        const std::string key(name);
        app.add_option_function<std::string>(
               flag_of(key),
               [&out, key](const std::string& value) {
                   out.push_back({key, value, {}});
               },
               "Takes " + std::string(api::option_values(name)))
            ->group(group);
    }
}

CLI::App* add_integrate(CLI::App& app, IntegrateConfig& config) {
    CLI::App* integrate =
        app.add_subcommand("integrate", "Cut polygons into a terrain and write it as GLB");
    integrate->footer(kIntegrateFooter);
    integrate->add_option("TERRAIN", config.terrain, "A file, of one of the formats below")
        ->required();
    integrate->add_option("POLYGONS", config.polygons, "GeoJSON")->required();
    integrate->add_option("-o,--output", config.output, "The mesh as GLB")->required();
    integrate->add_option("--report", config.report, "The report as JSON");
    add_request_options(*integrate, api::terrain_option_names_beside(), "Terrain",
                        config.terrain_options);
    add_request_options(*integrate, api::polygon_option_names(), "Polygons",
                        config.polygon_options);
    add_request_options(*integrate, api::mesh_option_names(), "Mesh", config.mesh_options);
    return integrate;
}

CLI::App* add_check(CLI::App& app, CheckConfig& config) {
    CLI::App* check = app.add_subcommand("check", "List every broken law of a mesh");
    check->add_option("MESH", config.mesh, "GeoTIFF, glTF, OBJ, LandXML or JSON")->required();
    add_request_options(*check, api::terrain_option_names(), "Terrain", config.terrain_options);
    return check;
}

CLI::App* add_backup(CLI::App& app, BackupConfig& config) {
    CLI::App* backup =
        app.add_subcommand("backup", "Copy the sessions of a folder, also while a server has it");
    backup->footer(
        "TO is a new folder: everything that was acknowledged before is in it. A server started\n"
        "with --data TO has the sessions as they were then.\n\n"
        "Example:\n"
        "  tinsmith backup --data /data /backup/monday");
    add_setting(*backup, "data", config.data, "The folder that the server has")->required();
    backup->add_option("TO", config.to, "The copy")->required();
    return backup;
}

CLI::App* add_key(CLI::App& app, KeyConfig& config) {
    CLI::App* key = app.add_subcommand("key", "Add, list, renew and remove API keys of a server");
    key->footer(kKeyFooter);
    key->require_subcommand(1);
    key->fallthrough();
    add_setting(*key, "keys", config.keys, "The file of keys, made if need be");
    add_setting(*key, "data", config.data, "The server's folder: its file of keys is \"keys\"");
    using Action = KeyConfig::Action;
    const auto on = [&](const char* name, Action action, const char* text) {
        CLI::App* command = key->add_subcommand(name, text);
        command->callback([&config, action] { config.action = action; });
        if (action != Action::List)
            command->add_option("NAME", config.name, "What people call the key")->required();
        return command;
    };
    CLI::App* add = on("add", Action::Add, "Make a key and print it this once");
    add->add_option("--id", config.id, "Give it what a key of that id made, which is gone");
    add_quotas(*add, config.quotas);
    on("list", Action::List, "Names, ids, times and quotas; keys are not known");
    on("renew", Action::Renew, "Print a new key for the old one, with the same sessions");
    on("remove", Action::Remove, "Forget a key: its sessions stay stored, for nobody to see");
    return key;
}

}  // namespace

std::string key_file_of(const std::string& keys, const std::string& data) {
    if (!keys.empty() || data.empty()) return keys;
    return data + (data.ends_with('/') ? "keys" : "/keys");
}

Command parse_command_line(int argc, const char* const* argv) {
    CLI::App app{"Tinsmith edits terrain meshes: it cuts polygons into them over HTTP."};
    app.footer(kTopFooter);
    app.set_version_flag("--version", std::string("tinsmith ") + TINSMITH_VERSION);
    app.set_config("--config", "", "Settings as TOML, a section for each command");
    app.allow_config_extras(CLI::config_extras_mode::error);
    app.require_subcommand(1);
    app.fallthrough();
    ServeConfig serve;
    IntegrateConfig integrate;
    CheckConfig check;
    const CLI::App* serve_command = add_serve(app, serve);
    const CLI::App* integrate_command = add_integrate(app, integrate);
    BackupConfig backup;
    const CLI::App* check_command = add_check(app, check);
    add_backup(app, backup);
    KeyConfig key;
    const CLI::App* key_command = add_key(app, key);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ConfigError& error) {
        // The library blames "INI" and does not say what would have been right.
        std::cerr << "The settings file: " << error.what()
                  << ". A key is a flag without its dashes in front (max-sessions = 5), in the "
                     "section of its command ([serve]).\n";
        return kExitUsage;
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? kExitOk : kExitUsage;
    }
    if (const std::string fault = refused_variable(app); !fault.empty()) {
        std::cerr << fault << "\nRun with --help for more information.\n";
        return kExitUsage;
    }
    if (serve_command->parsed()) {
        // Each has a thread: what is told at /v1/limits is what can be.
        std::size_t& max_requests = serve.http.limits.max_requests;
        max_requests = std::min(max_requests, serve.http.threads);
        return serve;
    }
    if (integrate_command->parsed()) return integrate;
    if (check_command->parsed()) return check;
    if (key_command->parsed()) return key;
    return backup;
}

}  // namespace tinsmith::server
