// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "api/fault.hpp"
#include "api/formats/read_limits.hpp"
#include "api/projection.hpp"
#include "api/terrain.hpp"

namespace tinsmith::api {

/// What a terrain's bytes say of its coordinates, as far as they do.
struct SystemSaid {
    bool named = false;        ///< they name a system, though it may have no code
    bool geographic = false;   ///< in degrees or the like
    std::string crs;           ///< its code; empty: it has none
    std::string source;        ///< the code, or where there is none the system in full, as WKT
    double plan_metres = 1.0;  ///< one unit of x and y; not of degrees
    std::optional<double> elevation_metres;  ///< one unit of z; nothing: they do not say
};

/// Where a terrain's coordinates are to lie in the end.
struct SystemSettled {
    std::string crs;        ///< of the session; empty: unknown
    std::string unit;       ///< of all three coordinates
    std::string warp_from;  ///< the system that x and y are brought over from; empty: they stay
    double elevation_factor = 1.0;  ///< makes a z that was read one of `unit`
};

/// Makes one of what the bytes and the options say:
///
/// - A system that neither names is unknown; then the unit is the one that is named, else metres.
/// - A projected system brings its unit, and a unit that is named must be that one. It stays as it
///   is: `project` may only be "auto" or the system itself.
/// - A geographic system is refused without `project`, and otherwise left for the system that
///   `project` names, which must be a projected one. The named unit is that of the elevations,
///   metres where none is named.
/// - Elevations of another unit are made ones of the terrain's unit.
/// - A system must be in PROJ's database, and what bytes and options both say must be the same.
///
/// `zone` tells what "auto" means for this terrain. Faults that concern an option have its name as
/// `parameter`, the others neither that nor a pointer.
Parsed<SystemSettled> reconcile_system(
    SystemSaid said, const TerrainOptions& options,
    const std::function<std::variant<std::string, NoPlace>()>& zone);

/// For formats whose lengths are metres whatever the system: makes them ones of the unit that the
/// options name, else of the system's, and where there is none of what they were before. Does
/// nothing where none is known.
void bring_from_metres(Terrain& terrain, const TerrainOptions& options);

/// Settles the system of a terrain that is vertices and no raster, and brings each vertex over
/// where that is needed. Does nothing to a terrain that is settled.
/// Faults of the bytes' own members have the pointers /crs and /unit, those of a position its
/// index.
Parsed<Terrain> in_its_system(Terrain terrain, const TerrainOptions& options,
                              const ReadLimits& limits);

}  // namespace tinsmith::api
