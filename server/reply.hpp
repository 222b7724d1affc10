// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "api/problem.hpp"
#include "server/http_message.hpp"

namespace tinsmith::server {

inline constexpr const char* kJson = "application/json";
inline constexpr const char* kGeoJson = "application/geo+json";
inline constexpr const char* kDelta = "application/vnd.tinsmith.delta";
inline constexpr const char* kGlb = "model/gltf-binary";
inline constexpr const char* kGltf = "model/gltf+json";
inline constexpr const char* kObj = "model/obj";
inline constexpr const char* kXml = "application/xml";

/// What the strong tag of a representation has in the end when it is sent as gzip.
inline constexpr std::string_view kGzipSuffix = "-gzip";

/// 200 with a body, which may be empty. No answer is a 204: some clients wait for a body that its
/// Content-Length denies.
Response ok(std::string content_type, std::string body);
/// 201 with a body and where the new thing is.
Response created(std::string location, std::string content_type, std::string body);
/// 304: what the client has under that tag is still what would be sent.
Response not_modified(std::string etag);
/// The problem as application/problem+json, its status from the table of problems.
Response refuse(const Request& request, const api::Problem& problem);
Response refuse(const Request& request, api::ProblemType type, std::string detail);

}  // namespace tinsmith::server
