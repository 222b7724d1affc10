// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "server/commands/commands.hpp"
#include "server/commands/complaints.hpp"
#include "server/store/journal.hpp"

namespace tinsmith::server {

int run_backup(const BackupConfig& config) {
    if (const auto why = backup_store(config.data, config.to)) {
        complain(*why);
        return kExitRefused;
    }
    std::cout << config.to << ": all sessions of " << config.data << " as they are now\n";
    return kExitOk;
}

}  // namespace tinsmith::server
