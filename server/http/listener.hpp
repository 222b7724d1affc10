// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace tinsmith::server {

/// A socket that listens on a TCP port; `socket` is -1 where there is none, and `error` says why.
struct Listener {
    int socket = -1;
    int port = 0;
    std::string error;
};

/// Listens on one address of the host, a name or a number. Port 0 takes any free one; a port that
/// another process holds is refused, never shared. The caller closes the socket.
Listener listen_on(const std::string& host, int port);

}  // namespace tinsmith::server
