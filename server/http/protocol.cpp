// SPDX-License-Identifier: Apache-2.0
#include "server/http/protocol.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <optional>
#include <utility>

#include <httplib.h>

#include "api/field_list.hpp"
#include "server/heap.hpp"
#include "server/http/guard.hpp"
#include "server/http/incoming.hpp"
#include "server/http/library.hpp"
#include "server/http/pace.hpp"
#include "server/http/plain_answer.hpp"
#include "server/log.hpp"
#include "server/random_id.hpp"
#include "server/reply.hpp"

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

/// To a client that asks before it sends.
constexpr std::string_view kInvitation = "HTTP/1.1 100 Continue\r\n\r\n";

bool is_library_header(const std::string& name) {
    return std::find(kLibraryHeaders.begin(), kLibraryHeaders.end(), name) != kLibraryHeaders.end();
}

Head head_of(const httplib::Request& raw) {
    std::vector<NameValue> headers;
    headers.reserve(raw.headers.size());
    std::string forged;
    for (const auto& [name, value] : raw.headers) {
        std::string key = api::lower_case(name);
        if (!is_library_header(key)) {
            headers.emplace_back(std::move(key), value);
        } else if (raw.headers.count(name) > 1) {
            forged = std::move(key);
        }
    }
    Head head = read_head(raw.method, raw.version, raw.target, std::move(headers));
    head.request.remote_address = raw.remote_addr;
    if (!forged.empty())
        head.fault = "The header " + forged + " is the server's own: do not send it.";
    return head;
}

/// The library's request is not const, only handed out so.
httplib::Request& mutable_request(const httplib::Request& raw) {
    return const_cast<httplib::Request&>(raw);
}

/// One request on its way through the library, which calls back on the same thread.
struct Exchange {
    ConnectionStream& stream;
    Request head;              ///< of a request whose body is being read
    Response answer;           ///< as the library was told it, but for its body
    std::size_t read = 0;      ///< bytes of a body
    bool is_for_head = false;  ///< it goes without its body
    bool close = false;        ///< it is the last of its connection
};

thread_local Exchange* current_exchange = nullptr;

Exchange& exchange_here() {
    return *current_exchange;
}

void write_response(const httplib::Request& raw, httplib::Response& out, Response&& response) {
    // Neither the library's slow compression nor its ranges are wanted (a server may ignore Range,
    // RFC 9110 14.2).
    mutable_request(raw).ranges.clear();
    mutable_request(raw).headers.erase("Accept-Encoding");
    out.status = response.status;
    for (auto& [name, value] : response.headers)
        out.set_header(name, value);
    if (response.close) exchange_here().close = true;
    exchange_here().is_for_head = raw.method == "HEAD";
    if (!response.sent().empty()) out.set_header("Content-Type", response.content_type);
    exchange_here().answer = std::move(response);
}

}  // namespace

class Protocol::Impl {
  public:
    Impl(const HttpOptions& options, HttpServer::Calls calls)
        : options_(options), pace_(options.patience, options.slowest), calls_(std::move(calls)) {
        library_.set_payload_max_length(options_.limits.max_body_bytes);
        install_handlers();
    }

    After exchange(Connection& connection) {
        std::size_t held = 0;
        const After after = converse(connection, held);
        // Its client has its answer by now.
        if (held >= kLargeBody) give_back_memory();
        return after;
    }

    After refuse_bytes(Connection& connection, const api::Problem& problem, bool may_wait) const {
        Request request = request_of_bytes(connection.unread());
        request.id = random_hex(8);
        request.remote_address = connection.remote().first;
        Response response = refuse(request, problem);
        response.with("X-Request-Id", request.id);
        if (problem.type == api::ProblemType::Busy) response.with("Retry-After", "1");
        calls_.finish(request, response);
        calls_.told(request, response, 0.0);
        const std::string text =
            write_last_answer(response, api::problem_title(problem.type), request.method != "HEAD");
        ConnectionStream stream(connection, may_wait ? options_.wait : std::chrono::seconds(0),
                                pace_);
        return stream.flush(text) ? After::Part : After::Drop;
    }

    void drain() { draining_ = true; }

  private:
    /// `held` becomes what it held of bodies, and has let go of.
    After converse(Connection& connection, std::size_t& held) {
        ConnectionStream stream(connection, options_.wait, pace_);
        Exchange exchange{stream, {}, {}};
        current_exchange = &exchange;
        bool closed = false, fine = false;
        try {
            fine = library_.exchange(stream, closed);
        } catch (const std::exception& failure) {
            log_event(LogLevel::Error, "defect", failure.what());
        }
        current_exchange = nullptr;
        std::string_view body;
        if (!exchange.is_for_head) body = exchange.answer.sent();
        held = exchange.read + exchange.answer.body.size();
        if (!fine || !stream.flush(body)) return After::Drop;
        return closed || exchange.close ? After::Part : After::Keep;
    }

    void install_handlers() {
        library_.set_pre_routing_handler(
            [this](const httplib::Request& raw, httplib::Response& out) {
                return begin(raw, out);
            });
        // Readers of content get the bytes as they come; the library's other way treats forms
        // specially and cuts them at 8 KiB. `begin` has set the path to "/".
        const auto with_body = [this](const httplib::Request& raw, httplib::Response& out,
                                      const httplib::ContentReader& content) {
            finish_with_body(raw, out, content);
        };
        library_.Post("/", with_body);
        library_.Put("/", with_body);
        library_.Patch("/", with_body);
        library_.Delete("/", with_body);
        library_.set_error_handler([this](const httplib::Request& raw, httplib::Response& out) {
            if (!out.has_header("X-Request-Id")) answer_for_library(raw, out);
        });
        library_.set_exception_handler([](const httplib::Request&, httplib::Response& out,
                                          const std::exception_ptr&) {
            log_event(LogLevel::Error, "defect", "an exception came as far as the HTTP library");
            out.status = api::problem_status(api::ProblemType::Internal);
        });
        library_.set_post_routing_handler([this](const httplib::Request&, httplib::Response& out) {
            tell_of_connection(out);
            tell_of_body(out);
        });
    }

    /// The library's own words on it, and on ranges, are not ours.
    void tell_of_connection(httplib::Response& out) const {
        for (const char* name : {"Connection", "Keep-Alive", "Accept-Ranges"})
            out.headers.erase(name);
        if (draining_) exchange_here().close = true;  // as it is told, so it is done
        if (exchange_here().close) {
            out.set_header("Connection", "close");
        } else {
            out.set_header("Keep-Alive", "timeout=" + std::to_string(options_.keep_alive.count()));
        }
    }

    /// The library hears of no body: it would copy it, compress it and cut ranges out of it.
    static void tell_of_body(httplib::Response& out) {
        out.headers.erase("Content-Length");
        if (out.status == kNotModified) return;
        out.set_header("Content-Length", std::to_string(exchange_here().answer.sent().size()));
    }

    /// What is wrong with the head or with who sends it, as an answer; nothing: go on.
    std::optional<Response> refusal_of(Head& head) const {
        Request& request = head.request;
        auto problem = check_request_head(request, options_.limits);
        if (!problem && !head.fault.empty())
            problem = {api::ProblemType::BadRequest, head.fault, {}};
        auto response = problem ? refuse(request, *problem) : calls_.admit(request);
        if (!response) return std::nullopt;
        response->with("X-Request-Id", request.id);
        response->close = problem || brings_body(request);  // what is not read stays there
        return response;
    }

    /// Before routing and before any body: judges the head, and answers what has no body.
    Handled begin(const httplib::Request& raw, httplib::Response& out) const {
        const auto start = Clock::now();
        // The library invites bodies for one spelling of Expect, before it has asked anyone, and
        // those of HTTP/1.0 too: all that it can have written by now.
        exchange_here().stream.forget();
        Head head = head_of(raw);
        if (raw.version != "HTTP/1.1" || asks_to_close(head.request)) exchange_here().close = true;
        if (auto refusal = refusal_of(head)) {
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
            if (raw.version == "HTTP/1.1" && awaits_invitation(head.request))
                exchange_here().stream.write(kInvitation.data(), kInvitation.size());
            exchange_here().head = std::move(head.request);
            return Handled::Unhandled;
        }
        Response response = calls_.answer(head.request);
        finish(raw, out, head.request, std::move(response), start);
        return Handled::Handled;
    }

    void finish_with_body(const httplib::Request& raw, httplib::Response& out,
                          const httplib::ContentReader& content) const {
        const auto start = Clock::now();
        Request request = std::move(exchange_here().head);
        std::size_t& read = exchange_here().read;
        bool late = false;
        const bool whole = content([&](const char* data, std::size_t size) {
            late = Clock::now() - start > options_.body_deadline ||
                   pace_.is_too_slow(start, request.body.size() + size);
            read += size;
            if (!late) request.body.append(data, size);
            return !late;
        });
        if (whole) {
            Response response = calls_.answer(request);
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

    void finish(const httplib::Request& raw, httplib::Response& out, const Request& request,
                Response&& response, Clock::time_point start) const {
        calls_.finish(request, response);
        calls_.told(request, response, std::chrono::duration<double>(Clock::now() - start).count());
        write_response(raw, out, std::move(response));
    }

    /// For what the library refused by itself: unreadable request lines, headers that are too
    /// long, failures inside it.
    void answer_for_library(const httplib::Request& raw, httplib::Response& out) const {
        Request request;
        request.id = random_hex(8);
        request.method = raw.method.empty() ? "-" : raw.method;
        request.path = raw.target.substr(0, std::min(raw.target.find('?'), kMaxPathBytes));
        request.remote_address = raw.remote_addr;
        const api::ProblemType type = api::problem_of_status(out.status);
        Response response = refuse(
            request, type,
            type == api::ProblemType::RangeRefused
                ? "The Range cannot be read. Ask for one range, or for the whole."
            : type == api::ProblemType::Internal
                ? "A defect of the server, not of the request. Report it with the request id."
                : "The request line or a header could not be read as HTTP/1.1.");
        response.with("X-Request-Id", request.id);
        response.close = true;
        out.body.clear();
        finish(raw, out, request, std::move(response), Clock::now());
    }

    const HttpOptions& options_;
    const Pace pace_;
    const HttpServer::Calls calls_;
    std::atomic<bool> draining_{false};
    Library library_;
};

Protocol::Protocol(const HttpOptions& options, HttpServer::Calls calls)
    : impl_(std::make_unique<Impl>(options, std::move(calls))) {}

Protocol::~Protocol() = default;

Protocol::After Protocol::exchange(Connection& connection) const {
    return impl_->exchange(connection);
}

Protocol::After Protocol::refuse_bytes(Connection& connection, const api::Problem& problem,
                                       bool may_wait) const {
    return impl_->refuse_bytes(connection, problem, may_wait);
}

void Protocol::drain() {
    impl_->drain();
}

}  // namespace tinsmith::server
