// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tinsmith::api {

/// One spelling for the name of a coordinate reference system: "EPSG:32616" from "epsg:32616",
/// "urn:ogc:def:crs:EPSG::32616" and "http://www.opengis.net/def/crs/EPSG/0/32616" alike.
/// nullopt: not such a name. Whether the code exists is not looked up.
std::optional<std::string> normalise_crs(std::string_view name);

/// Whether two normalised names are one system as coordinates are taken here, always longitude
/// first: "OGC:CRS84" and "EPSG:4326" differ in that order alone.
bool same_crs(std::string_view a, std::string_view b);

/// The unit's one spelling, "metre", "foot" or "US survey foot", from that and its common others
/// ("m", "meter", "ft", "ftUS"). nullopt: unknown.
std::optional<std::string> normalise_unit(std::string_view name);

/// Length of a normalised unit in metres. Requires: `unit` came from normalise_unit.
double metres_per(std::string_view unit);

/// The normalised unit of that length, known by it and not by one of its many names; the two feet
/// differ by 2e-6. nullopt: none of them.
std::optional<std::string> unit_of_length(double metres);

}  // namespace tinsmith::api
