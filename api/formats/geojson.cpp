// SPDX-License-Identifier: Apache-2.0
#include "api/formats/geojson.hpp"

#include <algorithm>
#include <utility>

#include "api/crs.hpp"
#include "api/formats/geojson_coordinates.hpp"
#include "api/formats/geojson_crs.hpp"
#include "api/formats/geojson_shape.hpp"
#include "api/formats/json_reader.hpp"
#include "api/formats/json_reader_text.hpp"
#include "api/formats/json_reader_values.hpp"
#include "api/formats/options_reader.hpp"

namespace tinsmith::api {

namespace {

using json::Container;
using json::Object;
using json::pointer_to;
using json::quoted;
using json::Reader;
using json::Scalar;
using json::Value;

constexpr std::size_t kLongestText = 1000;  ///< of an id

/// What was read of a geometry; its "type" may be its last member.
struct GeometryDraft {
    std::string type;
    Coordinates coordinates;
};

/// What was read of a Feature.
struct FeatureDraft {
    std::string type;
    std::optional<RequestedShape> shape;  ///< of its geometry, unless that had faults
    std::string id;
    std::string properties = "{}";
};

/// A Feature's id, kept as JSON: 7 and "7" are two.
class Id : public json::Text {
  public:
    explicit Id(std::string& out) : Text(text_, kLongestText), out_(out) {}
    void scalar(Reader& reader, const Scalar& value) override {
        if (value.is_number()) {
            out_ = json::plain_text(value);
            return;
        }
        Text::scalar(reader, value);
        out_.clear();
        json::append_text(out_, text_);
    }

  protected:
    std::string_view expected() const override { return "a text or a number"; }

  private:
    std::string text_;
    std::string& out_;
};

/// Whether a member "type" was no text, which has been told.
bool type_at_fault(std::string_view type, Reader& reader) {
    return type.empty() && !reader.log().empty();
}

/// The shape of a geometry that has been read: the body, or a Feature's. nullopt: it has faults.
std::optional<RequestedShape> finish_geometry(GeometryDraft& draft, Reader& reader) {
    if (draft.type == "GeometryCollection") {
        reader.add(FaultKind::Unsupported,
                   {"GEOMETRY_COLLECTION_UNSUPPORTED",
                    "Geometry collections are not taken; send each geometry as a Feature of a "
                    "FeatureCollection.",
                    reader.pointer()});
        return std::nullopt;
    }
    if (type_at_fault(draft.type, reader)) return std::nullopt;
    const auto type = geometry_type(draft.type);
    if (!type) {
        reader.add(
            FaultKind::Invalid,
            {"GEOJSON_TYPE",
             quoted(draft.type) + " is no geometry. Known are: Point, MultiPoint, LineString, "
                                  "MultiLineString, Polygon, MultiPolygon.",
             pointer_to(reader.pointer(), "type")});
        return std::nullopt;
    }
    return make_shape(*type, draft.coordinates, reader.pointer(), reader.log());
}

/// The value of a Feature's member "geometry".
class GeometryObject : public Object {
  public:
    GeometryObject(FeatureDraft& feature, CoordinatesReader& coordinates)
        : Object(Unknown::PassOver), feature_(feature), coordinates_(coordinates) {
        expect({{"type", &type_, true}, {"coordinates", &coordinates_}, {"geometries"}});
    }

    void scalar(Reader& reader, const Scalar& value) override {
        if (value.kind != Scalar::Kind::Null) return Value::scalar(reader, value);
        reader.fault("SHAPE_EMPTY", "This Feature has no geometry; there is nothing to integrate.");
    }

  protected:
    std::string_view expected() const override { return "a geometry"; }
    void begun(Reader&) override {
        draft_ = {};
        coordinates_.write_to(draft_.coordinates);
    }
    void ended(Reader& reader) override {
        if (has("coordinates") || draft_.type == "GeometryCollection") {
            feature_.shape = finish_geometry(draft_, reader);
        } else {
            reader.fault("MEMBER_MISSING", "\"coordinates\" is needed here.");
        }
    }

  private:
    FeatureDraft& feature_;
    CoordinatesReader& coordinates_;
    GeometryDraft draft_;
    json::Text type_{draft_.type};
};

/// Hands the Feature's shape on with what belongs to the Feature.
void finish_feature(FeatureDraft& draft, std::vector<RequestedShape>& shapes) {
    if (!draft.shape) return;  // the fault was told where the geometry is, or is missing
    draft.shape->id = std::move(draft.id);
    draft.shape->properties = std::move(draft.properties);
    shapes.push_back(*std::move(draft.shape));
}

/// An element of "features".
class FeatureObject : public Object {
  public:
    FeatureObject(std::vector<RequestedShape>& shapes, CoordinatesReader& coordinates)
        : Object(Unknown::PassOver), shapes_(shapes), geometry_(draft_, coordinates) {
        expect({{"type", &type_, true},
                {"geometry", &geometry_, true},
                {"properties", &properties_},
                {"id", &id_},
                {"place", &place_}});
    }
    const Presence& place() const { return place_; }

  protected:
    std::string_view expected() const override { return "a Feature"; }
    void begun(Reader&) override {
        draft_ = {};
        properties_.write_to(draft_.properties);
    }
    void ended(Reader& reader) override {
        if (draft_.type != "Feature" && !type_at_fault(draft_.type, reader)) {
            reader.add(
                FaultKind::Invalid,
                {"GEOJSON_TYPE",
                 quoted(draft_.type) + " is not taken here: the elements of \"features\" are of "
                                       "type \"Feature\".",
                 pointer_to(reader.pointer(), "type")});
        }
        finish_feature(draft_, shapes_);
    }

  private:
    std::vector<RequestedShape>& shapes_;
    FeatureDraft draft_;
    json::Text type_{draft_.type};
    Id id_{draft_.id};
    json::ObjectText properties_;
    GeometryObject geometry_;
    Presence place_;  ///< of any of them
};

class FeatureList : public Value, public Container {
  public:
    FeatureList(std::vector<RequestedShape>& shapes, CoordinatesReader& coordinates)
        : feature_(shapes, coordinates) {}

    Container* array(Reader&) override { return this; }
    Value* element(Reader&) override {
        empty_ = false;
        return &feature_;
    }
    void close(Reader& reader) override {
        if (!empty_) return;
        reader.fault("SHAPE_EMPTY", "There is no Feature; there is nothing to integrate.");
    }
    bool has_place() const { return feature_.place().given(); }

  protected:
    std::string_view expected() const override { return "an array of Features"; }

  private:
    FeatureObject feature_;
    bool empty_ = true;
};

/// The body: a FeatureCollection, a Feature or a geometry, told apart when all has been read.
class Body : public Object {
  public:
    explicit Body(const ReadLimits& limits)
        : Object(Unknown::PassOver), coordinates_(limits.max_polygon_vertices) {
        expect({{"type", &type_, true},
                {"features", &features_},
                {"geometry", &geometry_},
                {"properties", &properties_},
                {"id", &id_},
                {"coordinates", &coordinates_},
                {"geometries"},
                {"crs", &crs_},
                {"coordRefSys", &coord_ref_sys_},
                {"place", &place_},
                {"tinsmith", &options_}});
    }

    Value* member(Reader& reader, std::string_view name) override {
        // A member "geometry" borrows the same reader; the coordinates are the body's again.
        if (name == "coordinates") coordinates_.write_to(own_geometry_.coordinates);
        return Object::member(reader, name);
    }

    Parsed<PolygonRequest> result(FaultLog&& log) && {
        if (!log.empty()) return std::move(log).refusal<PolygonRequest>();
        return std::move(request_);
    }

  protected:
    std::string_view expected() const override { return "a GeoJSON object"; }
    void begun(Reader&) override { properties_.write_to(feature_.properties); }
    void ended(Reader& reader) override {
        settle_crs(reader);
        if (type_at_fault(type_text_, reader)) return;
        const std::string_view content = content_of(type_text_);
        refuse_strangers(reader, content);
        if (!has(content)) {
            if (content == "coordinates" && !geometry_type(type_text_)) {
                refuse_type(reader);
            } else {
                reader.fault("MEMBER_MISSING", quoted(content) + " is needed here.");
            }
        } else if (content == "geometry") {
            finish_feature(feature_, request_.shapes);
        } else if (content != "features") {
            own_geometry_.type = type_text_;
            FeatureDraft around;  // a geometry has no id and no properties: they would be foreign
            around.shape = finish_geometry(own_geometry_, reader);
            finish_feature(around, request_.shapes);
        }
    }

  private:
    /// The member that a body of this type is about.
    static std::string_view content_of(std::string_view type) {
        if (type == "FeatureCollection") return "features";
        if (type == "Feature") return "geometry";
        if (type == "GeometryCollection") return "geometries";
        return "coordinates";
    }

    static void refuse_type(Reader& reader) {
        reader.add(FaultKind::Invalid,
                   {"GEOJSON_TYPE",
                    "The type of a body is FeatureCollection, Feature, Point, MultiPoint, "
                    "LineString, MultiLineString, Polygon or MultiPolygon.",
                    pointer_to(reader.pointer(), "type")});
    }

    /// One system from either member. In JSON-FG "place" has the geometry of that system, and
    /// "geometry" another in degrees: which of the two is meant is not for us to say.
    void settle_crs(Reader& reader) {
        if (!legacy_crs_.empty() && !json_fg_crs_.empty() && !same_crs(legacy_crs_, json_fg_crs_)) {
            reader.add(FaultKind::Invalid,
                       {"CONTRADICTION",
                        "The body's crs is " + legacy_crs_ + ", its coordRefSys " + json_fg_crs_ +
                            ": give one, or the same twice.",
                        pointer_to(reader.pointer(), "coordRefSys")});
        }
        if (!json_fg_crs_.empty() && (place_.given() || features_.has_place())) {
            reader.add(FaultKind::Unsupported,
                       {"PLACE_UNSUPPORTED",
                        "The \"place\" of JSON-FG is not read: send it as \"geometry\", which is "
                        "taken to be in the body's coordRefSys, " +
                            json_fg_crs_ + ".",
                        pointer_to(reader.pointer(), "coordRefSys")});
        }
        const bool is_legacy = json_fg_crs_.empty();
        request_.crs = is_legacy ? legacy_crs_ : json_fg_crs_;
        request_.crs_pointer = pointer_to(reader.pointer(), is_legacy ? "crs" : "coordRefSys");
    }

    /// RFC 7946, 7.1: members that make a type are not foreign members of another. Shapes that
    /// are in the body and not meant by its type would otherwise be lost without a word.
    void refuse_strangers(Reader& reader, std::string_view content) {
        for (const std::string_view name : {"features", "geometry", "coordinates", "geometries"}) {
            if (name == content || !has(name)) continue;
            reader.add(FaultKind::Invalid, {"MEMBER_NOT_ALLOWED",
                                            quoted(name) + " does not belong to a body of type " +
                                                quoted(type_text_) + ".",
                                            pointer_to(reader.pointer(), name)});
        }
    }

    PolygonRequest request_;
    std::string type_text_;
    GeometryDraft own_geometry_;  ///< when the body is a geometry
    FeatureDraft feature_;        ///< when the body is a Feature
    CoordinatesReader coordinates_;
    json::Text type_{type_text_};
    Id id_{feature_.id};
    json::ObjectText properties_;
    GeometryObject geometry_{feature_, coordinates_};
    FeatureList features_{request_.shapes, coordinates_};
    std::string legacy_crs_;
    std::string json_fg_crs_;
    LegacyCrs crs_{legacy_crs_};
    CoordRefSys coord_ref_sys_{json_fg_crs_};
    Presence place_;
    json::OptionsReader options_{request_.options};
};

}  // namespace

Parsed<PolygonRequest> read_geojson(std::string_view body, const ReadLimits& limits) {
    Body root(limits);
    Reader reader(root, limits);
    json::read(body, reader);
    return std::move(root).result(std::move(reader.log()));
}

}  // namespace tinsmith::api
