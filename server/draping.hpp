// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "api/formats/geojson_writer.hpp"
#include "core/mesh/tin.hpp"
#include "core/regions/constraint_history.hpp"
#include "server/polygon.hpp"

namespace tinsmith::server {

/// The polygon as it lies in the mesh now: every vertex along it, and the figures of its region.
/// Requires: the history is of `tin` as it is, which the polygon was integrated into.
/// Cost: its chains and its region.
api::DrapedPolygon drape(const core::Tin& tin, const core::ConstraintHistory& history,
                         const Polygon& polygon);

}  // namespace tinsmith::server
