// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "core/integrate/options.hpp"
#include "core/integrate/shape.hpp"
#include "tests/verify/exact.hpp"
#include "tests/verify/mesh_view.hpp"

namespace tinsmith::verify {

/// What is wrong, in words; the first word names the guarantee.
using Faults = std::vector<std::string>;

/// A mesh with what it takes to ask about it. Stays where it is made.
struct Snapshot {
    explicit Snapshot(core::MeshData mesh) : data(std::move(mesh)), stars(data), grid(data) {}
    Snapshot(const Snapshot&) = delete;
    Snapshot& operator=(const Snapshot&) = delete;

    core::MeshData data;
    Stars stars;
    TriangleGrid grid;
};

/// One integration: what was asked, the mesh before and after, the bound that the report promised.
struct Edit {
    const Snapshot& before;
    const Snapshot& after;
    std::span<const core::Shape> shapes;
    const core::IntegrateOptions& options;
    double certified = 0.0;
};

/// A segment of the request, of nonzero length.
struct Segment {
    Point2 a;
    Point2 b;
    const core::Path* path;
    std::size_t index;  ///< of a in its path; b is the next point, the first one after the last
};

inline std::vector<Segment> segments_of(std::span<const core::Shape> shapes) {
    std::vector<Segment> found;
    for (const auto& shape : shapes) {
        for (const auto& path : shape.paths) {
            const std::size_t n = path.points.size();
            for (std::size_t i = 1; i < n + (path.closed ? 1 : 0); ++i)
                if (path.points[i - 1] != path.points[i % n])
                    found.push_back({path.points[i - 1], path.points[i % n], &path, i - 1});
        }
    }
    return found;
}

/// How far a vertex of a chain may be from its input segment.
inline double chain_reach(const Edit& edit) {
    const double rounding = edit.before.grid.rounding_reach();
    return edit.options.snap > rounding ? edit.options.snap : rounding;
}

template <typename... Parts>
std::string words(const Parts&... parts) {
    std::ostringstream out;
    out.precision(17);
    (out << ... << parts);
    return out.str();
}

}  // namespace tinsmith::verify
