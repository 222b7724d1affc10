// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace tinsmith::server {

/// Has the allocator keep little of what is free at the end of a thread's memory, which
/// `give_back_memory` does not reach. By itself it keeps up to 64 MiB for each thread once it has
/// met large blocks. Before the first thread.
void bound_kept_memory();

/// The allocator keeps what large meshes, bodies and their copies leave behind, for each thread its
/// own, a gigabyte easily; it gives that back to the system only when told to.
/// Cost: linear in what is free, a millisecond for some megabytes.
void give_back_memory();

/// Of a mesh. For less it does not pay.
inline constexpr std::size_t kLargeMesh = std::size_t{8} << 20;

/// Of a request's body, or of its answer. Less is soon used again.
inline constexpr std::size_t kLargeBody = std::size_t{1} << 20;

}  // namespace tinsmith::server
