// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "api/fault.hpp"
#include "api/formats/fault_log.hpp"
#include "api/formats/json_text.hpp"

namespace tinsmith::api {

/// Nodes, meshes, primitives, accessors and views of a file, all together; likewise the children of
/// nodes. A terrain in 10,000 tiles has 70,000; without a bound a file of "{},{}," takes a hundred
/// times its size.
inline constexpr std::size_t kMostGltfParts = 100'000;

/// What the members of a glTF's JSON hold. One that is there and of another kind is a fault, with
/// its pointer. Nothing of the document is built.
class GltfDocument {
  protected:
    using JsonText = json::JsonText;

    explicit GltfDocument(FaultLog& log) : log_(log) {}

    void fault(FaultKind kind, std::string code, std::string detail, std::string pointer = {});
    void invalid(std::string detail, std::string pointer);

    /// False, with a fault: it cannot be read.
    bool is_sound(std::string_view text);

    /// False, with a fault: the file has more of `what` than anybody reads.
    bool count(std::size_t& all, std::size_t more, std::string_view what,
               const std::string& pointer);

    /// Nothing: it is no number.
    static std::optional<double> number_of(const JsonText& value);
    static std::string text_of(const JsonText& value);
    /// Of any length; empty where it is written as it is.
    static std::string whole_text_of_escaped(const JsonText& value);
    static std::string text(const JsonText& object, const char* name);
    static bool flag(const JsonText& object, const char* name);
    static std::optional<JsonText> extension(const JsonText& object, const char* name);

    std::optional<std::size_t> whole(const JsonText& text, const std::string& pointer);
    std::optional<std::size_t> index(const JsonText& object, const char* name,
                                     const std::string& pointer);
    std::size_t number(const JsonText& object, const char* name, const std::string& pointer,
                       std::size_t otherwise);
    std::size_t needed(const JsonText& object, const char* name, const std::string& pointer);

    /// False: it is not there, or is no list of so many numbers.
    template <std::size_t N>
    bool read_numbers(const JsonText& object, const char* name, const std::string& pointer,
                      std::array<double, N>& out) {
        const auto list = object.member(name);
        if (!list) return false;
        std::size_t i = 0;
        bool fits = list->is_array();
        if (fits) {
            for (JsonText::Elements all(*list); const auto element = all.next(); ++i) {
                const auto value = i < N ? number_of(*element) : std::nullopt;
                fits = value.has_value();
                if (!fits) break;
                out[i] = *value;
            }
        }
        if (fits && i == N) return true;
        invalid("A list of " + std::to_string(N) + " numbers belongs here.", pointer + "/" + name);
        return false;
    }

    /// Calls `what` with each element of the list and its pointer; elements are objects. Before it
    /// `begin` is told how many they are. Lists that are all of the file's parts together count.
    template <typename Begin, typename What>
    void each(const JsonText& object, const char* name, const std::string& pointer, Begin begin,
              What what) {
        const auto list = object.member(name);
        if (!list) return;
        const std::string here = pointer + "/" + name;
        if (!list->is_array()) return invalid("A list belongs here.", here);
        const std::size_t elements = list->element_count();
        if (!count(parts_, elements, "nodes, meshes, primitives, accessors and views", here))
            return;
        begin(elements);
        std::size_t i = 0;
        for (JsonText::Elements all(*list); const auto element = all.next(); ++i) {
            if (log_.full()) return;
            const std::string place = here + "/" + std::to_string(i);
            if (element->is_object()) {
                what(*element, place);
            } else {
                invalid("An object belongs here.", place);
                what(JsonText("{}"), place);
            }
        }
    }

    FaultLog& log_;

  private:
    std::size_t parts_ = 0;  ///< that the lists so far have
};

}  // namespace tinsmith::api
