// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "api/formats/json_reader.hpp"
#include "api/formats/json_reader_values.hpp"

namespace tinsmith::api {

/// The member "crs" of GeoJSON 2008: {"type": "name", "properties": {"name": "EPSG:32616"}}.
class LegacyCrs : public json::Object {
  public:
    /// Requires: `out` outlives the reading. It becomes the normalised name.
    explicit LegacyCrs(std::string& out);
    void scalar(json::Reader& reader, const json::Scalar& value) override;

  protected:
    void ended(json::Reader& reader) override;

  private:
    std::string& out_;
    std::string type_;
    std::string name_;
    json::Text type_value_{type_};
    json::Text name_value_{name_};
    json::Object properties_{Unknown::PassOver};
};

/// The member "coordRefSys" of JSON-FG: "http://www.opengis.net/def/crs/EPSG/0/25832",
/// "[EPSG:25832]", or {"type": "Reference", "href": the same}.
class CoordRefSys : public json::Object {
  public:
    /// Requires: `out` outlives the reading. It becomes the normalised name.
    explicit CoordRefSys(std::string& out);
    void scalar(json::Reader& reader, const json::Scalar& value) override;

  protected:
    std::string_view expected() const override { return "the name of one reference system"; }
    void ended(json::Reader& reader) override;

  private:
    void take(json::Reader& reader, std::string_view name);

    std::string& out_;
    std::string type_;
    std::string href_;
    json::Text type_value_{type_};
    json::Text href_value_{href_};
};

/// A member that is passed over, and whether it says anything: null does not.
class Presence : public json::Value {
  public:
    void scalar(json::Reader&, const json::Scalar& value) override {
        given_ = given_ || value.kind != json::Scalar::Kind::Null;
    }
    json::Container* object(json::Reader&) override {
        given_ = true;
        return nullptr;
    }
    json::Container* array(json::Reader& reader) override { return object(reader); }
    bool given() const { return given_; }

  protected:
    std::string_view expected() const override { return "anything"; }

  private:
    bool given_ = false;
};

}  // namespace tinsmith::api
