// SPDX-License-Identifier: Apache-2.0
#include "api/formats/geojson_crs.hpp"

#include <optional>
#include <utility>

#include "api/crs.hpp"

namespace tinsmith::api {

using json::quoted;
using json::Reader;
using json::Scalar;

LegacyCrs::LegacyCrs(std::string& out) : Object(Unknown::PassOver), out_(out) {
    properties_.expect({{"name", &name_value_, true}});
    expect({{"type", &type_value_}, {"properties", &properties_, true}});
}

void LegacyCrs::scalar(Reader& reader, const Scalar& value) {
    if (value.kind != Scalar::Kind::Null) Value::scalar(reader, value);  // null: not known
}

void LegacyCrs::ended(Reader& reader) {
    if (!type_.empty() && type_ != "name") {
        reader.fault("CRS_UNKNOWN", "A crs of type " + quoted(type_) +
                                        " is not read; name it: {\"type\": \"name\", ...}.");
    } else if (auto crs = normalise_crs(name_)) {
        out_ = *std::move(crs);
    } else if (reader.log().empty() || !name_.empty()) {
        reader.fault("CRS_UNKNOWN", quoted(name_) +
                                        " is no name of a reference system; write it like "
                                        "\"urn:ogc:def:crs:EPSG::32616\".");
    }
}

CoordRefSys::CoordRefSys(std::string& out) : Object(Unknown::PassOver), out_(out) {
    expect({{"type", &type_value_, true}, {"href", &href_value_, true}});
}

void CoordRefSys::scalar(Reader& reader, const Scalar& value) {
    if (value.kind == Scalar::Kind::Null) return;  // not known
    if (value.kind != Scalar::Kind::Text) return Value::scalar(reader, value);
    take(reader, value.text);
}

void CoordRefSys::ended(Reader& reader) {
    if (type_ == "Reference") return take(reader, href_);
    reader.fault("CRS_UNKNOWN", "A coordRefSys of type " + quoted(type_) +
                                    " is not read; name it: {\"type\": \"Reference\", \"href\": "
                                    "\"http://www.opengis.net/def/crs/EPSG/0/32616\"}.");
}

void CoordRefSys::take(Reader& reader, std::string_view name) {
    std::string_view bare = name;  // of a compact URI, "[EPSG:25832]"
    if (bare.size() > 2 && bare.front() == '[' && bare.back() == ']')
        bare = bare.substr(1, bare.size() - 2);
    if (auto crs = normalise_crs(bare)) {
        out_ = *std::move(crs);
    } else {
        reader.fault("CRS_UNKNOWN", quoted(name) +
                                        " is no name of a reference system; write it like "
                                        "\"http://www.opengis.net/def/crs/EPSG/0/32616\".");
    }
}

}  // namespace tinsmith::api
