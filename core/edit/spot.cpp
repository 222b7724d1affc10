// SPDX-License-Identifier: Apache-2.0
#include "core/edit/spot.hpp"

#include "core/mesh/surface.hpp"

namespace tinsmith::core {

Spot spot_of(const Tin& tin, const Location& location, Point2 p) {
    switch (location.kind) {
        case Location::Kind::OnVertex: {
            const Tin::Vertex& v = tin.vertex(location.vertex);
            return {v.z, v.triangle};
        }
        case Location::Kind::OnEdge:
            return {elevation_on(tin, location.side, p), location.side.triangle()};
        case Location::Kind::InTriangle:
            return {elevation_in(tin, location.side.triangle(), p), location.side.triangle()};
        case Location::Kind::Outside:
            break;
    }
    return {};
}

std::optional<Spot> spot_at(const Tin& tin, Point2 p) {
    const Location location = locate(tin, p, tin.hint(p));
    if (location.kind == Location::Kind::Outside) return std::nullopt;
    return spot_of(tin, location, p);
}

}  // namespace tinsmith::core
