// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/fault.hpp"

namespace tinsmith::api {

/// One part of a form.
struct FormPart {
    std::string name;
    std::string media_type;  ///< lower-case, without parameters; empty: none given
    std::string_view body;   ///< a view of the form's body
};

/// Takes multipart/form-data (RFC 7578) apart. `content_type` is the whole header, with its
/// boundary. At most 16 parts; file names and transfer encodings are passed over.
/// Cost: linear; nothing is copied.
Parsed<std::vector<FormPart>> read_form(std::string_view body, std::string_view content_type);

}  // namespace tinsmith::api
