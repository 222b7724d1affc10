// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <exception>
#include <future>
#include <string>

#include "server/answer_finish.hpp"
#include "server/commands/commands.hpp"
#include "server/commands/serving_keys.hpp"
#include "server/commands/stopping.hpp"
#include "server/demo.hpp"
#include "server/file_io.hpp"
#include "server/heap.hpp"
#include "server/http/guard.hpp"
#include "server/http/http_server.hpp"
#include "server/keys/gate.hpp"
#include "server/log.hpp"
#include "server/metrics/connections.hpp"
#include "server/router.hpp"
#include "server/routes/page_routes.hpp"
#include "server/routes/restored_answers.hpp"
#include "server/routes/route_table.hpp"
#include "server/services.hpp"
#include "server/session_keeper.hpp"
#include "server/turnstile.hpp"
#include "server/work.hpp"

namespace tinsmith::server {

namespace {

using Clock = std::chrono::steady_clock;

/// After edits have given up, for their answers.
constexpr std::chrono::seconds kForAnswers{1};

Clock::duration seconds_of(double seconds) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

std::string url_of(const std::string& host, int port) {
    const bool v6 = host.find(':') != std::string::npos;
    return "http://" + (v6 ? "[" + host + "]" : host) + ":" + std::to_string(port) + "/";
}

int fail(const std::string& reason) {
    log_event(LogLevel::Error, "failed", reason);
    return kExitRefused;
}

/// The sessions that were stored. Those that cannot be read are told of, and stop nothing.
std::string load_stored(Services& services) {
    try {
        for (const std::string& damaged : services.sessions.take_up())
            log_event(LogLevel::Error, "session_damaged", damaged);
        restore_answers(services);
        services.sessions.load_all([] { return !told_to_stop(); });
    } catch (const StorageFault& fault) {
        return fault.what();
    }
    const SessionTotals totals = services.sessions.totals();
    log_event(LogLevel::Info, "loaded",
              std::to_string(totals.in_memory) + " of " + std::to_string(totals.sessions) +
                  " stored sessions are in memory, " + std::to_string(totals.out_of_service) +
                  " out of service",
              {{"sessions", totals.sessions},
               {"in_memory", totals.in_memory},
               {"out_of_service", totals.out_of_service}});
    return {};
}

/// The sessions that are there from the beginning. Empty, or what is wrong.
std::string load_sessions(Services& services, const ServeConfig& config) {
    if (services.vault) {
        const std::string error = load_stored(services);
        if (!error.empty()) return "--data: " + error;
    }
    if (!config.demo || services.sessions.contains("demo")) return {};
    const std::string path = config.demo_terrain.empty() ? bundled_terrain() : config.demo_terrain;
    const std::string error = load_demo(services, path);
    return error.empty() ? error : "--demo: " + error;
}

/// Loads on a thread of its own, while the server answers already that it is not ready.
class Startup {
  public:
    Startup(Services& services, const ServeConfig& config, int port)
        : services_(services),
          config_(config),
          port_(port),
          error_(std::async(std::launch::async, [this] { return run_or_wake(); })) {}

    /// Loading gives up when it next tells of its progress.
    void stop() { work_.stop(); }

    /// Whether it failed, and was not told to stop.
    bool has_failed() const { return failed_; }

    /// Waits for the end. Empty: it has not failed.
    std::string error() {
        if (error_.valid()) why_ = error_.get();
        return failed_ ? why_ : std::string();
    }

  private:
    std::string run_or_wake() {
        std::string error;
        try {
            error = run();
        } catch (const std::exception& failure) {
            error = std::string("the start failed: ") + failure.what();
        }
        if (error.empty() || work_.stopped()) return error;
        failed_ = true;
        StopSignals::wake();
        return error;
    }

    std::string run() {
        const WorkScope scope(work_);
        std::string error = load_sessions(services_, config_);
        if (!error.empty() || work_.stopped()) return error;
        if (!config_.port_file.empty()) {
            error = write_file_atomically(config_.port_file, std::to_string(port_) + "\n");
            if (!error.empty()) return "--port-file: " + error;
        }
        services_.readiness.enter(Readiness::Phase::Serving);
        const std::string url = url_of(config_.http.host, port_);
        log_event(LogLevel::Info, "started", "serving on " + url, {{"url", url}});
        return {};
    }

    Services& services_;
    const ServeConfig& config_;
    const int port_;
    Work work_;
    std::atomic<bool> failed_{false};
    std::string why_;                 ///< once it has been waited for
    std::future<std::string> error_;  ///< last: its thread uses the above
};

/// False, and whoever waits for a signal is woken: it has failed.
bool serve_or_wake(HttpServer& server) {
    bool fine = false;
    try {
        fine = server.serve();
    } catch (const std::exception& failure) {
        log_event(LogLevel::Error, "defect", failure.what());
    }
    if (!fine) StopSignals::wake();
    return fine;
}

class StopAtTheEnd {
  public:
    explicit StopAtTheEnd(HttpServer& server) : server_(server) {}
    ~StopAtTheEnd() { server_.stop(); }
    StopAtTheEnd(const StopAtTheEnd&) = delete;
    StopAtTheEnd& operator=(const StopAtTheEnd&) = delete;

  private:
    HttpServer& server_;
};

/// Serves until a signal comes or the start fails, then drains. An exit code. Where the time is up
/// the watchdog ends the process.
int serve_until_stopped(HttpServer& server, Services& services, const ServeConfig& config, int port,
                        const StopSignals& signals, Watchdog& watchdog, ServingKeys& keys) {
    auto served = std::async(std::launch::async, [&server] { return serve_or_wake(server); });
    const StopAtTheEnd stop_server(server);  // whatever is thrown below: `served` is waited for
    const std::string url = url_of(config.http.host, port);
    log_event(LogLevel::Info, "listening", "listening on " + url + ", not ready yet",
              {{"url", url}});
    Startup startup(services, config, port);
    signals.wait([&keys] { keys.read_again(); });
    signals.release();
    const bool has_failed = startup.has_failed();
    const auto delay = has_failed ? Clock::duration(0) : seconds_of(config.drain_delay);
    const auto grace = has_failed ? Clock::duration(0) : seconds_of(config.grace);
    const Clock::time_point end = Clock::now() + delay + grace + kLastWait;
    watchdog.start(end, has_failed ? kExitRefused : kExitOk);
    int code = has_failed ? fail(startup.error()) : kExitOk;
    services.readiness.enter(Readiness::Phase::Draining);
    startup.stop();
    server.drain();
    log_event(LogLevel::Info, "draining", "no longer ready");
    served.wait_for(delay);  // or until the socket fails
    log_event(LogLevel::Info, "stopping", "requests under way are answered first");
    server.stop();
    // A job may wait for a session that a request has locked: it ends after that one, so jobs are
    // told now but waited for last.
    services.jobs.stop();
    served.wait_for(grace);
    services.stopping = true;
    services.jobs.shut_down();
    // A connection may take its time to end; what its request still changes is in the log, and
    // repeated by the next start.
    served.wait_for(kForAnswers);
    const std::string error = startup.error();
    if (code == kExitOk && !error.empty()) code = fail(error);
    if (services.before_exit && services.readiness.has_started())
        services.before_exit(end - std::chrono::milliseconds(500));
    if (!served.get() && code == kExitOk) code = fail("the listening socket failed");
    return code;
}

/// No vault where none is asked for; or why there is none.
std::variant<std::unique_ptr<SessionVault>, std::string> open_vault(const ServeConfig& config) {
    if (config.data.empty()) return std::unique_ptr<SessionVault>();
    JournalOptions options;
    options.folder = config.data;
    const Limits& limits = config.http.limits;
    return SessionVault::open(options, {limits.max_history, limits.max_history_bytes});
}

/// From the sessions to their end.
int serve(const ServeConfig& config, const StopSignals& signals, Watchdog& watchdog,
          ServingKeys& keys) {
    auto vault = open_vault(config);
    if (const auto* why = std::get_if<std::string>(&vault)) return fail("--data: " + *why);
    if (const std::string why = keys.start(); !why.empty()) return fail(why);
    Gate gate(keys.ring());
    Turnstile turnstile(config.http.limits.max_requests);
    Services services(config.http.limits, config.policy, std::get<0>(std::move(vault)));
    services.readiness.begin();
    SessionKeeper keeper(services);
    if (services.vault) {
        store_answers(services);
        services.before_exit = [&](Clock::time_point until) { keeper.snapshot_all(until); };
        services.readiness.add("journal", [&services]() -> std::optional<std::string> {
            const JournalHealth health = services.vault->journal().health();
            if (health.fine) return std::nullopt;
            return health.why;
        });
    } else {
        log_event(LogLevel::Info, "not_durable",
                  "sessions live in memory alone and end with this process; --data stores them");
    }
    const Router router(make_routes(services), &services.metrics);
    const Router page_router(make_page_routes(services), &services.metrics);
    const auto router_of = [&](const Request& request) -> const Router& {
        return request.path.starts_with(kPageFolder) ? page_router : router;
    };
    HttpServer server(
        config.http,
        {[&](Request& head) {
             auto refusal = gate.admit(head);
             if (!refusal) refusal = turnstile.admit(head);
             if (!refusal && brings_body(head)) refusal = router_of(head).refusal_of(head);
             return refusal;
         },
         [&](const Request& request) {
             const Metrics::InFlight one(services.metrics);
             return router_of(request).handle(request);
         },
         [&services](const Request& request, Response& response) {
             finish_answer(services.policy, request, response);
         },
         [&services](const Request& request, const Response& response, double seconds) {
             services.metrics.request(response.route, request.method, response.status, seconds,
                                      request.body.size(), bytes_sent(request, response));
             log_request(request, response, seconds * 1e3);
         }});
    services.metrics.add(figures_of(server.connections()));
    std::string error;
    const int port = server.bind(error);
    if (port == 0) return fail(error);
    const std::string viewer = config.viewer.empty() ? bundled_page() : config.viewer;
    if (!viewer.empty()) {
        services.page = PageFiles::read(viewer, error);
        if (!services.page.is_there()) return fail("--viewer: " + error);
    }
    return serve_until_stopped(server, services, config, port, signals, watchdog, keys);
}

}  // namespace

int run_serve(const ServeConfig& config) {
    bound_kept_memory();
    ServingKeys keys(config);
    const StopSignals signals(keys.has_file());  // before the first thread: it inherits the mask
    set_log_format(config.log_format);
    set_log_level(config.log_level);
    Watchdog watchdog;  // outlives all that may hold up the end
    const int code = serve(config, signals, watchdog, keys);
    if (code == kExitOk) log_event(LogLevel::Info, "stopped", "stopped");
    return code;
}

}  // namespace tinsmith::server
