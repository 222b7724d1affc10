// SPDX-License-Identifier: Apache-2.0
#include <exception>
#include <new>
#include <variant>

#include "server/commands/commands.hpp"
#include "server/commands/complaints.hpp"
#include "server/config.hpp"

namespace {

using namespace tinsmith::server;

struct Run {
    int operator()(int done) const { return done; }
    int operator()(const ServeConfig& config) const { return run_serve(config); }
    int operator()(const IntegrateConfig& config) const { return run_integrate(config); }
    int operator()(const CheckConfig& config) const { return run_check(config); }
    int operator()(const BackupConfig& config) const { return run_backup(config); }
    int operator()(const KeyConfig& config) const { return run_key(config); }
};

}  // namespace

int main(int argc, char** argv) {
    try {
        return std::visit(Run{}, parse_command_line(argc, argv));
    } catch (const std::bad_alloc&) {
        complain("not enough memory");
    } catch (const std::exception& error) {
        complain(std::string("a defect: ") + error.what());
    }
    return kExitRefused;
}
