// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tinsmith::api::csv {

/// What parts the fields of a line.
enum class Separator { Comma, Semicolon, Tab, Blanks };

/// Of a line of data: the first of semicolon, tab and comma that it holds, else blanks.
Separator separator_of(std::string_view line);

/// One field as it stands in its line; quotes around it are taken off, blanks too.
struct Field {
    std::string_view text;
    std::size_t column = 1;  ///< where it begins, in bytes of the line, from 1
};

/// No line has more fields: what is beyond stays in the last one.
inline constexpr std::size_t kMostFields = 1000;

/// Parts a line. A field in double quotes may hold separators; quotes within it are doubled, and
/// stay so in the text. False where a quote is never closed: the last field then begins with it.
bool split(std::string_view line, Separator separator, std::vector<Field>& fields);

/// Lines of a text without their ends, which are LF, CR LF or CR.
class Lines {
  public:
    explicit Lines(std::string_view text) : text_(text) {}

    /// False at the end of the text.
    bool next(std::string_view& line);
    std::size_t number() const { return number_; }  ///< of the line last taken, from 1
    std::size_t offset() const { return offset_; }  ///< bytes taken so far

  private:
    std::string_view text_;
    std::size_t offset_ = 0;
    std::size_t number_ = 0;
};

/// Without blanks and tabs around it.
std::string_view trimmed(std::string_view text);
/// Nothing but blanks, or a comment.
bool is_passed_over(std::string_view line);
/// Without the mark of UTF-8 that some programs begin with.
std::string_view without_mark(std::string_view text);
/// Whether a line of data begins so: with a digit, a sign or a point.
bool begins_as_number(std::string_view line);

/// For a detail: quoted, cut when it is long, and with ? for what is not plain ASCII.
std::string shown(std::string_view text);

}  // namespace tinsmith::api::csv
