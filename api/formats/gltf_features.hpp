// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "api/formats/gltf_regions.hpp"

namespace tinsmith::api {

/// One property of a property table (EXT_structural_metadata), as it lies in buffers.
struct PropertyColumn {
    std::string id;                      ///< letters, digits and underscores; no two are the same
    std::string name;                    ///< as the polygons' Features had it
    std::string description;             ///< may be empty
    std::string semantic;                ///< "ID" or "NAME"; may be empty
    bool is_text = false;                ///< STRING, else SCALAR FLOAT64
    std::string values;                  ///< UTF-8 one after the other, or doubles, little-endian
    std::vector<std::uint32_t> offsets;  ///< of texts: where each begins, and the end of the last
    std::optional<std::string> no_text;  ///< what a row has in place of a value that it lacks
    std::optional<double> no_number;
};

struct PropertyTable {
    std::size_t rows = 0;
    std::vector<PropertyColumn> columns;
};

/// The features' own properties of so many names become columns, those that come first; all of them
/// stand in `regions_extras`.
inline constexpr std::size_t kMostOwnColumns = 200;

/// A row for each feature: id, name, plan_area, surface_area, and a column for each name of the
/// Features' own properties whose value is a text, a number or true or false somewhere.
///
/// Laws: a column holds numbers where each value of that name is a number that a double holds
/// exactly, else texts, numbers and truths as JSON writes them. Arrays, objects and null count as
/// no value. What a row has in place of one, `no_text` or `no_number`, is no value of any row.
/// For `name` see `region_name`.
PropertyTable property_table(const RegionPartition& regions);

/// The Feature's own "name", if that is a scalar, else its id, else the polygon's.
std::string region_name(const RegionFeature& feature);

/// The same as JSON text: [{"id", "name", "plan_area", "surface_area", "properties"}].
std::string regions_extras(const RegionPartition& regions);

}  // namespace tinsmith::api
