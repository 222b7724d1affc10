// SPDX-License-Identifier: Apache-2.0
#include "tests/cgal/bundled_data.hpp"

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "api/formats/geojson.hpp"
#include "api/formats/geotiff.hpp"
#include "api/formats/grid_mesh.hpp"
#include "core/mesh/surface.hpp"
#include "core/mesh/walk.hpp"

namespace tinsmith::cgal {

namespace {

std::string read_data(const std::string& name) {
    std::ifstream in(std::string(TINSMITH_SOURCE_DIR) + "/tests/data/" + name, std::ios::binary);
    if (!in) throw std::runtime_error("tests/data/" + name + " cannot be read");
    return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

core::MeshData bundled_terrain() {
    auto read = api::meshed(api::read_geotiff(read_data("jacksboro.tif"), {}), {});
    if (!read) throw std::runtime_error("the bundled terrain is refused");
    return std::move(read->mesh);
}

core::Shape bundled_shape(const std::string& name) {
    auto read = api::read_geojson(read_data(name + ".geojson"), {});
    if (!read) throw std::runtime_error(name + " is refused");
    return std::move(read->shapes.at(0).shape);
}

std::vector<Polyline> drape(const core::Tin& tin, const core::Shape& shape) {
    std::vector<Polyline> draped;
    for (const core::Path& path : shape.paths) {
        Polyline line;
        for (const core::Point2 p : path.points) {
            const core::Location at = core::locate(tin, p, tin.hint(p));
            if (at.kind == core::Location::Kind::Outside)
                throw std::runtime_error("a point is outside the mesh");
            const double z = at.kind == core::Location::Kind::OnVertex
                                 ? tin.vertex(at.vertex).z
                                 : core::elevation_in(tin, at.side.triangle(), p);
            line.push_back({p.x, p.y, z});
        }
        if (path.closed && !line.empty()) line.push_back(core::Point3(line.front()));
        draped.push_back(std::move(line));
    }
    return draped;
}

}  // namespace tinsmith::cgal
