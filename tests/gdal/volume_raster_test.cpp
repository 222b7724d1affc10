// SPDX-License-Identifier: Apache-2.0
// Volumes on the bundled terrain against sums over a raster of one metre that GDAL makes: its own
// bilinear elevations, its own idea of which pixels are inside the polygon.
#include <array>
#include <cmath>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

#include <gdal.h>
#include <gdal_alg.h>
#include <gtest/gtest.h>
#include <ogr_api.h>

#include "api/formats/geojson.hpp"
#include "api/formats/geotiff.hpp"
#include "api/formats/grid_mesh.hpp"
#include "core/edit/cutout.hpp"
#include "core/edit/spot.hpp"
#include "core/edit/volume.hpp"
#include "core/mesh/build.hpp"

namespace tinsmith {
namespace {

const std::string kData = std::string(TINSMITH_SOURCE_DIR) + "/tests/data/";

std::string read_data(const std::string& name) {
    std::ifstream in(kData + name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

const core::Tin& terrain() {
    static const core::Tin tin = [] {
        auto read = api::meshed(api::read_geotiff(read_data("jacksboro.tif"), {}), {});
        return std::move(*core::build_tin(read->mesh));
    }();
    return tin;
}

/// A window of the terrain in pixels of a metre.
struct Raster {
    int width = 0;
    int height = 0;
    double left = 0.0;
    double top = 0.0;
    std::vector<double> elevations;     ///< by GDAL, bilinear
    std::vector<unsigned char> inside;  ///< by GDAL, whose centre is inside the polygon

    core::Point2 centre(int column, int row) const {
        return {left + column + 0.5, top - row - 0.5};
    }
};

std::string wkt_of(const core::Shape& shape) {
    std::string text = "POLYGON (";
    for (std::size_t i = 0; i < shape.paths.size(); ++i) {
        text += i > 0 ? ", (" : "(";
        std::vector<core::Point2> ring = shape.paths[i].points;
        ring.push_back(ring.front());
        for (std::size_t k = 0; k < ring.size(); ++k)
            text +=
                (k > 0 ? ", " : "") + std::to_string(ring[k].x) + " " + std::to_string(ring[k].y);
        text += ")";
    }
    return text + ")";
}

Raster raster_of(const core::Shape& shape) {
    GDALAllRegister();
    Raster raster;
    GDALDatasetH terrain = GDALOpen((kData + "jacksboro.tif").c_str(), GA_ReadOnly);
    std::array<double, 6> to_map{};
    GDALGetGeoTransform(terrain, to_map.data());
    const double cell = to_map[1];
    core::Point2 low = shape.paths[0].points[0], high = low;
    for (const core::Point2& p : shape.paths[0].points) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    // Two cells beyond the polygon, so that no post that counts is missing at the window's edge.
    const int first_column = static_cast<int>((low.x - to_map[0]) / cell) - 2;
    const int first_row = static_cast<int>((to_map[3] - high.y) / cell) - 2;
    const int columns = static_cast<int>((high.x - to_map[0]) / cell) + 3 - first_column;
    const int rows = static_cast<int>((to_map[3] - low.y) / cell) + 3 - first_row;
    raster.left = to_map[0] + first_column * cell;
    raster.top = to_map[3] - first_row * cell;
    raster.width = columns * static_cast<int>(cell);
    raster.height = rows * static_cast<int>(cell);
    const auto pixels =
        static_cast<std::size_t>(raster.width) * static_cast<std::size_t>(raster.height);

    raster.elevations.resize(pixels);
    GDALRasterIOExtraArg how;
    INIT_RASTERIO_EXTRA_ARG(how);
    how.eResampleAlg = GRIORA_Bilinear;
    EXPECT_EQ(GDALRasterIOEx(GDALGetRasterBand(terrain, 1), GF_Read, first_column, first_row,
                             columns, rows, raster.elevations.data(), raster.width, raster.height,
                             GDT_Float64, 0, 0, &how),
              CE_None);
    GDALClose(terrain);

    GDALDatasetH mask = GDALCreate(GDALGetDriverByName("MEM"), "", raster.width, raster.height, 1,
                                   GDT_Byte, nullptr);
    std::array<double, 6> metre{raster.left, 1, 0, raster.top, 0, -1};
    GDALSetGeoTransform(mask, metre.data());
    OGRGeometryH polygon = nullptr;
    std::string wkt = wkt_of(shape);
    char* text = wkt.data();
    EXPECT_EQ(OGR_G_CreateFromWkt(&text, nullptr, &polygon), OGRERR_NONE);
    int band = 1;
    double one = 1.0;
    EXPECT_EQ(GDALRasterizeGeometries(mask, 1, &band, 1, &polygon, nullptr, nullptr, &one, nullptr,
                                      nullptr, nullptr),
              CE_None);
    raster.inside.resize(pixels);
    EXPECT_EQ(GDALRasterIO(GDALGetRasterBand(mask, 1), GF_Read, 0, 0, raster.width, raster.height,
                           raster.inside.data(), raster.width, raster.height, GDT_Byte, 0, 0),
              CE_None);
    OGR_G_DestroyGeometry(polygon);
    GDALClose(mask);
    return raster;
}

struct Sums {
    double cut = 0.0;
    double fill = 0.0;
    double area = 0.0;
};

template <typename Elevation>
Sums sum_over(const Raster& raster, double level, Elevation elevation) {
    Sums sums;
    std::size_t i = 0;
    for (int row = 0; row < raster.height; ++row) {
        for (int column = 0; column < raster.width; ++column, ++i) {
            if (raster.inside[i] == 0) continue;
            const double d = elevation(i, raster.centre(column, row)) - level;
            (d > 0 ? sums.cut : sums.fill) += std::fabs(d);
            sums.area += 1.0;
        }
    }
    return sums;
}

/// `height`: by how much the surfaces may differ, on average over the area.
void expect_agreement(const core::Volume& found, const Sums& sums, double height,
                      const char* what) {
    std::cout << what << ": cut off by " << found.cut - sums.cut << " of " << found.cut
              << ", fill by " << found.fill - sums.fill << " of " << found.fill << ", area by "
              << found.area - sums.area << " of " << found.area << "\n";
    EXPECT_NEAR(found.cut, sums.cut, height * sums.area) << what;
    EXPECT_NEAR(found.fill, sums.fill, height * sums.area) << what;
    EXPECT_NEAR(found.area, sums.area, 1e-5 * sums.area) << what;
}

void compare(const core::Shape& shape, double level) {
    auto part = core::cut_out(terrain(), shape, core::Winding::EvenOdd);
    ASSERT_TRUE(part);
    const core::Volume found =
        core::volume_against(part->tin, part->region.triangles, core::level_plane(level));
    const Raster raster = raster_of(shape);
    // A cell of 83 m is bent as GDAL sees it and two triangles as the mesh does: between its posts
    // the two differ by centimetres on average. With the mesh's own elevations only the sampling is
    // left: a pixel is in or out, above or below, as a whole.
    expect_agreement(
        found,
        sum_over(raster, level, [&](std::size_t i, core::Point2) { return raster.elevations[i]; }),
        0.1, "GDAL's elevations");
    expect_agreement(found,
                     sum_over(raster, level,
                              [&](std::size_t, core::Point2 p) {
                                  return core::spot_at(terrain(), p)->elevation;
                              }),
                     3e-3, "the mesh's elevations");
}

TEST(VolumeAgainstGdal, OfTheLakeBelowALevel) {
    const auto lake = api::read_geojson(read_data("lake.geojson"), {});
    ASSERT_TRUE(lake);
    compare(lake->shapes[0].shape, 500.0);
}

TEST(VolumeAgainstGdal, OfHillsWithCutAndFill) {
    const core::Shape hills{
        {{{{757000.25, 4024000.5},
           {760100.5, 4024700.25},
           {759800.75, 4028100.5},
           {756900.5, 4027300.75}},
          true,
          {}},
         {{{758000.5, 4025500.25}, {758900.5, 4025500.75}, {758400, 4026500}}, true, {}}}};
    compare(hills, 345.0);
}

}  // namespace
}  // namespace tinsmith
