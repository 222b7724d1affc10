// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "core/integrate/options.hpp"
#include "core/integrate/shape.hpp"
#include "core/types/mesh_data.hpp"

namespace tinsmith::test {

/// One call of `core::integrate`.
struct Request {
    core::IntegrateOptions options;
    std::vector<core::Shape> shapes;
};

/// A mesh and the requests that it is to take, one after the other: what a test replays.
struct Case {
    std::vector<std::string> notes;  ///< what it shows, a line each
    core::MeshData mesh;
    std::vector<Request> requests;
};

/// Cases as text, a fact a line, `#` begins a note, numbers are the shortest that read back to the
/// same double:
///
///     # what it shows
///     vertex 0 0 1.5          in order; triangles and constraints count them from 0
///     triangle 0 1 2
///     constraint 0 1
///     request strict          none | strict | paper | bounded; further options follow by name
///     snap 0.25               also: max_deviation, outside reject, on_crossing old, lock
///     shape
///     path closed             closed | open
///     point 0.5 0.25          or with an elevation of its own, then all of the path have one
///
/// Writing what was read gives the same lines; notes go first.
void write_case(std::ostream& out, const Case& written);
std::string case_text(const Case& written);
/// Throws std::runtime_error that names the line.
Case read_case(std::istream& in);
Case read_case_file(const std::string& path);

}  // namespace tinsmith::test
