// SPDX-License-Identifier: Apache-2.0
#include "api/formats/json_size.hpp"

#include <string>

#include <nlohmann/json.hpp>

namespace tinsmith::api {

namespace {

class JsonSize : public nlohmann::json::json_sax_t {
  public:
    using Json = nlohmann::json;
    explicit JsonSize(JsonLimits limits) : limits_(limits) {}

    bool is_too_much() const { return is_too_much_; }
    std::size_t wrong_byte() const { return wrong_byte_; }

    bool null() override { return count(); }
    bool boolean(bool) override { return count(); }
    bool number_integer(Json::number_integer_t) override { return count(); }
    bool number_unsigned(Json::number_unsigned_t) override { return count(); }
    bool number_float(Json::number_float_t, const std::string&) override { return count(); }
    bool string(std::string&) override { return count(); }
    bool binary(Json::binary_t&) override { return count(); }
    bool key(std::string&) override { return count(); }
    bool start_object(std::size_t) override { return open(); }
    bool end_object() override { return close(); }
    bool start_array(std::size_t) override { return open(); }
    bool end_array() override { return close(); }
    bool parse_error(std::size_t byte, const std::string&, const Json::exception&) override {
        wrong_byte_ = byte;
        return false;
    }

  private:
    bool count() {
        is_too_much_ = ++values_ > limits_.values || depth_ > limits_.depth;
        return !is_too_much_;
    }
    bool open() {
        ++depth_;
        return count();
    }
    bool close() {
        --depth_;
        return true;
    }

    JsonLimits limits_;
    std::size_t values_ = 0;
    int depth_ = 0;
    std::size_t wrong_byte_ = 0;
    bool is_too_much_ = false;
};

}  // namespace

JsonSound look_through_json(std::string_view text, JsonLimits limits) {
    JsonSize size(limits);
    if (nlohmann::json::sax_parse(text.begin(), text.end(), &size)) return {};
    return {false, size.is_too_much(), size.wrong_byte()};
}

}  // namespace tinsmith::api
