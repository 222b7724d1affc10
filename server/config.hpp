// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "api/requests.hpp"
#include "server/http/http_server.hpp"
#include "server/keys/asker.hpp"
#include "server/log.hpp"
#include "server/policy.hpp"

namespace tinsmith::server {

/// `tinsmith serve`.
struct ServeConfig {
    HttpOptions http;
    std::string port_file;  ///< empty: none
    bool demo = false;
    std::string demo_terrain;  ///< empty: the bundled one
    std::string viewer;        ///< folder of the built page; empty: the bundled one, if any
    std::string data;          ///< folder that sessions are stored in; empty: memory alone
    std::string keys;          ///< file of API keys; empty: "keys" in the data folder, if there
    bool first_key = false;    ///< make a key and print it where there is none
    bool insecure = false;     ///< beyond this machine without keys
    Policy policy;
    LogLevel log_level = LogLevel::Info;
    LogFormat log_format = LogFormat::Auto;
    double grace = 10.0;       ///< seconds for requests under way once the server stops
    double drain_delay = 0.0;  ///< seconds for which it still listens when it is told to
};

/// `tinsmith integrate`: the options go through the same parsers as those of a request.
struct IntegrateConfig {
    std::string terrain;
    std::string polygons;
    std::string output;
    std::string report;  ///< empty: none
    std::vector<api::NamedOption> polygon_options;
    std::vector<api::NamedOption> mesh_options;
    std::vector<api::NamedOption> terrain_options;
};

/// `tinsmith backup`.
struct BackupConfig {
    std::string data;
    std::string to;
};

/// `tinsmith check`.
struct CheckConfig {
    std::string mesh;
    std::vector<api::NamedOption> terrain_options;
};

/// `tinsmith key`.
struct KeyConfig {
    enum class Action { Add, List, Renew, Remove };
    Action action = Action::List;
    std::string name;
    std::string id;    ///< of a key that is added; empty: a new one
    std::string keys;  ///< the file; empty: "keys" in the data folder
    std::string data;
    KeyQuotas quotas;
};

/// The file of API keys by what --keys and --data say; empty: none.
std::string key_file_of(const std::string& keys, const std::string& data);

inline constexpr int kExitOk = 0;
inline constexpr int kExitRefused = 1;  ///< the input or the surroundings do not allow it
inline constexpr int kExitUsage = 2;    ///< the command line makes no sense

/// What to do, or the exit code where that is done already (help, version, wrong usage).
using Command =
    std::variant<int, ServeConfig, IntegrateConfig, CheckConfig, BackupConfig, KeyConfig>;

/// Reads command line, configuration file and environment, in this order of precedence. Writes
/// help to standard output and complaints to standard error.
Command parse_command_line(int argc, const char* const* argv);

}  // namespace tinsmith::server
