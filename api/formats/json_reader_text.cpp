// SPDX-License-Identifier: Apache-2.0
#include "api/formats/json_reader_text.hpp"

namespace tinsmith::api::json {

void append_text(std::string& out, std::string_view text) {
    constexpr std::string_view hex = "0123456789abcdef";
    out += '"';
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (c == '\n') {
            out += "\\n";
        } else if (const auto code = static_cast<unsigned char>(c); code < 0x20) {
            out += "\\u00";
            out += hex[code >> 4U];
            out += hex[code & 15U];
        } else {
            out += c;
        }
    }
    out += '"';
}

void ObjectText::write_to(std::string& out) {
    out_ = &out;
    depth_ = 0;
}

void ObjectText::separate() {
    if (depth_ == 0) return;
    Level& level = levels_[depth_ - 1];
    if (!level.empty) *out_ += ',';
    level.empty = false;
}

void ObjectText::scalar(Reader& reader, const Scalar& value) {
    if (depth_ == 0) {
        if (value.kind != Scalar::Kind::Null) Value::scalar(reader, value);
    } else if (value.kind == Scalar::Kind::Text) {
        append_text(*out_, value.text);
    } else {
        *out_ += plain_text(value);
    }
}

Container* ObjectText::open(bool is_array) {
    if (depth_ == 0) out_->clear();
    *out_ += is_array ? '[' : '{';
    levels_[depth_++] = {is_array, true};
    return this;
}

Container* ObjectText::object(Reader&) {
    return open(false);
}

Container* ObjectText::array(Reader& reader) {
    return depth_ == 0 ? Value::array(reader) : open(true);
}

Value* ObjectText::member(Reader&, std::string_view name) {
    separate();
    append_text(*out_, name);
    *out_ += ':';
    return this;
}

Value* ObjectText::element(Reader&) {
    separate();
    return this;
}

void ObjectText::close(Reader&) {
    *out_ += levels_[--depth_].is_array ? ']' : '}';
}

}  // namespace tinsmith::api::json
