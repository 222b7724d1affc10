// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "api/formats/json_reader.hpp"

namespace tinsmith::api::json {

/// Keeps an object, whatever is in it, as compact JSON text: members in their order, real numbers
/// as they were written. A name given twice in one object is a fault. null is kept as "{}".
/// Memory: the text, and 16 bytes for each name of the objects that are open.
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
    /// A name in the text, with its quotes.
    struct Slice {
        std::size_t begin;
        std::size_t length;
    };
    struct Level {
        bool is_array = false;
        bool empty = true;
        std::size_t first_name = 0;  ///< index into names_: this object's are from here on
    };

    Container* open(bool is_array);
    void separate();
    void refuse_repeated_names(Reader& reader, std::size_t first_name);

    std::string* out_ = nullptr;
    std::array<Level, kMaxDepth> levels_;
    std::size_t depth_ = 0;
    std::vector<Slice> names_;  ///< of all objects that are open
};

/// Appends a text as JSON, with quotes. Requires: UTF-8.
void append_text(std::string& out, std::string_view text);

}  // namespace tinsmith::api::json
