// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "api/formats/json_reader.hpp"
#include "core/types/point.hpp"

namespace tinsmith::api {

/// The member "coordinates" of a geometry, before it is known of what type the geometry is: "type"
/// may come after. Positions lie in one buffer; arrays are remembered by where they begin in it.
///
///     depth of positions   the arrays around them, from the outside      type
///     1                    (the position is all)                         Point
///     2                    arrays[0]                                     MultiPoint, LineString
///     3                    arrays[0], arrays[1]: rings, lines            Polygon, MultiLineString
///     4                    ..., arrays[1]: polygons, arrays[2]: rings    MultiPolygon
struct Coordinates {
    static constexpr std::size_t kMostDepth = 4;

    std::size_t depth = 0;                ///< of the positions; 0: there is no position
    std::vector<core::Point2> positions;  ///< x is NaN where the position had a fault
    /// One for each position, NaN where it has none. Empty: none has one, which costs nothing.
    std::vector<double> elevations;
    /// For each depth the arrays of arrays, or of positions, that begin there: the number of
    /// positions, and of arrays one deeper, that came before.
    struct Start {
        std::size_t position;
        std::size_t array;
    };
    std::array<std::vector<Start>, kMostDepth> arrays;
    bool sound = true;  ///< no fault in how the arrays are nested

    void clear() { *this = {}; }
};

/// Reads one "coordinates" after the other, and counts all their positions against the limit.
class CoordinatesReader : public json::Value, public json::Container {
  public:
    explicit CoordinatesReader(std::size_t most_positions)
        : most_(most_positions), left_(most_positions) {}

    /// Requires: `out` outlives the reading of the next value.
    void write_to(Coordinates& out);

    void scalar(json::Reader& reader, const json::Scalar& value) override;
    json::Container* object(json::Reader& reader) override;
    json::Container* array(json::Reader& reader) override;
    json::Value* element(json::Reader& reader) override;
    void close(json::Reader& reader) override;

  protected:
    std::string_view expected() const override;

  private:
    /// What an open array holds so far. Doubtful: neither can be said, the rest is passed over.
    enum class Holds { Nothing, Arrays, Numbers, Doubtful };

    bool charge(json::Reader& reader);
    void begin_position(json::Reader& reader);
    void take_number(json::Reader& reader, const json::Scalar& value);
    void end_position(json::Reader& reader);
    void note_array(std::size_t level);
    void nesting_fault(json::Reader& reader, std::string pointer);
    void doubt();

    Coordinates* out_ = nullptr;
    std::size_t most_;
    std::size_t left_;
    std::size_t level_ = 0;  ///< open arrays
    std::array<Holds, Coordinates::kMostDepth> holds_{};
    std::size_t numbers_ = 0;  ///< of the position being read
    core::Point2 position_;
    double elevation_ = 0.0;  ///< NaN: none
    bool position_sound_ = true;
};

}  // namespace tinsmith::api
