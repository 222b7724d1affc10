// SPDX-License-Identifier: Apache-2.0
#include "api/formats/json_size.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "api/formats/json_tokens.hpp"

namespace tinsmith::api {

namespace {

using Fault = JsonSound::Fault;

/// Goes through the text, over what is between the quotes of long plain texts, and leaves behind
/// where it is.
class Skipper {
  public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    /// Where the parser is, and the next text that is passed over.
    struct Place {
        const char* start = nullptr;
        const char* at = nullptr;
        std::vector<json::PlainText>::const_iterator next = {};
        std::vector<json::PlainText>::const_iterator end = {};
    };

    Skipper(const char* at, Place* place) : at_(at), place_(place) {}
    reference operator*() const { return *at_; }
    Skipper& operator++() {
        ++at_;
        if (place_->next != place_->end && at_ == place_->start + place_->next->begin) {
            at_ = place_->start + place_->next->end;
            ++place_->next;
        }
        place_->at = at_;
        return *this;
    }
    Skipper operator++(int) {
        const Skipper before = *this;
        ++*this;
        return before;
    }
    friend bool operator==(const Skipper& a, const Skipper& b) { return a.at_ == b.at_; }

  private:
    const char* at_;
    Place* place_;
};

class Looker : public nlohmann::json::json_sax_t {
  public:
    using Json = nlohmann::json;
    Looker(std::size_t most_depth, const Skipper::Place& place)
        : most_depth_(most_depth), place_(place) {}

    JsonSound found() && { return std::move(found_); }

    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(Json::number_integer_t) override { return true; }
    bool number_unsigned(Json::number_unsigned_t) override { return true; }
    bool number_float(Json::number_float_t, const std::string&) override { return true; }
    bool string(std::string&) override { return true; }
    bool binary(Json::binary_t&) override { return true; }
    bool key(std::string& name) override {
        json::NameSet& names = names_[depth_ - 1];
        constexpr std::size_t kLongestShown = 60;
        if (!names.add(name)) return stop(Fault::RepeatedName, name.substr(0, kLongestShown));
        return names.size() <= json::kMostMembers || stop(Fault::TooManyMembers);
    }
    bool start_object(std::size_t) override {
        if (!open()) return false;
        names_.resize(std::max(names_.size(), depth_));
        names_[depth_ - 1].clear();
        return true;
    }
    bool end_object() override { return close(); }
    bool start_array(std::size_t) override { return open(); }
    bool end_array() override { return close(); }
    bool parse_error(std::size_t, const std::string&, const Json::exception&) override {
        return stop(Fault::Syntax);
    }

  private:
    bool stop(Fault fault, std::string name = {}) {
        found_ = {fault, static_cast<std::size_t>(place_.at - place_.start), std::move(name)};
        return false;
    }
    bool open() { return ++depth_ <= most_depth_ || stop(Fault::TooDeep); }
    bool close() {
        --depth_;
        return true;
    }

    std::size_t most_depth_;
    const Skipper::Place& place_;
    std::size_t depth_ = 0;
    std::vector<json::NameSet> names_;  ///< of the objects that are open, by their depth
    JsonSound found_;
};

}  // namespace

JsonSound look_through_json(std::string_view text, std::size_t most_depth) {
    const json::LongTokens long_ones = json::long_tokens(text);
    if (long_ones.other) return {Fault::TooLong, long_ones.other->begin + 1};
    Skipper::Place place{text.data(), text.data(), long_ones.plain_texts.begin(),
                         long_ones.plain_texts.end()};
    Looker looker(most_depth, place);
    nlohmann::json::sax_parse(Skipper(text.data(), &place),
                              Skipper(text.data() + text.size(), &place), &looker);
    return std::move(looker).found();
}

}  // namespace tinsmith::api
