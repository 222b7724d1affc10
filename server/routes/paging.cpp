// SPDX-License-Identifier: Apache-2.0
#include "server/routes/paging.hpp"

#include <charconv>
#include <optional>
#include <utility>

#include "server/hex.hpp"
#include "server/random_id.hpp"
#include "server/reply.hpp"

namespace tinsmith::server {

namespace {

std::optional<std::size_t> limit_in(std::string_view text) {
    std::size_t limit = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, limit);
    const bool fine = error == std::errc() && stop == end && limit >= 1 && limit <= kMostOfAPage;
    return fine ? std::optional(limit) : std::nullopt;
}

std::optional<std::string> id_in(std::string_view cursor, std::string_view kind) {
    auto text = from_hex(cursor);
    const std::string front = std::string(kind) + ":";
    if (!text || !text->starts_with(front)) return std::nullopt;
    text->erase(0, front.size());
    return is_sane_id(*text) ? text : std::nullopt;
}

}  // namespace

Step<Page> require_page(const Request& request, std::string_view kind) {
    Page page;
    api::Faults faults;
    const auto fault = [&faults](const char* name, std::string detail) {
        faults.push_back({"INVALID_PARAMETER", std::move(detail), {}, {}, {}, name});
    };
    if (const auto text = request.parameter("limit")) {
        const auto limit = limit_in(*text);
        if (limit) page.limit = *limit;
        if (!limit)
            fault("limit", "limit is a number from 1 to " + std::to_string(kMostOfAPage) + ".");
    }
    if (const auto text = request.parameter("cursor")) {
        auto after = id_in(*text, kind);
        if (after) {
            page.after = *std::move(after);
        } else {
            fault(
                "cursor",
                "This is no cursor of this list: take it from the Link header of the page before.");
        }
    }
    if (faults.empty()) return page;
    return refuse(request, api::problem_of_faults(api::FaultKind::Parameter, std::move(faults)));
}

std::string next_link(const Request& request, std::string_view kind, std::size_t limit,
                      std::string_view last) {
    return "<" + request.path + "?limit=" + std::to_string(limit) +
           "&cursor=" + hex_of(std::string(kind) + ":" + std::string(last)) + ">; rel=\"next\"";
}

}  // namespace tinsmith::server
