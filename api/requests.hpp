// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "api/fault.hpp"
#include "api/formats/gltf.hpp"
#include "api/mesh_part.hpp"
#include "core/integrate/integrator.hpp"
#include "core/regions/region.hpp"

namespace tinsmith::api {

/// A wish by name, and where it stands: a JSON Pointer into the body, or empty for the query.
struct NamedOption {
    std::string name;
    std::string value;
    std::string pointer;
};

/// The word on the wire: "evenodd".
std::string_view winding_name(core::Winding winding);

/// What a polygons request asks for beside its geometry.
struct PolygonOptions {
    core::IntegrateOptions integrate;  ///< what may be asked for of it; budgets are not
    bool own_elevations = false;       ///< the positions bring z; otherwise they are draped
    core::Winding winding = core::Winding::EvenOdd;
    bool dry_run = false;
    bool angles = false;  ///< the report counts smallest angles
    std::string crs;      ///< of the polygons, normalised; empty: the session's
};

/// The options of a polygons request by name.
std::span<const std::string_view> polygon_option_names();

/// Whether options are all that there will be, or others may follow from another place.
enum class OptionList { Whole, Part };

/// Reads the options of a polygons request. An option that is given twice, in the query and in the
/// body, must say the same both times; one that has no meaning without another needs that too,
/// which a part of the list is not asked for.
Parsed<PolygonOptions> parse_polygon_options(std::span<const NamedOption> options,
                                             OptionList list = OptionList::Whole);

/// What an option of a polygons or mesh request takes, for people: "drape or own".
std::string_view option_values(std::string_view name);

/// The query parameters of a mesh request, granted or not.
std::span<const std::string_view> mesh_option_names();

/// Those of them that say how it is written, not what of it: an edit's answer takes them too.
std::span<const std::string_view> gltf_option_names();

/// How a mesh is to be written, and what of it.
struct MeshOptions {
    GltfOptions gltf;
    bool regions = false;  ///< a primitive for each set of polygons that contain triangles
    std::optional<PlanBox> bbox;
};

/// Reads how a mesh is to be written. The unit is not the request's to say and stays the default.
Parsed<MeshOptions> parse_mesh_options(std::span<const NamedOption> options);

}  // namespace tinsmith::api
