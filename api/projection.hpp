// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "core/types/point.hpp"

namespace tinsmith::api {

/// What PROJ's database says of a coordinate reference system; of a compound one, of its plan part.
struct CrsFacts {
    enum class Kind { Projected, Geographic, Other };
    Kind kind = Kind::Other;
    std::string code;         ///< as asked for
    std::string name;         ///< "WGS 84 / UTM zone 16N"
    std::string unit_name;    ///< "metre", "degree", in the database's words
    double metres = 0.0;      ///< one unit of a projected system; 0: of no other
    bool has_height = false;  ///< it says what elevations mean too
    std::string area_of_use;  ///< in words, may be empty
};

/// Looks a normalised name up ("EPSG:32616"); nullopt: there is no system of that name. Nothing is
/// read but PROJ's own database, and that at the first call, not before; no network.
/// May be called from several threads at once.
std::optional<CrsFacts> find_crs(std::string_view code);

/// PROJ writes no more to stderr when others use it with contexts of their own. To be called before
/// they do.
void silence_proj();

/// "EPSG:32616 (WGS 84 / UTM zone 16N)"
std::string crs_with_name(const CrsFacts& facts);

/// Why a position, or every one, has no place in the other system.
struct NoPlace {
    std::string code;
    std::string detail;
};

/// What is told of a system that cannot be taken: it is in no list, or has no plan.
NoPlace unknown_crs(std::string_view code);
NoPlace unfit_crs(const CrsFacts& facts);

/// Plan positions of one system in the other, by the transformation that PROJ takes for the best at
/// each of them, without grids that are not installed. Positions are always easting, northing or
/// longitude, latitude, whatever order the system names. Elevations are not part of it.
///
/// No guess stands in for a transformation: where PROJ knows only one that would leave the datum
/// out, there is none. A position more than five degrees outside of the target's area of use, where
/// its formulas need not hold, has no place.
///
/// Of one thread at a time. Cost: some milliseconds to make, about two microseconds a position.
class Transformation {
  public:
    /// Requires: both are normalised names.
    static std::variant<Transformation, NoPlace> between(std::string_view from,
                                                         std::string_view to);
    Transformation(Transformation&&) noexcept;
    Transformation& operator=(Transformation&&) noexcept;
    ~Transformation();

    const CrsFacts& from() const;
    const CrsFacts& to() const;

    std::variant<core::Point2, NoPlace> operator()(core::Point2 position) const;

  private:
    struct State;
    explicit Transformation(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

/// The UTM zone of WGS 84 around a place given in `geographic`: "EPSG:32616". Zones are six degrees
/// wide everywhere, without the exceptions for Norway and Svalbard. There is none beyond 84 degrees
/// north and 80 south.
std::variant<std::string, NoPlace> utm_zone_at(std::string_view geographic, core::Point2 place);

}  // namespace tinsmith::api
