// SPDX-License-Identifier: Apache-2.0
#include "api/formats/options_reader.hpp"

namespace tinsmith::api {

Parsed<json::OptionsReader::Pairs> read_options(std::string_view body, const ReadLimits& limits) {
    json::OptionsReader::Pairs options;
    if (body.empty()) return options;
    json::OptionsReader root(options);
    json::Reader reader(root, limits);
    json::read(body, reader);
    if (!reader.log().empty()) {
        return std::move(reader.log()).refusal<json::OptionsReader::Pairs>();
    }
    return options;
}

}  // namespace tinsmith::api
