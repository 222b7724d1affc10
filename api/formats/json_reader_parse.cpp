// SPDX-License-Identifier: Apache-2.0
// The one file that knows the JSON library's parser: its events become the reader's.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "api/formats/json_reader.hpp"

namespace tinsmith::api::json {

namespace {

constexpr int kNumberOverflow = 406;  ///< nlohmann's id of "number overflow parsing '1e400'"
constexpr std::size_t kLongestReason = 300;

/// The library's message without its tag and without what might not be UTF-8: it quotes the body.
std::string reason(std::string_view what) {
    if (const auto tag = what.find("] "); what.starts_with('[') && tag != what.npos) {
        what.remove_prefix(tag + 2);
    }
    constexpr std::string_view place = "parse error at ";
    if (what.starts_with(place)) what.remove_prefix(std::min(what.find(": "), what.size() - 2) + 2);
    std::string out(what.substr(0, kLongestReason));
    for (char& c : out) {
        if (c < ' ' || c > '~') c = '?';
    }
    if (what.size() > kLongestReason) out += "...";
    return out;
}

/// "line 3, column 14 (byte 57)", counted from one. `read` is how many bytes have been read.
std::string place(std::string_view body, std::size_t read) {
    const std::size_t at = std::min(read == 0 ? 0 : read - 1, body.size());
    const std::string_view before = body.substr(0, at);
    const auto line = std::count(before.begin(), before.end(), '\n') + 1;
    const std::size_t start = before.rfind('\n');  // npos + 1 is 0: the body's first line
    return "line " + std::to_string(line) + ", column " + std::to_string(at - (start + 1) + 1) +
           " (byte " + std::to_string(at + 1) + ")";
}

/// What people's programs write where they have no number.
std::string hint_at(std::string_view body, std::size_t read) {
    const auto is_letter = [&](std::size_t i) {
        return i < body.size() &&
               ((body[i] >= 'a' && body[i] <= 'z') || (body[i] >= 'A' && body[i] <= 'Z'));
    };
    constexpr std::size_t kLongestWord = 10;
    std::size_t begin = read == 0 ? 0 : read - 1;
    while (begin > 0 && read - begin < kLongestWord && is_letter(begin - 1))
        --begin;
    std::string word;
    for (std::size_t i = begin; word.size() < kLongestWord && is_letter(i); ++i)
        word += static_cast<char>(body[i] | 0x20);
    constexpr std::array<std::string_view, 3> kNoNumbers{"nan", "inf", "infinity"};
    if (std::find(kNoNumbers.begin(), kNoNumbers.end(), word) == kNoNumbers.end()) return {};
    return ". JSON has no NaN and no Infinity: give a number, or null where that is taken";
}

/// Where the parser is, and whether it has asked for more than there is.
struct Place {
    const char* at = nullptr;
    bool has_ended = false;
};

/// Goes through the body and leaves behind where it is.
class Walker {
  public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    Walker(const char* at, Place* place) : at_(at), place_(place) {}
    reference operator*() const { return *at_; }
    Walker& operator++() {
        place_->at = ++at_;
        return *this;
    }
    Walker operator++(int) {
        const Walker before = *this;
        ++*this;
        return before;
    }
    friend bool operator==(const Walker& a, const Walker& b) {
        if (a.at_ != b.at_) return false;
        a.place_->has_ended = true;  // only the end is ever compared with
        return true;
    }

  private:
    const char* at_;
    Place* place_;
};

class Events {
  public:
    /// The parser is given the body up to the token that is too long, if there is one.
    Events(std::string_view body, std::optional<LongToken> too_long, Reader& reader)
        : body_(body), too_long_(too_long), reader_(reader) {
        place_.at = body.data();
    }

    /// For `Walker`.
    Place* parser_place() { return &place_; }

    bool null() { return reader_.take_scalar({}); }
    bool boolean(bool value) {
        Scalar scalar;
        scalar.kind = Scalar::Kind::Boolean;
        scalar.boolean = value;
        return reader_.take_scalar(scalar);
    }
    bool number_integer(std::int64_t value) {
        Scalar scalar;
        scalar.kind = Scalar::Kind::Negative;
        scalar.negative = value;
        scalar.number = static_cast<double>(value);
        return reader_.take_scalar(scalar) && goes_on();
    }
    bool number_unsigned(std::uint64_t value) {
        Scalar scalar;
        scalar.kind = Scalar::Kind::Natural;
        scalar.natural = value;
        scalar.number = static_cast<double>(value);
        return reader_.take_scalar(scalar) && goes_on();
    }
    bool number_float(double value, const std::string& written) {
        Scalar scalar;
        scalar.kind = Scalar::Kind::Real;
        scalar.number = value;
        if (value == 0.0 && is_written_nonzero(written))
            scalar.number = std::copysign(std::numeric_limits<double>::denorm_min(), value);
        scalar.text = written;
        return reader_.take_scalar(scalar) && goes_on();
    }
    bool string(const std::string& value) {
        Scalar scalar;
        scalar.kind = Scalar::Kind::Text;
        scalar.text = value;
        return reader_.take_scalar(scalar);
    }
    bool binary(const nlohmann::json::binary_t&) { return false; }  // never in JSON text
    bool start_object(std::size_t) { return reader_.open(false); }
    bool key(const std::string& name) { return reader_.take_name(name); }
    bool end_object() { return reader_.close(); }
    bool start_array(std::size_t) { return reader_.open(true) && goes_on(); }
    bool end_array() { return reader_.close(); }

    bool parse_error(std::size_t read, const std::string&, const nlohmann::json::exception& error) {
        if (too_long_ && place_.has_ended) {
            refuse_too_long();
            return false;
        }
        const std::string why = reason(error.what()) + hint_at(body_, read);
        if (error.id == kNumberOverflow) {
            reader_.refuse_next(
                false, "NUMBER_OUT_OF_RANGE",
                "At " + place(body_, read) + ": " + why + "; no double is as large.");
        } else {
            reader_.stop(
                FaultKind::Syntax,
                {"JSON_SYNTAX", "The body is no JSON: at " + place(body_, read) + ": " + why, ""});
        }
        return false;
    }

  private:
    /// What is long is made of many arrays or numbers.
    bool goes_on() {
        constexpr std::size_t kAskEvery = 4096;
        if (!reader_.is_watched() || ++asked_ % kAskEvery != 0) return true;
        const auto read = static_cast<double>(place_.at - body_.data());
        return reader_.has_come_to(read / static_cast<double>(body_.size()));
    }

    void refuse_too_long() {
        const std::size_t begin = too_long_->begin;
        const std::string where = "At " + place(body_, begin + 1) + " begins a ";
        if (!too_long_->is_text) {
            reader_.refuse_next(false, "NUMBER_TOO_LONG",
                                where + "number of more than " + std::to_string(kLongestNumber) +
                                    " characters: 17 digits say all that a double holds.");
            return;
        }
        const std::size_t before = body_.substr(0, begin).find_last_not_of(" \t\r\n");
        const bool is_value = before != body_.npos && body_[before] == ':';
        const bool is_name = reader_.is_in_object() && !is_value;
        reader_.refuse_next(is_name, "TEXT_TOO_LONG",
                            where + (is_name ? "name" : "text") + " of more than " +
                                std::to_string(kLongestText) + " bytes: shorten it.");
    }

    std::string_view body_;
    std::optional<LongToken> too_long_;
    Reader& reader_;
    Place place_;
    std::size_t asked_ = 0;
};

}  // namespace

void read(std::string_view body, Reader& reader) {
    if (body.empty()) {
        reader.stop(FaultKind::Syntax, {"JSON_SYNTAX", "The body is empty.", ""});
        return;
    }
    // The library takes one for the end, whatever follows.
    if (const std::size_t zero = body.find('\0'); zero != body.npos) {
        reader.stop(FaultKind::Syntax, {"JSON_SYNTAX",
                                        "The body is no JSON: at " + place(body, zero + 1) +
                                            " there is a zero byte. JSON is text in UTF-8.",
                                        ""});
        return;
    }
    const auto too_long = first_long_token(body);
    Events events(body, too_long, reader);
    const char* const end = body.data() + (too_long ? too_long->begin : body.size());
    nlohmann::json::sax_parse(Walker(body.data(), events.parser_place()),
                              Walker(end, events.parser_place()), &events);
}

}  // namespace tinsmith::api::json
