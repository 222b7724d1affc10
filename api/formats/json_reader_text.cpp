// SPDX-License-Identifier: Apache-2.0
#include "api/formats/json_reader_text.hpp"

#include <algorithm>

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
    names_.clear();
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
    levels_[depth_++] = {is_array, true, names_.size()};
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
    const std::size_t begin = out_->size();
    append_text(*out_, name);
    names_.push_back({begin, out_->size() - begin});
    *out_ += ':';
    return this;
}

Value* ObjectText::element(Reader&) {
    separate();
    return this;
}

void ObjectText::close(Reader& reader) {
    const Level level = levels_[--depth_];
    *out_ += level.is_array ? ']' : '}';
    if (level.is_array) return;
    refuse_repeated_names(reader, level.first_name);
    names_.resize(level.first_name);
}

void ObjectText::refuse_repeated_names(Reader& reader, std::size_t first_name) {
    // Sorted by their text, equal names stand side by side: no second copy of them is needed.
    const std::string_view text = *out_;
    const auto name_of = [&](const Slice& slice) { return text.substr(slice.begin, slice.length); };
    const auto begin = names_.begin() + static_cast<std::ptrdiff_t>(first_name);
    std::sort(begin, names_.end(),
              [&](const Slice& a, const Slice& b) { return name_of(a) < name_of(b); });
    for (auto name = begin; name != names_.end() && name + 1 != names_.end(); ++name) {
        if (name_of(*name) != name_of(name[1])) continue;
        const std::string_view inside = name_of(*name).substr(1, name->length - 2);
        reader.add(FaultKind::Invalid,
                   {"MEMBER_REPEATED", quoted(inside) + " is here more than once; give it once.",
                    pointer_to(reader.pointer(), inside)});
        if (reader.log().full()) return;
    }
}

}  // namespace tinsmith::api::json
