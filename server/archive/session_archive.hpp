// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "server/change_log.hpp"
#include "server/session.hpp"

namespace tinsmith::server {

/// Which form of these bytes this program writes, and the only one that it reads. It grows by one
/// with each change of what a session is made of.
inline constexpr std::uint32_t kArchiveFormat = 1;

// Bytes for what a session is made of, and back. What comes back is what went in, bit for bit, with
// what was shared shared again. Bytes that were not written here give nothing, whatever they are;
// that they are the ones that were written is for others to check, by a digest.
// Cost: linear in the bytes.

std::string pack(const SessionParts& parts);
/// The history keeps as much as `limits` say from then on.
std::optional<SessionImage> unpack_image(std::string_view bytes, HistoryLimits limits);

std::string pack(const ChangeAsked& asked);
std::optional<ChangeAsked> unpack_asked(std::string_view bytes);

std::string pack(const SessionFacts& facts);
std::optional<SessionFacts> unpack_facts(std::string_view bytes);

/// With the id of the API key that made the session. Where none did the bytes are those of the
/// facts alone, as they were before there were keys.
std::string pack(const SessionFacts& facts, const std::string& owner);
/// `owner` becomes what was packed with them, empty where nothing was.
std::optional<SessionFacts> unpack_facts(std::string_view bytes, std::string& owner);

std::string pack(const SessionCounts& counts);
std::optional<SessionCounts> unpack_counts(std::string_view bytes);

}  // namespace tinsmith::server
