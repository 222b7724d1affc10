// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tinsmith::api {

struct JsonSound {
    /// What is wrong with it first.
    enum class Fault {
        None,
        Syntax,
        TooDeep,
        TooManyMembers,  ///< of one object
        RepeatedName,    ///< in one object
        TooLong,         ///< a number, or a text that is not all plain ASCII
    };
    Fault fault = Fault::None;
    std::size_t wrong_byte = 0;  ///< counted from 1
    std::string name = {};       ///< that is repeated; cut where it is long
};

/// Looks through a document before any of it is built. Long texts in plain ASCII are allowed, and
/// cost no memory. Cost: linear; memory as `NameSet` says, for each depth.
JsonSound look_through_json(std::string_view text, std::size_t most_depth);

}  // namespace tinsmith::api
