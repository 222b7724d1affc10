// SPDX-License-Identifier: Apache-2.0
#include "server/keys/gate.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include "api/field_list.hpp"
#include "server/reply.hpp"
#include "server/target.hpp"

namespace tinsmith::server {

namespace {

using api::ProblemType;

/// Seconds after which one of several requests has probably ended.
constexpr double kMoment = 1.0;

/// The segment is decoded as the router does it: /%761/ is /v1/.
bool is_behind_keys(const Request& request) {
    static constexpr std::array<std::string_view, 2> kKept{"v1", "metrics"};
    if (request.method == "OPTIONS") return false;
    const auto segments = split_path(request.path);
    return segments && !segments->empty() &&
           std::find(kKept.begin(), kKept.end(), segments->front()) != kKept.end();
}

/// The one key that the request shows; empty: none that could be one.
std::string_view shown_key(const Request& request) {
    constexpr std::string_view kScheme = "bearer ";
    std::string_view field;
    for (const auto& [name, value] : request.headers) {
        if (name != "authorization") continue;
        if (!field.empty()) return {};  // which of them is meant?
        field = value;
    }
    if (api::lower_case(field.substr(0, kScheme.size())) != kScheme) return {};
    field.remove_prefix(kScheme.size());
    while (field.starts_with(' '))
        field.remove_prefix(1);
    return field;
}

Response refuse_stranger(const Request& request) {
    const bool shows_something = request.header("authorization").has_value();
    return refuse(
               request, ProblemType::KeyRequired,
               shows_something
                   ? "What Authorization says is not one of this server's API keys. It takes the "
                     "form \"Authorization: Bearer KEY\"; ask the operator for a key."
                   : "This needs an API key: send it as \"Authorization: Bearer KEY\". The "
                     "operator makes one with \"tinsmith key add NAME\".")
        .with("WWW-Authenticate", shows_something
                                      ? "Bearer realm=\"tinsmith\", error=\"invalid_token\""
                                      : "Bearer realm=\"tinsmith\"");
}

Response refuse_for_now(const Request& request, std::string_view quota, double value,
                        std::string_view why, double seconds) {
    std::string detail("The quota ");
    detail.append(quota).append(" of this key is ").append(quota_text(value)).append(", and ");
    detail.append(why).append(": ask again when Retry-After says.");
    return refuse(request, ProblemType::TooManyRequests, std::move(detail))
        .with("Retry-After", quota_text(std::ceil(seconds)));
}

/// A body that is longer than the key may send. What is no length is for others to refuse.
std::optional<Response> refuse_length(const Request& request, const KeyQuotas& quotas) {
    const auto text = request.header("content-length");
    if (!quotas.max_body_bytes || !text) return std::nullopt;
    std::uint64_t length = 0;
    const auto [stop, error] = std::from_chars(text->data(), text->data() + text->size(), length);
    if (error != std::errc() || length <= *quotas.max_body_bytes) return std::nullopt;
    return refuse(request, ProblemType::BodyTooLarge,
                  "The body has " + std::to_string(length) +
                      " bytes, the quota max_body_bytes of this key is " +
                      std::to_string(*quotas.max_body_bytes) + ". Send less.");
}

}  // namespace

/// One request of a key that is being answered.
class Gate::Pass {
  public:
    /// Requires: the gate's lock.
    Pass(Gate& gate, std::string id, Use& use) : gate_(gate), id_(std::move(id)) {
        ++use.in_flight;
    }
    ~Pass() {
        const std::lock_guard lock(gate_.mutex_);
        --gate_.uses_.find(id_)->second.in_flight;
    }
    Pass(const Pass&) = delete;
    Pass& operator=(const Pass&) = delete;

  private:
    Gate& gate_;
    const std::string id_;
};

Gate::Gate(const KeyRing& keys, Clock clock) : keys_(keys), clock_(std::move(clock)) {}

std::optional<Response> Gate::admit(Request& request) {
    if (!is_behind_keys(request) || !keys_.wants_keys()) return std::nullopt;
    auto asker = keys_.find(shown_key(request));
    if (!asker) return refuse_stranger(request);
    request.asker = *std::move(asker);
    const KeyQuotas& quotas = request.asker.quotas;
    if (auto refusal = refuse_length(request, quotas)) return refusal;
    if (!quotas.max_requests && !quotas.max_requests_per_second) return std::nullopt;
    const std::lock_guard lock(mutex_);
    Use& use = uses_[request.asker.id];
    if (quotas.max_requests && use.in_flight >= *quotas.max_requests) {
        return refuse_for_now(request, "max_requests", static_cast<double>(*quotas.max_requests),
                              "as many of its requests are under way", kMoment);
    }
    if (quotas.max_requests_per_second) {
        const double rate = *quotas.max_requests_per_second;
        if (const double wait = take_token(use, rate, clock_()); wait > 0.0) {
            return refuse_for_now(request, "max_requests_per_second", rate, "more than that came",
                                  wait);
        }
    }
    request.pass = std::make_shared<const Pass>(*this, request.asker.id, use);
    return std::nullopt;
}

/// A bucket that holds what a second allows, one at least. Returns 0 where there was a token, else
/// the seconds until there is.
double Gate::take_token(Use& use, double rate, Time now) {
    const double most = std::max(rate, 1.0);
    const double seconds =
        use.filled ? std::chrono::duration<double>(now - *use.filled).count() : most / rate;
    use.tokens = std::min(most, use.tokens + seconds * rate);
    use.filled = now;
    if (use.tokens < 1.0) return (1.0 - use.tokens) / rate;
    use.tokens -= 1.0;
    return 0.0;
}

}  // namespace tinsmith::server
