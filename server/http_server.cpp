// SPDX-License-Identifier: Apache-2.0
// The one file that knows cpp-httplib. It must build against 0.11 (Debian 12) and 0.18 (Debian 13).
#include "server/http_server.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <optional>
#include <thread>
#include <utility>

#include <httplib.h>
#include <sys/socket.h>

#include "server/entity_tag.hpp"
#include "server/guard.hpp"
#include "server/log.hpp"
#include "server/random_id.hpp"
#include "server/reply.hpp"
#include "server/target.hpp"

namespace tinsmith::server {

namespace {

using Clock = std::chrono::steady_clock;
using Handled = httplib::Server::HandlerResponse;

/// Headers that the library puts among the client's own. It puts them in last, so one that comes
/// twice was forged.
constexpr std::array kLibraryHeaders{"remote_addr", "remote_port", "local_addr", "local_port"};

/// The answers that may not tell a length, or not that of their empty body (RFC 9110 8.6); the
/// library tells one.
constexpr int kNotModified = 304;

/// How long a refused connection stays open after the answer. Closing with unread bytes makes the
/// kernel reset the connection, and the client could lose the answer before it has read it.
constexpr std::chrono::milliseconds kLinger{100};

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return text;
}

bool is_library_header(const std::string& name) {
    return std::find(kLibraryHeaders.begin(), kLibraryHeaders.end(), name) != kLibraryHeaders.end();
}

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The sender's trace with a span of our own; nothing where there is none, or none valid. Repeated
/// headers are not valid together.
std::optional<TraceContext> trace_of(const Request& request) {
    auto trace = parse_traceparent(combined_field(request, "traceparent").value_or(""));
    if (trace) trace->parent_id = random_hex(trace->parent_id.size() / 2);
    return trace;
}

/// Our request without its query and body. `ok` is false where the target or a header is broken;
/// the request can still be answered by then.
struct Head {
    Request request;
    bool ok = true;
    std::string fault;
};

Head head_of(const httplib::Request& raw) {
    Head head;
    Request& request = head.request;
    request.method = raw.method;
    request.remote_address = raw.remote_addr;
    for (const auto& [name, value] : raw.headers) {
        std::string key = lower(name);
        if (!is_library_header(key)) {
            request.headers.emplace_back(std::move(key), value);
        } else if (raw.headers.count(name) > 1) {
            head.ok = false;
            head.fault = "The header " + key + " is the server's own: do not send it.";
        }
    }
    if (raw.version == "HTTP/1.1" && !request.header("host")) {
        head.ok = false;
        head.fault = "Send a Host header.";
    }
    const auto wished_id = request.header("x-request-id");
    request.id = wished_id && is_sane_id(*wished_id) ? std::string(*wished_id) : random_hex(8);
    request.trace = trace_of(request);
    request.path = raw.target.substr(0, raw.target.find_first_of("?#"));
    if (request.path.size() > kMaxPathBytes) return head;  // the guard says so
    auto target = parse_target(raw.target);
    if (!target || target->query.size() > kMaxQueryParameters) {
        head.ok = false;
        head.fault = target ? "Too many query parameters."
                            : "The target must be a path that begins with \"/\", with no broken "
                              "%-escape and no control character in it or its query.";
        return head;
    }
    request.query = std::move(target->query);
    return head;
}

/// The library's request is not const, only handed out so.
httplib::Request& mutable_request(const httplib::Request& raw) {
    return const_cast<httplib::Request&>(raw);
}

/// Sends the body and then makes the library close the connection: a provider that says no after
/// it has written is the one way to do so from a handler.
void write_and_close(const httplib::Request& raw, httplib::Response& out, Response&& response) {
    auto body = std::make_shared<std::string>(std::move(response.body));
    // A HEAD request never gets as far as the provider. What follows on the connection is dropped
    // with it, so that the body of the answer cannot be taken for anything else.
    if (raw.method == "HEAD") mutable_request(raw).method = "GET";
    out.set_header("Connection", "close");
    out.set_content_provider(
        body->size(), response.content_type,
        [body](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
            sink.write(body->data() + offset, length);
            std::this_thread::sleep_for(kLinger);
            return false;
        });
}

void write_response(const httplib::Request& raw, httplib::Response& out, Response&& response) {
    // Neither the library's slow compression nor its ranges are wanted (a server may ignore Range,
    // RFC 9110 14.2).
    mutable_request(raw).ranges.clear();
    mutable_request(raw).headers.erase("Accept-Encoding");
    out.status = response.status;
    for (auto& [name, value] : response.headers)
        out.set_header(name, value);
    if (response.close && !response.body.empty()) {
        write_and_close(raw, out, std::move(response));
    } else if (!response.body.empty()) {
        // As a string and not by a provider: those are cut short when the server is stopped.
        out.set_header("Content-Type", response.content_type);
        out.body = std::move(response.body);
    }
}

}  // namespace

class HttpServer::Impl {
  public:
    Impl(HttpOptions options, Admit admit, Answer answer, Finish finish, Told told)
        : options_(std::move(options)),
          admit_(std::move(admit)),
          answer_(std::move(answer)),
          finish_(std::move(finish)),
          told_(std::move(told)) {
        configure();
        install_handlers();
    }

    int bind(std::string& error) {
        errno = 0;
        int port = options_.port;
        if (port == 0) {
            port = server_.bind_to_any_port(options_.host);
        } else if (!server_.bind_to_port(options_.host, port)) {
            port = -1;
        }
        if (port <= 0) {
            const std::string where = options_.host + ":" + std::to_string(options_.port);
            error =
                "cannot listen on " + where + ": " +
                (errno != 0 ? std::strerror(errno) : "no such address") +
                (errno == EADDRINUSE ? " (another server is there; choose another --port)" : "");
            return 0;
        }
        // The library listens with a backlog of 5; the kernel lets it be raised afterwards.
        if (listener_ >= 0) ::listen(listener_, 512);
        return port;
    }

    bool serve() {
        const bool fine = stopped_ || server_.listen_after_bind();
        finished_ = true;
        return fine;
    }

    void drain() { draining_ = true; }

    void stop() {
        draining_ = true;
        stopped_ = true;
        // The library passes over a stop that comes while it starts, so it is asked again until
        // it has let go of the socket.
        const auto deadline = Clock::now() + std::chrono::seconds(2);
        while (!finished_ && Clock::now() < deadline) {
            const bool was_running = server_.is_running();
            server_.stop();
            if (was_running) return;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
    }

  private:
    void configure() {
        server_.set_tcp_nodelay(true);  // off by default, which costs 40 ms a request
        server_.set_keep_alive_max_count(1000);
        server_.set_keep_alive_timeout(options_.keep_alive.count());
        server_.set_read_timeout(options_.read_timeout.count());
        server_.set_write_timeout(options_.read_timeout.count());
        server_.set_payload_max_length(options_.limits.max_body_bytes);
        const std::size_t threads = options_.threads;
        server_.new_task_queue = [threads] { return new httplib::ThreadPool(threads); };
        // The default shares the port with any other process that asks for it.
        server_.set_socket_options([this](auto socket) {
            const int yes = 1;
            ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
            listener_ = socket;
        });
    }

    void install_handlers() {
        server_.set_pre_routing_handler([this](const httplib::Request& raw,
                                               httplib::Response& out) { return begin(raw, out); });
        server_.set_expect_100_continue_handler(
            [this](const httplib::Request& raw, httplib::Response& out) {
                return invite_body(raw, out);
            });
        // Readers of content get the bytes as they come; the library's other way treats forms
        // specially and cuts them at 8 KiB. `begin` has set the path to "/".
        const auto with_body = [this](const httplib::Request& raw, httplib::Response& out,
                                      const httplib::ContentReader& content) {
            finish_with_body(raw, out, content);
        };
        server_.Post("/", with_body);
        server_.Put("/", with_body);
        server_.Patch("/", with_body);
        server_.Delete("/", with_body);
        server_.set_error_handler([this](const httplib::Request& raw, httplib::Response& out) {
            if (!out.has_header("X-Request-Id")) answer_for_library(raw, out);
        });
        server_.set_exception_handler([](const httplib::Request&, httplib::Response& out,
                                         const std::exception_ptr&) {
            log_event(LogLevel::Error, "defect", "an exception came as far as the HTTP library");
            out.status = api::problem_status(api::ProblemType::Internal);
        });
        server_.set_post_routing_handler([this](const httplib::Request&, httplib::Response& out) {
            if (draining_ && !out.has_header("Connection")) out.set_header("Connection", "close");
            if (out.get_header_value("Connection") == "close") out.headers.erase("Keep-Alive");
            out.headers.erase("Accept-Ranges");
            const bool is_silent = out.status == kNotModified;
            if (out.body.empty() && is_silent) out.headers.erase("Content-Length");
        });
    }

    /// What is wrong with the head or with who sends it, as an answer; nothing: go on.
    std::optional<Response> refusal_of(Head& head, bool comes_again) const {
        Request& request = head.request;
        auto problem = check_request_head(request, options_.limits);
        if (!problem && !head.ok) problem = {api::ProblemType::BadRequest, head.fault, {}};
        auto response = problem ? refuse(request, *problem) : admit_(request, comes_again);
        if (!response) return std::nullopt;
        response->with("X-Request-Id", request.id);
        response->close = problem || takes_body(request.method);  // what is not read stays there
        return response;
    }

    /// Before routing and before any body: judges the head, and answers what has no body.
    Handled begin(const httplib::Request& raw, httplib::Response& out) const {
        const auto start = Clock::now();
        Head head = head_of(raw);
        if (auto refusal = refusal_of(head, false)) {
            finish(raw, out, head.request, std::move(*refusal), start);
            return Handled::Handled;
        }
        if (takes_body(raw.method)) {
            auto& mine = mutable_request(raw);
            mine.path = "/";  // all that the library's regular expressions ever see
            // No length means no body (RFC 9112 6.3), where the library would read until the
            // connection ends.
            if (!head.request.header("content-length")) mine.set_header("Content-Length", "0");
            mine.headers.erase("Content-Type");  // its parser of forms calls what nobody gave it
            pending() = std::move(head.request);
            return Handled::Unhandled;
        }
        Response response = answer_(head.request);
        finish(raw, out, head.request, std::move(response), start);
        return Handled::Handled;
    }

    /// A client that asks before it sends is refused before it has sent.
    int invite_body(const httplib::Request& raw, httplib::Response& out) const {
        Head head = head_of(raw);
        auto refusal = refusal_of(head, true);
        if (!refusal) return 100;
        finish(raw, out, head.request, std::move(*refusal), Clock::now());
        return out.status;
    }

    void finish_with_body(const httplib::Request& raw, httplib::Response& out,
                          const httplib::ContentReader& content) const {
        const auto start = Clock::now();
        Request request = std::move(pending());
        bool late = false;
        const bool whole = content([&](const char* data, std::size_t size) {
            late = Clock::now() - start > options_.body_deadline;
            if (!late) request.body.append(data, size);
            return !late;
        });
        if (whole) {
            Response response = answer_(request);
            finish(raw, out, request, std::move(response), start);
            return;
        }
        Response response =
            late ? refuse(request, api::ProblemType::RequestTimeout,
                          "The body took too long to arrive; nothing was done. Send it again.")
                 : refuse(request, api::ProblemType::BadRequest,
                          "The body ended before its Content-Length; nothing was done.");
        response.with("X-Request-Id", request.id);
        response.close = true;
        finish(raw, out, request, std::move(response), start);
    }

    /// Carries a request's head over the library's routing, which happens on the same thread.
    static Request& pending() {
        static thread_local Request request;
        return request;
    }

    void finish(const httplib::Request& raw, httplib::Response& out, const Request& request,
                Response&& response, Clock::time_point start) const {
        finish_(request, response);
        told_(request, response, seconds_since(start));
        write_response(raw, out, std::move(response));
    }

    /// For what the library refused by itself: unreadable request lines, headers that are too
    /// long, failures inside it.
    void answer_for_library(const httplib::Request& raw, httplib::Response& out) const {
        pending() = {};
        Request request;
        request.id = random_hex(8);
        request.method = raw.method.empty() ? "-" : raw.method;
        request.path = raw.target.substr(0, std::min(raw.target.find('?'), kMaxPathBytes));
        request.remote_address = raw.remote_addr;
        const api::ProblemType type = api::problem_of_status(out.status);
        Response response = refuse(
            request, type,
            type == api::ProblemType::PathTooLong
                ? "The path is longer than " + std::to_string(kMaxPathBytes) + " bytes."
            : type == api::ProblemType::Internal
                ? "A defect of the server, not of the request. Report it with the request id."
                : "The request line or a header could not be read as HTTP/1.1.");
        response.with("X-Request-Id", request.id);
        response.close = true;
        out.body.clear();
        finish(raw, out, request, std::move(response), Clock::now());
    }

    const HttpOptions options_;
    const Admit admit_;
    const Answer answer_;
    const Finish finish_;
    const Told told_;
    std::atomic<bool> draining_{false};
    int listener_ = -1;
    std::atomic<bool> stopped_{false};
    std::atomic<bool> finished_{false};
    httplib::Server server_;
};

HttpServer::HttpServer(HttpOptions options, Admit admit, Answer answer, Finish finish, Told told)
    : impl_(std::make_unique<Impl>(std::move(options), std::move(admit), std::move(answer),
                                   std::move(finish), std::move(told))) {}

HttpServer::~HttpServer() = default;

int HttpServer::bind(std::string& error) {
    return impl_->bind(error);
}

bool HttpServer::serve() {
    return impl_->serve();
}

void HttpServer::drain() {
    impl_->drain();
}

void HttpServer::stop() {
    impl_->stop();
}

}  // namespace tinsmith::server
