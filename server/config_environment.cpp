// SPDX-License-Identifier: Apache-2.0
#include "server/config_environment.hpp"

#include <cstdlib>

#include <CLI/CLI.hpp>

namespace tinsmith::server {

std::string refused_variable(const CLI::App& app) {
    for (const CLI::App* command : app.get_subcommands()) {
        for (const CLI::Option* option : command->get_options()) {
            const std::string name = option->get_envname();
            const char* value = name.empty() ? nullptr : std::getenv(name.c_str());
            if (value == nullptr || *value == '\0' || option->count() > 0) continue;
            return name + ": \"" + value + "\" is no value of " + option->get_name();
        }
    }
    return {};
}

}  // namespace tinsmith::server
