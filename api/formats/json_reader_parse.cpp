// SPDX-License-Identifier: Apache-2.0
// The one file that knows the JSON library's parser: its events become the reader's.
#include <algorithm>
#include <cstddef>
#include <iterator>
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

/// Goes through the body and leaves behind where it is.
class Walker {
  public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    Walker(const char* at, const char** seen) : at_(at), seen_(seen) {}
    reference operator*() const { return *at_; }
    Walker& operator++() {
        *seen_ = ++at_;
        return *this;
    }
    Walker operator++(int) {
        const Walker before = *this;
        ++*this;
        return before;
    }
    friend bool operator==(const Walker& a, const Walker& b) { return a.at_ == b.at_; }

  private:
    const char* at_;
    const char** seen_;
};

class Events {
  public:
    Events(std::string_view body, Reader& reader) : body_(body), reader_(reader) {}

    /// Where the parser is, for `Walker`.
    const char** parser_place() { return &at_; }

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
        const std::string why = reason(error.what());
        if (error.id == kNumberOverflow) {
            reader_.overflow("At " + place(body_, read) + ": " + why + "; no double is as large.");
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
        const auto read = static_cast<double>(at_ - body_.data());
        return reader_.has_come_to(read / static_cast<double>(body_.size()));
    }

    std::string_view body_;
    Reader& reader_;
    const char* at_ = body_.data();
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
    Events events(body, reader);
    const char* const end = body.data() + body.size();
    nlohmann::json::sax_parse(Walker(body.data(), events.parser_place()),
                              Walker(end, events.parser_place()), &events);
}

}  // namespace tinsmith::api::json
