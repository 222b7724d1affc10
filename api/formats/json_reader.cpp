// SPDX-License-Identifier: Apache-2.0
#include "api/formats/json_reader.hpp"

#include <utility>

namespace tinsmith::api::json {

namespace {

constexpr std::size_t kLongestName = 200;  ///< in pointers
constexpr std::size_t kLongestQuote = 60;  ///< in details

/// At most `most` bytes of UTF-8, never half a character.
std::string_view cut(std::string_view text, std::size_t most) {
    if (text.size() <= most) return text;
    const auto continues = [&](std::size_t at) {
        return (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U;
    };
    while (most > 0 && continues(most))
        --most;
    return text.substr(0, most);
}

std::string_view kind_name(const Scalar& value) {
    switch (value.kind) {
        case Scalar::Kind::Null:
            return "null";
        case Scalar::Kind::Boolean:
            return "true or false";
        case Scalar::Kind::Text:
            return "a text";
        default:
            return "a number";
    }
}

std::string wrong_type(std::string_view expected, std::string_view found) {
    return "Expected " + std::string(expected) + ", found " + std::string(found) + ".";
}

}  // namespace

std::string plain_text(const Scalar& scalar) {
    switch (scalar.kind) {
        case Scalar::Kind::Null:
            return "null";
        case Scalar::Kind::Boolean:
            return scalar.boolean ? "true" : "false";
        case Scalar::Kind::Natural:
            return std::to_string(scalar.natural);
        case Scalar::Kind::Negative:
            return std::to_string(scalar.negative);
        default:
            return std::string(scalar.text);
    }
}

std::string quoted(std::string_view text) {
    const std::string_view shown = cut(text, kLongestQuote);
    std::string out = "\"" + std::string(shown);
    out += shown.size() < text.size() ? "...\"" : "\"";
    return out;
}

std::string pointer_to(std::string base, std::string_view name) {
    base += '/';
    for (const char c : cut(name, kLongestName)) {
        if (c == '~') {
            base += "~0";
        } else if (c == '/') {
            base += "~1";
        } else {
            base += c;
        }
    }
    return base;
}

std::string pointer_to(std::string base, std::uint64_t index) {
    return std::move(base) + "/" + std::to_string(index);
}

void Value::scalar(Reader& reader, const Scalar& value) {
    reader.fault("WRONG_TYPE", wrong_type(expected(), kind_name(value)));
}

Container* Value::object(Reader& reader) {
    reader.fault("WRONG_TYPE", wrong_type(expected(), "an object"));
    return nullptr;
}

Container* Value::array(Reader& reader) {
    reader.fault("WRONG_TYPE", wrong_type(expected(), "an array"));
    return nullptr;
}

Value* Container::member(Reader&, std::string_view) {
    return nullptr;
}
Value* Container::element(Reader&) {
    return nullptr;
}
void Container::close(Reader&) {}

std::string Reader::pointer() const {
    std::string out;
    for (std::size_t i = 0; i < depth_ && frames_[i].started; ++i) {
        const Frame& frame = frames_[i];
        out = frame.is_array ? pointer_to(std::move(out), frame.index)
                             : pointer_to(std::move(out), frame.name);
    }
    return out;
}

void Reader::fault(std::string code, std::string detail) {
    add(FaultKind::Invalid, {std::move(code), std::move(detail), pointer()});
}

void Reader::add(FaultKind kind, Fault fault) {
    log_.add(kind, std::move(fault));
}

void Reader::stop(FaultKind kind, Fault fault) {
    add(kind, std::move(fault));
    stopped_ = true;
}

bool Reader::has_come_to(double share) {
    if (!progress_(share)) stop(FaultKind::Stopped, reading_stopped());
    return going();
}

Value* Reader::next_value() {
    if (depth_ == 0) return root_;
    Frame& frame = frames_[depth_ - 1];
    if (!frame.is_array) return std::exchange(named_, nullptr);
    if (frame.started) ++frame.index;
    frame.started = true;
    return frame.container == nullptr ? nullptr : frame.container->element(*this);
}

bool Reader::take_scalar(const Scalar& value) {
    Value* const taker = next_value();
    if (taker != nullptr) taker->scalar(*this, value);
    return going();
}

bool Reader::take_name(std::string_view name) {
    Frame& frame = frames_[depth_ - 1];
    frame.name = cut(name, kLongestName);
    frame.started = true;
    if (!frame.names.add(name)) {
        fault("MEMBER_REPEATED", quoted(name) + " is here more than once; give it once.");
        return going();  // nobody takes its value
    }
    if (frame.names.size() > kMostMembers) {
        stop(FaultKind::TooLarge, {"TOO_MANY_MEMBERS",
                                   "An object has at most " + std::to_string(kMostMembers) +
                                       " members; no more are taken.",
                                   pointer()});
    }
    named_ = frame.container == nullptr ? nullptr : frame.container->member(*this, name);
    return going();
}

bool Reader::open(bool is_array) {
    Value* const taker = next_value();
    if (depth_ == kMaxDepth) {
        stop(FaultKind::Syntax,
             {"JSON_TOO_DEEP",
              "Arrays and objects are nested more than " + std::to_string(kMaxDepth) + " deep.",
              pointer()});
        return false;
    }
    Container* inside = nullptr;
    if (taker != nullptr) inside = is_array ? taker->array(*this) : taker->object(*this);
    Frame& frame = frames_[depth_++];
    frame.container = inside;
    frame.is_array = is_array;
    frame.started = false;
    frame.index = 0;
    frame.names.clear();
    return going();
}

bool Reader::close() {
    Container* const closed = frames_[--depth_].container;
    if (closed != nullptr) closed->close(*this);
    return going();
}

void Reader::refuse_next(bool is_name, std::string code, std::string detail) {
    if (is_name) {
        frames_[depth_ - 1].started = false;
    } else {
        next_value();  // only to step on to its place
    }
    stop(FaultKind::Invalid, {std::move(code), std::move(detail), pointer()});
}

}  // namespace tinsmith::api::json
