// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "api/problem.hpp"

namespace tinsmith::server {

/// The longest head: request line, headers and the empty line after them.
inline constexpr std::size_t kMaxHeadBytes = std::size_t{64} << 10;

/// The longest request line and the longest header, without their line ends: what the library
/// takes.
inline constexpr std::size_t kMaxLineBytes = 8190;

/// How many bytes the head takes at the beginning of `bytes`; 0: its empty line has not come yet.
/// `looked_at` bytes of them were looked at before, so that a head that drips in costs no more than
/// one that comes whole.
std::size_t size_of_head(std::string_view bytes, std::size_t looked_at = 0);

/// What is wrong with a whole head as bytes. Programs disagree on line ends without a return, lines
/// that go on, lines without a colon and control characters (RFC 9112 2.2, 5.2, 11.2), and where
/// they disagree, a request hides in another: none of it is read here. Cost: linear.
std::optional<api::Problem> check_head_bytes(std::string_view head);

/// A piece of a head.
struct HeadPart {
    std::size_t begin = 0;
    std::size_t size = 0;
};

/// The first Range header whose unit is not bytes, its line end included. Such a header is to be
/// passed over (RFC 9110 14.2), where the library refuses it. Requires: `check_head_bytes` found
/// nothing. Cost: linear.
std::optional<HeadPart> range_of_other_unit(std::string_view head);

/// Why a head that has grown to `kMaxHeadBytes` is refused.
api::Problem head_too_large(std::string_view bytes);

}  // namespace tinsmith::server
