// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace tinsmith::api {

/// Whether an Accept-Encoding header allows gzip (RFC 9110 12.5.3): named, also as "x-gzip", or
/// met by "*", with a weight above 0 and not below that of "identity" where that is named. The name
/// counts before the star. An empty or missing header allows the body as it is only.
/// Elements that cannot be read are passed over.
bool accepts_gzip(std::string_view accept_encoding);

}  // namespace tinsmith::api
