// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace tinsmith::api {

/// The description of the whole interface, OpenAPI 3.1 in JSON. Made once, of the files in
/// api/openapi, each of which is a part of it in the same form, but for what the program knows
/// better and every operation would have to repeat:
///
/// - "x-problems" of an operation, of its body and of each of its parameters name problems by their
///   words. They become the answers of their statuses, from the table of problems, together with
///   those that any request may meet (problems.json).
/// - What wants an API key has a security scheme and the problems of those without.
/// - "x-answers" of a parameter are answers of its operation, "x-answer-headers" are headers of
/// every
///   answer of it.
/// - "x-query" of an operation names a schema: each of its properties is a query parameter.
/// - "x-recorded" has answers that the program gave, by operation, status and name: they are the
///   examples of answers (tests/openapi/record.mjs writes them).
/// - Headers that every request and every answer may have stand at none of them.
///
/// Cost: some milliseconds the first time.
const std::string& openapi_document();

inline constexpr std::string_view kOpenApiMediaType = "application/json";

}  // namespace tinsmith::api
