// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "api/formats/json_reader.hpp"

namespace tinsmith::api::json {

/// Keeps an object, whatever is in it, as compact JSON text: members in their order, real numbers
/// as they were written. null is kept as "{}".
class ObjectText : public Value, public Container {
  public:
    /// Requires: the text stays where it is until the object has been read.
    void write_to(std::string& out);

    void scalar(Reader& reader, const Scalar& value) override;
    Container* object(Reader& reader) override;
    Container* array(Reader& reader) override;
    Value* member(Reader& reader, std::string_view name) override;
    Value* element(Reader& reader) override;
    void close(Reader& reader) override;

  protected:
    std::string_view expected() const override { return "an object or null"; }

  private:
    struct Level {
        bool is_array = false;
        bool empty = true;
    };

    Container* open(bool is_array);
    void separate();

    std::string* out_ = nullptr;
    std::array<Level, kMaxDepth> levels_;
    std::size_t depth_ = 0;
};

/// Appends a text as JSON, with quotes. Requires: UTF-8.
void append_text(std::string& out, std::string_view text);

}  // namespace tinsmith::api::json
