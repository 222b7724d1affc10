// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace tinsmith::api::json {

/// A value in a JSON text that is known to be sound, and its parts as views into it: nothing is
/// built. Requires: `look_through_json` has found the text sound.
/// Names are compared as they are written: one with escapes is none that is asked for.
class JsonText {
  public:
    explicit JsonText(std::string_view text);

    bool is_object() const { return text_.starts_with('{'); }
    bool is_array() const { return text_.starts_with('['); }
    bool is_text() const { return text_.starts_with('"'); }
    /// Without the spaces around it.
    std::string_view text() const { return text_; }

    /// Nothing: it is no object, or has none of that name. Cost: linear in the object.
    std::optional<JsonText> member(std::string_view name) const;

    /// The elements of an array, one after the other.
    class Elements {
      public:
        /// Requires: an array.
        explicit Elements(const JsonText& array) : rest_(array.text_.substr(1)) {}
        /// Nothing: there are no more.
        std::optional<JsonText> next();

      private:
        std::string_view rest_;
    };
    /// Requires: an array. Cost: linear in it.
    std::size_t element_count() const;

  private:
    std::string_view text_;
};

}  // namespace tinsmith::api::json
