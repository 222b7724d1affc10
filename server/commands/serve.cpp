// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <future>
#include <string>

#include <unistd.h>

#include "server/answer_finish.hpp"
#include "server/commands/commands.hpp"
#include "server/demo.hpp"
#include "server/file_io.hpp"
#include "server/http_server.hpp"
#include "server/log.hpp"
#include "server/router.hpp"
#include "server/routes/page_routes.hpp"
#include "server/routes/route_table.hpp"
#include "server/services.hpp"

namespace tinsmith::server {

namespace {

/// How long requests may go on after a signal before edits are told to give up.
constexpr std::chrono::seconds kGrace{5};

/// SIGINT and SIGTERM, taken off every thread so that only `wait` meets them: no code of ours runs
/// in a signal handler.
class StopSignals {
  public:
    StopSignals() {
        sigemptyset(&set_);
        sigaddset(&set_, SIGINT);
        sigaddset(&set_, SIGTERM);
        pthread_sigmask(SIG_BLOCK, &set_, nullptr);
    }

    void wait() const {
        int signal = 0;
        sigwait(&set_, &signal);
    }

    /// From now on they end the process at once: for those who press Ctrl-C twice.
    void release() const { pthread_sigmask(SIG_UNBLOCK, &set_, nullptr); }

  private:
    sigset_t set_{};
};

bool is_loopback(const std::string& host) {
    return host == "localhost" || host == "::1" || host.starts_with("127.");
}

int fail(const std::string& reason) {
    log_error(reason);
    return kExitRefused;
}

/// Serves until a signal comes. False: the listening socket failed by itself.
bool serve_until_stopped(HttpServer& server, Services& services, const StopSignals& signals) {
    auto served = std::async(std::launch::async, [&server] {
        const bool fine = server.serve();
        if (!fine) ::kill(::getpid(), SIGTERM);  // wakes the wait below
        return fine;
    });
    signals.wait();
    signals.release();
    log_info("stopping: requests under way are answered first");
    server.stop();
    // A job may wait for a session that a request has locked: it ends after that one, so jobs are
    // told now but waited for last.
    services.jobs.stop();
    served.wait_for(kGrace);
    services.stopping = true;
    services.jobs.shut_down();
    return served.get();
}

}  // namespace

int run_serve(const ServeConfig& config) {
    const StopSignals signals;  // before the first thread, which inherits the mask
    set_log_level(config.log_level);
    Services services(config.http.limits, config.policy);
    const Router router(make_routes(services));
    const Router page_router(make_page_routes(services));
    HttpServer server(
        config.http,
        [&router, &page_router](const Request& request) {
            return request.path.starts_with(kPageFolder) ? page_router.handle(request)
                                                         : router.handle(request);
        },
        [&services](const Request& request, Response& response) {
            finish_answer(services.policy, request, response);
        });
    std::string error;
    const int port = server.bind(error);
    if (port == 0) return fail(error);
    if (!is_loopback(config.http.host)) {
        log_warning("LISTENING BEYOND THIS MACHINE (" + config.http.host +
                    ") WITHOUT KEYS: everyone who reaches the port can read, change and delete "
                    "every session. Put a proxy with access control in front.");
    }
    const std::string viewer = config.viewer.empty() ? bundled_page() : config.viewer;
    if (!viewer.empty()) {
        services.page = PageFiles::read(viewer, error);
        if (!services.page.is_there()) return fail("--viewer: " + error);
    }
    if (config.demo) {
        const std::string path =
            config.demo_terrain.empty() ? bundled_terrain() : config.demo_terrain;
        if (error = load_demo(services, path); !error.empty()) return fail("--demo: " + error);
    }
    if (!config.port_file.empty()) {
        error = write_file_atomically(config.port_file, std::to_string(port) + "\n");
        if (!error.empty()) return fail("--port-file: " + error);
    }
    const bool v6 = config.http.host.find(':') != std::string::npos;
    const std::string host = v6 ? "[" + config.http.host + "]" : config.http.host;
    log_info("serving on http://" + host + ":" + std::to_string(port) + "/");
    if (!serve_until_stopped(server, services, signals)) return fail("the listening socket failed");
    log_info("stopped");
    return kExitOk;
}

}  // namespace tinsmith::server
