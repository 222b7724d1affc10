// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/types/executor.hpp"

namespace tinsmith::api {

/// The executor that uses the machine's other processors. Of the whole process no more threads than
/// these help at a time, whoever asked for them: where none is left, or none can be started, the
/// caller does its jobs alone. Cost: some 50 us a thread, so jobs should take milliseconds.
void side_by_side(std::span<const core::Job> jobs);

}  // namespace tinsmith::api
