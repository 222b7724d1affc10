// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/fault.hpp"
#include "api/formats/json_reader.hpp"
#include "api/formats/json_reader_values.hpp"
#include "api/formats/read_limits.hpp"

namespace tinsmith::api {

namespace json {

/// An object of options: names and scalars, as text.
class OptionsReader : public Value, public Container {
  public:
    static constexpr std::size_t kMostOptions = 64;
    static constexpr std::size_t kLongestText = 1000;  ///< of one option
    using Pairs = std::vector<std::pair<std::string, std::string>>;
    explicit OptionsReader(Pairs& out) : option_(out) {}

    Container* object(Reader&) override { return this; }
    Value* member(Reader& reader, std::string_view name) override {
        const bool repeated = std::any_of(option_.out.begin(), option_.out.end(),
                                          [&](const auto& pair) { return pair.first == name; });
        if (repeated) {
            reader.fault("MEMBER_REPEATED", quoted(name) + " is here twice; give it once.");
            return nullptr;
        }
        if (option_.out.size() == kMostOptions) {
            reader.stop(FaultKind::Invalid,
                        {"TOO_MANY_MEMBERS",
                         "No more than " + std::to_string(kMostOptions) + " options are taken.",
                         reader.pointer()});
            return nullptr;
        }
        option_.out.emplace_back(name, "");
        return &option_;
    }

  protected:
    std::string_view expected() const override { return "an object of options"; }

  private:
    struct Option : Value {
        explicit Option(Pairs& pairs) : out(pairs) {}
        void scalar(Reader& reader, const Scalar& value) override {
            if (value.kind == Scalar::Kind::Null) return Value::scalar(reader, value);
            if (value.text.size() > kLongestText) {
                return reader.fault("TEXT_TOO_LONG",
                                    "At most " + std::to_string(kLongestText) + " bytes.");
            }
            out.back().second = json::plain_text(value);
        }
        std::string_view expected() const override { return "a text, a number, true or false"; }
        Pairs& out;
    };

    Option option_;
};

}  // namespace json

/// Reads an object of options that is a body of its own; an empty one has none. Names are not
/// checked here.
Parsed<json::OptionsReader::Pairs> read_options(std::string_view body, const ReadLimits& limits);

}  // namespace tinsmith::api
