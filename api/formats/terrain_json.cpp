// SPDX-License-Identifier: Apache-2.0
#include "api/formats/terrain_json.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "api/crs.hpp"
#include "api/formats/grid_mesh.hpp"
#include "api/formats/json_reader.hpp"
#include "api/formats/json_reader_values.hpp"

namespace tinsmith::api {

namespace {

using json::Container;
using json::Object;
using json::Reader;
using json::Scalar;
using json::Tuple;
using json::Value;

Fault too_many(std::string code, std::string_view what, std::size_t most, std::string pointer) {
    return {std::move(code),
            "More than " + std::to_string(most) + " " + std::string(what) + "; no more are taken.",
            std::move(pointer)};
}

/// An array of positions that go straight into their buffer, up to a limit.
class VertexList : public Value, public Container {
  public:
    /// `item` and `list` are for people: "a vertex [x, y, z]", "an array of vertices".
    VertexList(std::vector<core::Point3>& out, std::size_t most, std::string_view item,
               std::string_view list)
        : vertex_(out, item), most_(most), list_(list) {}

    bool has_begun() const { return has_begun_; }

    Container* array(Reader&) override {
        has_begun_ = true;
        return this;
    }
    Value* element(Reader& reader) override {
        if (vertex_.out.size() < most_) return &vertex_;
        reader.stop(FaultKind::TooLarge,
                    too_many("TOO_MANY_VERTICES", "vertices", most_, reader.pointer()));
        return nullptr;
    }

  protected:
    std::string_view expected() const override { return list_; }

  private:
    struct Vertex : Tuple {
        Vertex(std::vector<core::Point3>& vertices, std::string_view item)
            : Tuple(3, Items::Coordinate, item), out(vertices) {}
        void complete(Reader&) override {
            out.push_back({numbers()[0], numbers()[1], numbers()[2]});
        }
        std::vector<core::Point3>& out;
    };

    Vertex vertex_;
    std::size_t most_;
    bool has_begun_ = false;
    std::string_view list_;
};

class TriangleList : public Value, public Container {
  public:
    using Triangles = std::vector<std::array<std::uint32_t, 3>>;
    TriangleList(Triangles& out, std::size_t most) : triangle_(out), most_(most) {}

    Container* array(Reader&) override { return this; }
    Value* element(Reader& reader) override {
        if (triangle_.out.size() < most_) return &triangle_;
        reader.stop(FaultKind::TooLarge,
                    too_many("TOO_MANY_TRIANGLES", "triangles", most_, reader.pointer()));
        return nullptr;
    }

  protected:
    std::string_view expected() const override { return "an array of triangles"; }

  private:
    struct Triangle : Tuple {
        explicit Triangle(Triangles& triangles)
            : Tuple(3, Items::Index, "a triangle [a, b, c] of vertex indices"), out(triangles) {}
        void complete(Reader&) override {
            const auto index = [&](std::size_t i) {
                return static_cast<std::uint32_t>(numbers()[i]);
            };
            out.push_back({index(0), index(1), index(2)});
        }
        Triangles& out;
    };

    Triangle triangle_;
    std::size_t most_;
};

/// An array of numbers and nulls; null is no data, NaN in the result.
class Elevations : public Value, public Container {
  public:
    Elevations(std::vector<double>& out, std::size_t most) : out_(out), most_(most) {}

    Container* array(Reader&) override { return this; }
    Value* element(Reader& reader) override {
        if (out_.size() < most_) return &elevation_;
        reader.stop(FaultKind::TooLarge,
                    too_many("TOO_MANY_VERTICES", "elevations", most_, reader.pointer()));
        return nullptr;
    }

  protected:
    std::string_view expected() const override { return "an array of elevations"; }

  private:
    class Elevation : public Value {
      public:
        explicit Elevation(std::vector<double>& out) : out_(out) {}
        void scalar(Reader& reader, const Scalar& value) override {
            double elevation = std::numeric_limits<double>::quiet_NaN();
            if (value.is_number()) {
                elevation = value.number;
                if (!json::acceptable_coordinate(elevation)) {
                    reader.fault("COORDINATE_OUT_OF_RANGE", json::coordinate_out_of_range());
                }
            } else if (value.kind != Scalar::Kind::Null) {
                Value::scalar(reader, value);
            }
            out_.push_back(elevation);
        }

      protected:
        std::string_view expected() const override { return "an elevation or null"; }

      private:
        std::vector<double>& out_;
    };

    std::vector<double>& out_;
    std::size_t most_;
    Elevation elevation_{out_};
};

class MeshObject : public Object {
  public:
    MeshObject(core::MeshData& mesh, const ReadLimits& limits)
        : vertices_(mesh.vertices, limits.max_vertices, "a vertex [x, y, z]",
                    "an array of vertices"),
          triangles_(mesh.triangles, limits.max_triangles) {
        expect({{"vertices", &vertices_, true}, {"triangles", &triangles_, true}});
    }

  private:
    VertexList vertices_;
    TriangleList triangles_;
};

class GridObject : public Object {
  public:
    GridObject(Grid& grid, const ReadLimits& limits)
        : grid_(grid),
          limits_(limits),
          columns_value_(columns_, 2, UINT32_MAX),
          rows_value_(rows_, 2, UINT32_MAX),
          elevations_(grid.elevations, limits.max_vertices) {
        expect({{"origin", &origin_, true},
                {"cell", &cell_, true},
                {"columns", &columns_value_, true},
                {"rows", &rows_value_, true},
                {"elevations", &elevations_, true}});
    }

  protected:
    void begun(Reader& reader) override { faults_before_ = reader.log().size(); }
    void ended(Reader& reader) override {
        // Numbers at fault would only make more faults.
        if (reader.log().size() > faults_before_) return;
        const std::uint64_t posts = columns_ * rows_;  // each below 2^32
        if (posts > limits_.max_vertices) {
            reader.stop(FaultKind::TooLarge, too_many("TOO_MANY_VERTICES", "posts",
                                                      limits_.max_vertices, reader.pointer()));
        } else if (posts != grid_.elevations.size()) {
            reader.add(FaultKind::Invalid,
                       {"WRONG_LENGTH",
                        std::to_string(columns_) + " columns and " + std::to_string(rows_) +
                            " rows make " + std::to_string(posts) + " elevations; here are " +
                            std::to_string(grid_.elevations.size()) + ".",
                        json::pointer_to(reader.pointer(), "elevations")});
        }
        grid_.origin = {origin_.numbers()[0], origin_.numbers()[1]};
        grid_.dx = cell_.numbers()[0];
        grid_.dy = cell_.numbers()[1];
        grid_.columns = columns_;
        grid_.rows = rows_;
    }

  private:
    Grid& grid_;
    ReadLimits limits_;
    std::size_t faults_before_ = 0;
    std::uint64_t columns_ = 0;
    std::uint64_t rows_ = 0;
    Tuple origin_{2, Tuple::Items::Coordinate, "an origin [x, y]"};
    Tuple cell_{2, Tuple::Items::Coordinate, "a cell size [dx, dy]"};
    json::Whole columns_value_;
    json::Whole rows_value_;
    Elevations elevations_;
};

/// A text that must be one that `normalise` knows.
class KnownText : public json::Text {
  public:
    using Normalise = std::optional<std::string> (*)(std::string_view);
    KnownText(std::string& out, Normalise normalise, std::string code, std::string known)
        : Text(out),
          out_(out),
          normalise_(normalise),
          code_(std::move(code)),
          known_(std::move(known)) {}

    void scalar(Reader& reader, const Scalar& value) override {
        if (value.kind != Scalar::Kind::Text) return Value::scalar(reader, value);
        if (auto text = normalise_(value.text)) {
            out_ = *std::move(text);
        } else {
            reader.fault(code_, json::quoted(value.text) + " is not known. " + known_);
        }
    }

  private:
    std::string& out_;
    Normalise normalise_;
    std::string code_;
    std::string known_;
};

class Body : public Object {
  public:
    explicit Body(const ReadLimits& limits)
        : limits_(limits),
          mesh_(terrain_.mesh, limits),
          vertices_(terrain_.mesh.vertices, limits.max_vertices, "a vertex [x, y, z]",
                    "an array of vertices"),
          triangles_(terrain_.mesh.triangles, limits.max_triangles),
          points_list_(terrain_.mesh.vertices, limits.max_vertices, "a point [x, y, z]",
                       "an array of points"),
          grid_object_(grid_, limits) {
        expect({{"name", &name_},
                {"crs", &crs_},
                {"unit", &unit_},
                {"mesh", &mesh_},
                {"points", &points_list_},
                {"grid", &grid_object_},
                {"vertices", &vertices_},
                {"triangles", &triangles_}});
    }

    /// Points leave half of the work to be done when the body has been read.
    double share_of_reading() const { return points_list_.has_begun() ? 0.5 : 1.0; }

    Parsed<Terrain> result(FaultLog&& log) && {
        if (log.empty() && has("points")) {
            terrain_.points = PointsPlace{
                "/points", [](Fault& fault, std::size_t point, std::optional<std::size_t>) {
                    fault.pointer = json::pointer_to("/points", point);
                }};
        }
        if (log.empty() && has("grid")) {
            auto mesh = mesh_of_grid(grid_, limits_, "/grid");
            if (!mesh) return {mesh.kind(), std::move(mesh.faults())};
            terrain_.mesh = std::move(*mesh);
            terrain_.triangles_are_made = true;
        }
        if (!log.empty()) return std::move(log).refusal<Terrain>();
        terrain_.unit_is_said = has("unit");
        return std::move(terrain_);
    }

  protected:
    void ended(Reader& reader) override {
        const bool is_bare = has("vertices") || has("triangles");
        const int terrains = has("mesh") + has("points") + has("grid") + is_bare;
        if (terrains == 0) {
            reader.fault("MEMBER_MISSING",
                         "A terrain is needed here: one of \"mesh\", \"points\" and \"grid\", or a "
                         "mesh itself, \"vertices\" and \"triangles\".");
        } else if (terrains > 1) {
            reader.fault("TERRAIN_REPEATED",
                         "Give one terrain only: one of \"mesh\", \"points\" and \"grid\", or a "
                         "mesh itself, \"vertices\" and \"triangles\".");
        } else if (is_bare && !(has("vertices") && has("triangles"))) {
            reader.fault("MEMBER_MISSING", "A mesh has both, \"vertices\" and \"triangles\".");
        }
        if (is_bare) terrain_.mesh_pointer.clear();
        terrain_.unit_is_said = has("unit");
    }

  private:
    ReadLimits limits_;
    Terrain terrain_;
    Grid grid_;
    json::Text name_{terrain_.name};
    KnownText crs_{terrain_.crs, &normalise_crs, "CRS_UNKNOWN", "Write it like \"EPSG:32616\"."};
    KnownText unit_{terrain_.unit, &normalise_unit, "UNIT_UNKNOWN",
                    "Known are: metre, foot, US survey foot."};
    MeshObject mesh_;
    VertexList vertices_;  ///< of a mesh as the whole body
    TriangleList triangles_;
    VertexList points_list_;
    GridObject grid_object_;
};

}  // namespace

Parsed<Terrain> read_terrain_json(std::string_view body, const ReadLimits& limits) {
    Body root(limits);
    ReadLimits of_reading = limits;
    if (limits.progress) {
        of_reading.progress = [&](double share) {
            return limits.progress(share * root.share_of_reading());
        };
    }
    Reader reader(root, of_reading);
    json::read(body, reader);
    return std::move(root).result(std::move(reader.log()));
}

}  // namespace tinsmith::api
