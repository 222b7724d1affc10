// SPDX-License-Identifier: Apache-2.0
#include "api/formats/geojson_coordinates.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "api/formats/json_reader_values.hpp"

namespace tinsmith::api {

using json::Container;
using json::Reader;
using json::Scalar;
using json::Value;

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

void CoordinatesReader::write_to(Coordinates& out) {
    out_ = &out;
    level_ = 0;
}

std::string_view CoordinatesReader::expected() const {
    if (level_ == 0) return "an array";
    switch (holds_[level_ - 1]) {
        case Holds::Numbers:
            return "a number";
        case Holds::Arrays:
            return "an array";
        default:
            return "a number or an array";
    }
}

/// Everything kept is paid for, so that a body of "[],[],[]" cannot outgrow the limit either.
bool CoordinatesReader::charge(Reader& reader) {
    if (left_ == 0) {
        reader.stop(FaultKind::TooLarge,
                    {"TOO_MANY_POLYGON_VERTICES",
                     "More than " + std::to_string(most_) + " positions; no more are taken.",
                     reader.pointer()});
        return false;
    }
    --left_;
    return true;
}

/// One such fault says it: all that follow would be its children.
void CoordinatesReader::nesting_fault(Reader& reader, std::string pointer) {
    if (out_->sound) {
        reader.add(FaultKind::Invalid,
                   {"COORDINATES_NESTING",
                    "All positions of a geometry lie in equally many arrays; this one does not.",
                    std::move(pointer)});
    }
    doubt();
}

void CoordinatesReader::doubt() {
    out_->sound = false;
    if (level_ > 0) holds_[level_ - 1] = Holds::Doubtful;
}

void CoordinatesReader::note_array(std::size_t level) {
    const std::size_t inner =
        level < Coordinates::kMostDepth ? out_->arrays[level].size() : std::size_t{0};
    out_->arrays[level - 1].push_back({out_->positions.size(), inner});
}

Container* CoordinatesReader::object(Reader& reader) {
    Value::object(reader);
    doubt();
    return nullptr;
}

Container* CoordinatesReader::array(Reader& reader) {
    if (level_ > 0 && holds_[level_ - 1] == Holds::Numbers) {
        Value::array(reader);
        doubt();
        return nullptr;
    }
    if (level_ == Coordinates::kMostDepth || (out_->depth != 0 && level_ >= out_->depth)) {
        nesting_fault(reader, reader.pointer());
        return nullptr;
    }
    if (level_ > 0 && holds_[level_ - 1] == Holds::Nothing) {
        holds_[level_ - 1] = Holds::Arrays;
        note_array(level_);
    }
    holds_[level_++] = Holds::Nothing;
    return this;
}

Value* CoordinatesReader::element(Reader&) {
    return holds_[level_ - 1] == Holds::Doubtful ? nullptr : this;
}

void CoordinatesReader::scalar(Reader& reader, const Scalar& value) {
    const Holds held = level_ == 0 ? Holds::Arrays : holds_[level_ - 1];
    const bool position_due = level_ == out_->depth;
    if (held == Holds::Arrays || (held == Holds::Nothing && !position_due && !value.is_number())) {
        Value::scalar(reader, value);
        return doubt();
    }
    if (held == Holds::Nothing) begin_position(reader);
    if (holds_[level_ - 1] == Holds::Numbers) take_number(reader, value);
}

void CoordinatesReader::begin_position(Reader& reader) {
    holds_[level_ - 1] = Holds::Numbers;
    numbers_ = 0;
    elevation_ = kNone;
    position_sound_ = charge(reader);
    if (out_->depth == 0 && out_->arrays[level_ - 1].empty()) out_->depth = level_;
    if (out_->depth == level_) return;
    std::string pointer = reader.pointer();  // of the first number: the position is around it
    pointer.resize(pointer.rfind('/'));
    nesting_fault(reader, std::move(pointer));
}

void CoordinatesReader::take_number(Reader& reader, const Scalar& value) {
    ++numbers_;
    if (numbers_ > 3) return;  // RFC 7946, 3.1.1: what comes after the elevation means nothing
    if (!value.is_number()) {
        position_sound_ = false;
        return Value::scalar(reader, value);
    }
    const bool is_elevation = numbers_ == 3;
    if (is_elevation ? std::fabs(value.number) > kMaxCoordinate
                     : !json::acceptable_coordinate(value.number)) {
        position_sound_ = false;
        reader.fault("COORDINATE_OUT_OF_RANGE", json::coordinate_out_of_range());
    }
    if (numbers_ == 1) position_.x = value.number;
    if (numbers_ == 2) position_.y = value.number;
    if (is_elevation) elevation_ = value.number;
}

void CoordinatesReader::end_position(Reader& reader) {
    if (numbers_ < 2) {
        position_sound_ = false;
        reader.fault("POSITION_TOO_SHORT", "A position is two numbers or more: [x, y].");
    }
    if (!position_sound_) position_.x = kNone;
    if (!std::isnan(elevation_) || !out_->elevations.empty()) {
        out_->elevations.resize(out_->positions.size(), kNone);
        out_->elevations.push_back(elevation_);
    }
    out_->positions.push_back(position_);
}

void CoordinatesReader::close(Reader& reader) {
    const Holds held = holds_[level_ - 1];
    if (held == Holds::Nothing && out_->depth == level_) {  // "[]" among positions
        begin_position(reader);
        end_position(reader);
    } else if (held == Holds::Nothing && charge(reader)) {
        note_array(level_);
    } else if (held == Holds::Numbers) {
        end_position(reader);
    }
    --level_;
}

}  // namespace tinsmith::api
