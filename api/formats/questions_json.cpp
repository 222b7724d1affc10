// SPDX-License-Identifier: Apache-2.0
#include "api/formats/questions_json.hpp"

#include <array>
#include <utility>

#include "api/formats/geojson_coordinates.hpp"
#include "api/formats/geojson_shape.hpp"
#include "api/formats/json_reader.hpp"
#include "api/formats/json_reader_values.hpp"
#include "api/formats/plane_members.hpp"

namespace tinsmith::api {

namespace {

using json::Container;
using json::Object;
using json::quoted;
using json::Reader;
using json::Scalar;
using json::TupleList;
using json::Value;

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
        std::vector<json::Member> members = plane_.members();
        members.push_back({"session", &session_});
        members.push_back({"version", &version_});
        expect(std::move(members));
    }

  protected:
    std::string_view expected() const override { return "an object such as {\"elevation\": 500}"; }

    void begun(Reader& reader) override { faults_before_ = reader.log().size(); }
    void ended(Reader& reader) override {
        const int given = plane_.count(*this) + has("session") + has("version");
        if (given != 1) {
            reader.fault(given == 0 ? "MEMBER_MISSING" : "CONTRADICTION",
                         "Give one thing to compare with: \"elevation\", or \"plane\" of three "
                         "points, or \"slope\", \"azimuth\" and \"point\", or \"session\", or "
                         "\"version\".");
        }
        plane_.check(reader, *this);
        if (reader.log().size() != faults_before_) return;
        if (has("session")) {
            out_ = OtherSession{session_text_};
        } else if (has("version")) {
            out_ = EarlierVersion{version_.version()};
        } else if (const auto plane = plane_.take(reader, *this)) {
            out_ = *plane;
        }
    }

  private:
    Against& out_;
    std::size_t faults_before_ = 0;
    std::string session_text_;
    json::PlaneMembers plane_;
    json::Text session_{session_text_};
    Version version_;
};

/// A system that a geometry names for itself, which volumes do not bring over.
class NoSystem : public Value {
  public:
    void scalar(Reader& reader, const Scalar& value) override {
        if (value.kind != Scalar::Kind::Null) refuse(reader);
    }
    json::Container* object(Reader& reader) override { return refuse(reader); }
    json::Container* array(Reader& reader) override { return refuse(reader); }

  protected:
    std::string_view expected() const override { return "nothing"; }

  private:
    static json::Container* refuse(Reader& reader) {
        reader.fault("CRS_NOT_TAKEN",
                     "A volume is asked for in the session's system: leave this out, or bring the "
                     "polygon over first.");
        return nullptr;
    }
};

/// A GeoJSON geometry with an inside.
class AreaObject : public Object {
  public:
    AreaObject(std::optional<RequestedShape>& out, const ReadLimits& limits)
        : Object(Unknown::PassOver), out_(out), coordinates_value_(limits.max_polygon_vertices) {
        expect({{"type", &type_value_, true},
                {"coordinates", &coordinates_value_, true},
                {"crs", &no_system_, false},
                {"coordRefSys", &no_system_, false}});
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
    NoSystem no_system_;
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
