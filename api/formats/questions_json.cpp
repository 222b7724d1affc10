// SPDX-License-Identifier: Apache-2.0
#include "api/formats/questions_json.hpp"

#include <array>
#include <utility>

#include "api/formats/geojson_coordinates.hpp"
#include "api/formats/geojson_shape.hpp"
#include "api/formats/json_reader.hpp"
#include "api/formats/json_reader_values.hpp"

namespace tinsmith::api {

namespace {

using json::Container;
using json::Object;
using json::quoted;
using json::Reader;
using json::Scalar;
using json::Tuple;
using json::Value;

/// An array of tuples, up to a limit.
template <std::size_t Size>
class TupleList : public Value, public Container {
  public:
    TupleList(std::string_view item, std::string_view list, std::size_t most)
        : item_(item, *this), list_(list), most_(most) {}

    Container* array(Reader&) override { return this; }
    Value* element(Reader& reader) override {
        if (items_.size() < most_) return &item_;
        reader.stop(FaultKind::TooLarge,
                    {"TOO_MANY_POINTS",
                     "More than " + std::to_string(most_) + " points; no more are taken.",
                     reader.pointer()});
        return nullptr;
    }
    std::vector<std::array<double, Tuple::kMost>>& items() { return items_; }

  protected:
    std::string_view expected() const override { return list_; }

  private:
    struct Item : Tuple {
        Item(std::string_view what, TupleList& the_list)
            : Tuple(Size, Items::Coordinate, what), list(the_list) {}
        void complete(Reader&) override { list.items_.push_back(numbers()); }
        TupleList& list;
    };

    Item item_;
    std::string_view list_;
    std::size_t most_;
    std::vector<std::array<double, Tuple::kMost>> items_;
};

class PointsBody : public Object {
  public:
    explicit PointsBody(const ReadLimits& limits)
        : points_("a point [x, y]", "an array of points [x, y]", limits.max_polygon_vertices) {
        expect({{"points", &points_, true}});
    }
    std::vector<core::Point2> points() {
        std::vector<core::Point2> out;
        out.reserve(points_.items().size());
        for (const auto& item : points_.items())
            out.push_back({item[0], item[1]});
        return out;
    }

  private:
    TupleList<2> points_;
};

/// A number as large as a coordinate may be.
class Number : public Value {
  public:
    void scalar(Reader& reader, const Scalar& value) override {
        if (!value.is_number()) return Value::scalar(reader, value);
        if (!json::acceptable_coordinate(value.number))
            return reader.fault("NUMBER_OUT_OF_RANGE", json::coordinate_out_of_range());
        number_ = value.number;
    }
    double number() const { return number_; }

  protected:
    std::string_view expected() const override { return "a number"; }

  private:
    double number_ = 0.0;
};

/// A whole number from 1 on.
class Version : public Value {
  public:
    void scalar(Reader& reader, const Scalar& value) override {
        if (value.kind != Scalar::Kind::Natural || value.natural == 0) {
            return Value::scalar(reader, value);
        }
        version_ = value.natural;
    }
    std::uint64_t version() const { return version_; }

  protected:
    std::string_view expected() const override { return "a version, a whole number from 1 on"; }

  private:
    std::uint64_t version_ = 0;
};

class AgainstObject : public Object {
  public:
    explicit AgainstObject(Against& out) : out_(out) {
        expect({{"elevation", &elevation_},
                {"plane", &plane_},
                {"slope", &slope_},
                {"azimuth", &azimuth_},
                {"point", &point_},
                {"session", &session_},
                {"version", &version_}});
    }

  protected:
    std::string_view expected() const override { return "an object such as {\"elevation\": 500}"; }

    void begun(Reader& reader) override { faults_before_ = reader.log().size(); }
    void ended(Reader& reader) override {
        const bool sloping = has("slope") || has("azimuth") || has("point");
        const int given = has("elevation") + has("plane") + has("session") + has("version") +
                          static_cast<int>(sloping);
        if (given != 1) {
            reader.fault(given == 0 ? "MEMBER_MISSING" : "CONTRADICTION",
                         "Give one thing to compare with: \"elevation\", or \"plane\" of three "
                         "points, or \"slope\", \"azimuth\" and \"point\", or \"session\", or "
                         "\"version\".");
        }
        for (const std::string_view name : {"slope", "azimuth", "point"}) {
            if (sloping && !has(name)) {
                reader.fault("MEMBER_MISSING",
                             quoted(name) +
                                 " is needed with the other two of slope, azimuth and "
                                 "point.");
            }
        }
        if (reader.log().size() == faults_before_) take(reader);
    }

  private:
    void take(Reader& reader) {
        if (has("session")) {
            out_ = OtherSession{session_text_};
        } else if (has("version")) {
            out_ = EarlierVersion{version_.version()};
        } else if (has("elevation")) {
            out_ = core::level_plane(elevation_.number());
        } else if (has("plane")) {
            take_plane(reader);
        } else if (has("slope")) {
            out_ =
                core::sloping_plane(slope_.number(), azimuth_.number(), point_of(point_.numbers()));
        }
    }
    void take_plane(Reader& reader) {
        const auto& points = plane_.items();
        const auto refuse = [&](std::string code, std::string detail) {
            reader.add(FaultKind::Invalid, {std::move(code), std::move(detail),
                                            json::pointer_to(reader.pointer(), "plane")});
        };
        if (points.size() != 3) {
            return refuse("WRONG_LENGTH", "A plane is given by three points [x, y, z]; here are " +
                                              std::to_string(points.size()) + ".");
        }
        const auto plane =
            core::plane_through(point_of(points[0]), point_of(points[1]), point_of(points[2]));
        if (!plane) {
            return refuse("PLANE_UPRIGHT",
                          "The three points are in one line in plan: no plane that has one "
                          "elevation at each position goes through them. Move one.");
        }
        out_ = *plane;
    }
    static core::Point3 point_of(const std::array<double, Tuple::kMost>& numbers) {
        return {numbers[0], numbers[1], numbers[2]};
    }

    Against& out_;
    std::size_t faults_before_ = 0;
    std::string session_text_;
    Number elevation_, slope_, azimuth_;
    TupleList<3> plane_{"a point [x, y, z]", "an array of three points [x, y, z]", 3};
    Tuple point_{3, Tuple::Items::Coordinate, "a point [x, y, z]"};
    json::Text session_{session_text_};
    Version version_;
};

/// A GeoJSON geometry with an inside.
class AreaObject : public Object {
  public:
    AreaObject(std::optional<RequestedShape>& out, const ReadLimits& limits)
        : Object(Unknown::PassOver), out_(out), coordinates_value_(limits.max_polygon_vertices) {
        expect({{"type", &type_value_, true}, {"coordinates", &coordinates_value_, true}});
    }

  protected:
    void begun(Reader& reader) override {
        coordinates_value_.write_to(coordinates_);
        faults_before_ = reader.log().size();
    }
    void ended(Reader& reader) override {
        const auto type = geometry_type(type_);
        if (type == GeometryType::Polygon || type == GeometryType::MultiPolygon) {
            out_ = make_shape(*type, coordinates_, reader.pointer(), reader.log());
        } else if (!type_.empty() || reader.log().size() == faults_before_) {
            reader.add(FaultKind::Invalid,
                       {"GEOJSON_TYPE",
                        quoted(type_) + " has no inside: send a Polygon or a MultiPolygon.",
                        json::pointer_to(reader.pointer(), "type")});
        }
    }

  private:
    std::optional<RequestedShape>& out_;
    std::size_t faults_before_ = 0;
    std::string type_;
    Coordinates coordinates_;
    json::Text type_value_{type_};
    CoordinatesReader coordinates_value_;
};

/// A geometry, or the id of a polygon that the session has.
class AreaOrId : public Value {
  public:
    AreaOrId(VolumeRequest& out, const ReadLimits& limits)
        : area_(out.shape, limits), id_(out.polygon_id) {}
    void scalar(Reader& reader, const Scalar& value) override {
        if (value.kind != Scalar::Kind::Text) return Value::scalar(reader, value);
        if (value.text.empty()) return reader.fault("TEXT_EMPTY", "An id has a letter at least.");
        id_.scalar(reader, value);
    }
    Container* object(Reader& reader) override { return area_.object(reader); }

  protected:
    std::string_view expected() const override {
        return "a GeoJSON geometry or the id of a polygon";
    }

  private:
    AreaObject area_;
    json::Text id_;
};

class VolumeBody : public Object {
  public:
    explicit VolumeBody(const ReadLimits& limits) : polygon_(request_, limits) {
        expect({{"polygon", &polygon_}, {"against", &against_, true}});
    }
    VolumeRequest take() { return std::move(request_); }

  private:
    VolumeRequest request_;
    AreaOrId polygon_;
    AgainstObject against_{request_.against};
};

}  // namespace

Parsed<std::vector<core::Point2>> read_points(std::string_view body, const ReadLimits& limits) {
    PointsBody root(limits);
    Reader reader(root, limits);
    json::read(body, reader);
    if (!reader.log().empty()) {
        return std::move(reader.log()).refusal<std::vector<core::Point2>>();
    }
    return root.points();
}

Parsed<VolumeRequest> read_volume_request(std::string_view body, const ReadLimits& limits) {
    VolumeBody root(limits);
    Reader reader(root, limits);
    json::read(body, reader);
    if (!reader.log().empty()) return std::move(reader.log()).refusal<VolumeRequest>();
    return root.take();
}

Parsed<PolygonRequest> read_line(std::string_view body, const ReadLimits& limits) {
    auto request = read_geojson(body, limits);
    if (!request) return request;
    FaultLog log(limits.max_faults);
    for (const auto& [name, value] : request->options) {
        log.add(FaultKind::Invalid, {"UNKNOWN_OPTION",
                                     name + " is not known here: a profile takes "
                                            "no options.",
                                     json::pointer_to("/tinsmith", name)});
    }
    for (std::size_t i = 0; i < request->shapes.size(); ++i) {
        const RequestedShape& shape = request->shapes[i];
        if (i == 0 && shape.type == GeometryType::LineString) continue;
        std::string what = i > 0 ? "This is one geometry more than is taken here"
                                 : "A " + std::string(geometry_name(shape.type)) + " is no line";
        log.add(FaultKind::Invalid,
                {"GEOJSON_TYPE", what + ": send one LineString, as a geometry or a Feature.",
                 shape.pointer});
    }
    if (!log.empty()) return std::move(log).refusal<PolygonRequest>();
    return request;
}

}  // namespace tinsmith::api
