// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/config.hpp"

namespace tinsmith::server {

// Each runs one command of the program to its end and returns the exit code.

int run_serve(const ServeConfig& config);
int run_integrate(const IntegrateConfig& config);
int run_check(const CheckConfig& config);
int run_backup(const BackupConfig& config);
int run_key(const KeyConfig& config);

}  // namespace tinsmith::server
