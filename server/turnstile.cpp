// SPDX-License-Identifier: Apache-2.0
#include "server/turnstile.hpp"

#include <memory>
#include <string>
#include <utility>

#include "server/reply.hpp"
#include "server/target.hpp"

namespace tinsmith::server {

namespace {

/// The segment is decoded as the router does it: /%761/ is /v1/.
bool is_counted(const Request& request) {
    if (request.method == "OPTIONS") return false;
    const auto segments = split_path(request.path);
    return segments && !segments->empty() && segments->front() == "v1";
}

}  // namespace

/// One request that is inside, and what else it holds.
class Turnstile::Pass {
  public:
    Pass(std::atomic<std::size_t>& inside, std::shared_ptr<const void> other)
        : inside_(inside), other_(std::move(other)) {}
    ~Pass() { --inside_; }
    Pass(const Pass&) = delete;
    Pass& operator=(const Pass&) = delete;

  private:
    std::atomic<std::size_t>& inside_;
    const std::shared_ptr<const void> other_;
};

std::optional<Response> Turnstile::admit(Request& request) {
    if (!is_counted(request)) return std::nullopt;
    std::size_t now = inside_;
    do {
        if (now >= most_) return refuse_for_now(request);
    } while (!inside_.compare_exchange_weak(now, now + 1));
    request.pass = std::make_shared<const Pass>(inside_, std::move(request.pass));
    return std::nullopt;
}

Response Turnstile::refuse_for_now(const Request& request) const {
    return refuse(request, api::ProblemType::Busy,
                  "The limit max_requests of " + std::to_string(most_) +
                      " at the same time is reached: ask again when Retry-After says.")
        .with("Retry-After", "1");
}

}  // namespace tinsmith::server
