// SPDX-License-Identifier: Apache-2.0
#include "api/formats/json_reader_values.hpp"

#include <cmath>
#include <optional>

#include "core/types/range.hpp"

namespace tinsmith::api::json {

namespace {

constexpr std::uint64_t kLargestIndex = 0xFFFFFFFEU;  ///< all ones means "no vertex" in the core

/// The number when it is whole, not negative and exact.
std::optional<std::uint64_t> whole(const Scalar& value) {
    if (value.kind == Scalar::Kind::Natural) return value.natural;
    constexpr double exact = 9007199254740992.0;  // 2^53
    if (value.is_number() && value.number >= 0.0 && value.number <= exact &&
        std::trunc(value.number) == value.number) {
        return static_cast<std::uint64_t>(value.number);
    }
    return std::nullopt;
}

}  // namespace

bool acceptable_coordinate(double value) {
    return core::in_coordinate_range(value) && std::fabs(value) <= kMaxCoordinate;
}

std::string coordinate_out_of_range() {
    return "A coordinate is at most 1e9 in magnitude, and zero or at least 1e-60.";
}

void Text::scalar(Reader& reader, const Scalar& value) {
    if (value.kind != Scalar::Kind::Text) {
        Value::scalar(reader, value);
    } else if (value.text.size() > longest_) {
        reader.fault("TEXT_TOO_LONG", "At most " + std::to_string(longest_) + " bytes.");
    } else {
        out_ = value.text;
    }
}

void Whole::scalar(Reader& reader, const Scalar& value) {
    if (!value.is_number()) {
        Value::scalar(reader, value);
        return;
    }
    const auto number = whole(value);
    if (!number || *number < least_ || *number > most_) {
        reader.fault("NUMBER_OUT_OF_RANGE", "Expected a whole number from " +
                                                std::to_string(least_) + " to " +
                                                std::to_string(most_) + ".");
        return;
    }
    out_ = *number;
}

bool Object::has(std::string_view name) const {
    for (std::size_t i = 0; i < members_.size(); ++i) {
        if (members_[i].name == name) return (seen_ >> i & 1U) != 0;
    }
    return false;
}

std::string Object::known() const {
    std::string out;
    for (const Member& member : members_) {
        if (!out.empty()) out += ", ";
        out += member.name;
    }
    return out;
}

Container* Object::object(Reader& reader) {
    seen_ = 0;
    begun(reader);
    return this;
}

Value* Object::member(Reader& reader, std::string_view name) {
    for (std::size_t i = 0; i < members_.size(); ++i) {
        if (members_[i].name != name) continue;
        seen_ |= 1U << i;
        return members_[i].value;
    }
    if (unknown_ == Unknown::Refuse) {
        reader.fault("MEMBER_UNKNOWN",
                     quoted(name) + " means nothing here. Known are: " + known() + ".");
    }
    return nullptr;
}

void Object::close(Reader& reader) {
    bool whole_object = true;
    for (std::size_t i = 0; i < members_.size(); ++i) {
        if (!members_[i].required || (seen_ >> i & 1U) != 0) continue;
        reader.fault("MEMBER_MISSING", quoted(members_[i].name) + " is needed here.");
        whole_object = false;
    }
    if (whole_object) ended(reader);
}

Container* Tuple::array(Reader&) {
    count_ = 0;
    numbers_ = {};
    return this;
}

Value* Tuple::element(Reader&) {
    ++count_;
    return count_ <= size_ ? &item_ : nullptr;
}

void Tuple::close(Reader& reader) {
    if (count_ != size_) {
        reader.fault("WRONG_LENGTH", "Expected " + std::string(what_) + "; here are " +
                                         std::to_string(count_) + " values.");
    }
    complete(reader);
}

std::string_view Tuple::Item::expected() const {
    return items_ == Items::Index ? "a vertex index" : "a number";
}

void Tuple::Item::scalar(Reader& reader, const Scalar& value) {
    if (!value.is_number()) {
        Value::scalar(reader, value);
        return;
    }
    if (items_ == Items::Index) {
        const auto index = whole(value);
        if (!index || *index > kLargestIndex) {
            reader.fault("INDEX_INVALID",
                         "A vertex index is a whole number, counted from 0; this is none.");
            return;
        }
    } else if (!acceptable_coordinate(value.number)) {
        reader.fault("COORDINATE_OUT_OF_RANGE", coordinate_out_of_range());
        return;
    }
    tuple_.numbers_[tuple_.count_ - 1] = value.number;
}

void Number::scalar(Reader& reader, const Scalar& value) {
    if (!value.is_number()) return Value::scalar(reader, value);
    if (!acceptable_coordinate(value.number))
        return reader.fault("NUMBER_OUT_OF_RANGE", coordinate_out_of_range());
    number_ = value.number;
}

}  // namespace tinsmith::api::json
