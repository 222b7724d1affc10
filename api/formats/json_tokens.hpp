// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

/// What bounds single parts of a JSON text, before and while the library reads it.
namespace tinsmith::api::json {

/// Longest text and name, as written between its quotes. The library keeps the one that it is at
/// several times over, in buffers that double.
inline constexpr std::size_t kLongestText = std::size_t{256} << 10;
/// Longest number, as written. A double in full has 1100 digits at most; nobody writes half of it.
inline constexpr std::size_t kLongestNumber = 512;
/// Members of one object. No table that anybody keeps has as many columns.
inline constexpr std::size_t kMostMembers = 10'000;

struct LongToken {
    std::size_t begin = 0;  ///< its first byte; of a text, the quote
    bool is_text = false;   ///< or a name; otherwise a number
};

/// The first text, name or number that is too long, in what is JSON until there. Cost: linear, no
/// memory.
std::optional<LongToken> first_long_token(std::string_view body);

/// Long texts that hold neither escapes nor anything but ASCII, such as data: URIs, say what is
/// written: whoever wants them takes them from the body. `begin` and `end` are between the quotes.
struct PlainText {
    std::size_t begin = 0;
    std::size_t end = 0;
};
struct LongTokens {
    std::vector<PlainText> plain_texts;
    std::optional<LongToken> other;  ///< the first that is not of these; nothing behind it counts
};
/// Cost: linear.
LongTokens long_tokens(std::string_view body);

/// Whether what is written as a number is one other than zero, whatever double came of it.
bool is_written_nonzero(std::string_view number);

/// The names of one object. They are told apart by a hash of 64 bits.
/// Memory: 8 bytes for each of the first few, about 50 for others.
class NameSet {
  public:
    void clear();
    /// False: it is there already.
    bool add(std::string_view name);
    std::size_t size() const { return few_.size() + many_.size(); }

  private:
    std::vector<std::uint64_t> few_;
    std::set<std::uint64_t> many_;  ///< no hash table: names can be chosen to fall together
};

}  // namespace tinsmith::api::json
