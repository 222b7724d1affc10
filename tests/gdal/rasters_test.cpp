// SPDX-License-Identifier: Apache-2.0
// Rasters as GDAL's programs write them, and as others have made them, against GDAL's own reading.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gdal.h>
#include <gtest/gtest.h>

#include "api/formats/ascii_grid.hpp"
#include "api/formats/geotiff.hpp"
#include "api/formats/grid_mesh.hpp"
#include "tests/gdal/gdal_programs.hpp"

namespace tinsmith {
namespace {

using testing::Workshop;

const std::string kTerrain = std::string(TINSMITH_SOURCE_DIR) + "/tests/data/jacksboro.tif";

/// A raster's posts with data, by GDAL alone.
struct Posts {
    std::size_t columns = 0, rows = 0;
    std::map<std::pair<double, double>, double>
        elevations;  ///< by place, rounded to a tenth of a cell
    std::array<double, 6> place{};

    std::pair<double, double> key(double x, double y) const {
        return {std::round((x - place[0]) / place[1] * 10),
                std::round((y - place[3]) / place[5] * 10)};
    }
};

Posts posts_by_gdal(const std::string& path) {
    GDALAllRegister();
    Posts posts;
    GDALDatasetH raster = GDALOpen(path.c_str(), GA_ReadOnly);
    EXPECT_NE(raster, nullptr) << path;
    if (raster == nullptr) return posts;
    const int width = GDALGetRasterXSize(raster), height = GDALGetRasterYSize(raster);
    posts.columns = static_cast<std::size_t>(width);
    posts.rows = static_cast<std::size_t>(height);
    GDALGetGeoTransform(raster, posts.place.data());
    GDALRasterBandH band = GDALGetRasterBand(raster, 1);
    GDALRasterBandH mask = GDALGetMaskBand(band);
    std::vector<double> values(posts.columns * posts.rows);
    std::vector<unsigned char> valid(values.size());
    EXPECT_EQ(GDALRasterIO(band, GF_Read, 0, 0, width, height, values.data(), width, height,
                           GDT_Float64, 0, 0),
              CE_None);
    EXPECT_EQ(GDALRasterIO(mask, GF_Read, 0, 0, width, height, valid.data(), width, height,
                           GDT_Byte, 0, 0),
              CE_None);
    const double scale = GDALGetRasterScale(band, nullptr);
    const double offset = GDALGetRasterOffset(band, nullptr);
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (valid[i] == 0 || std::isnan(values[i])) continue;
        const auto column = static_cast<double>(i % posts.columns) + 0.5;
        const auto row = static_cast<double>(i / posts.columns) + 0.5;
        posts.elevations[posts.key(posts.place[0] + column * posts.place[1],
                                   posts.place[3] + row * posts.place[5])] =
            values[i] * scale + offset;
    }
    GDALClose(raster);
    return posts;
}

/// Every vertex is a post, with its elevation; no more posts are missing than those that no cell
/// of three with data holds.
void expect_same(const core::MeshData& mesh, const Posts& posts, double tolerance,
                 std::size_t most_missing = 0) {
    ASSERT_FALSE(mesh.vertices.empty());
    EXPECT_LE(mesh.vertices.size(), posts.elevations.size());
    EXPECT_GE(mesh.vertices.size() + most_missing, posts.elevations.size());
    std::size_t wrong = 0;
    for (const core::Point3& p : mesh.vertices) {
        const auto found = posts.elevations.find(posts.key(p.x, p.y));
        if (found != posts.elevations.end() && std::fabs(found->second - p.z) <= tolerance)
            continue;
        if (++wrong > 3) continue;
        ADD_FAILURE() << p.x << " " << p.y << " " << p.z << ", where GDAL has "
                      << (found == posts.elevations.end() ? NAN : found->second);
    }
    EXPECT_EQ(wrong, 0U);
}

api::Terrain read_tiff(const std::string& bytes, const api::TerrainOptions& options = {}) {
    auto terrain = api::meshed(api::read_geotiff(bytes, {}, options), {});
    if (terrain) return *std::move(terrain);
    ADD_FAILURE() << terrain.faults()[0].code << ": " << terrain.faults()[0].detail;
    return {};
}

TEST(Rasters, OfEverySampleTypeAndLayout) {
    const char* const ways[] = {
        "-ot Byte -scale 240 1075 1 255 -a_nodata 0",
        "-ot UInt16 -a_nodata 0",
        "-ot Int16 -co COMPRESS=LZW -co PREDICTOR=2",
        "-ot UInt32 -a_nodata 0 -co COMPRESS=PACKBITS",
        "-ot Int32 -co TILED=YES -co BLOCKXSIZE=64 -co BLOCKYSIZE=32",
        "-ot Float32 -co TILED=YES -co COMPRESS=DEFLATE -co PREDICTOR=3 -co BIGTIFF=YES",
        "-ot Float64 -co COMPRESS=ZSTD -co ENDIANNESS=BIG",
        "-ot Float64 -co COMPRESS=LERC",
        "-ot Float32 -co COMPRESS=LERC_DEFLATE",
        "-ot Float32 -co COMPRESS=LZMA -co BLOCKYSIZE=50",
        "-ot Float32 -co COMPRESS=DEFLATE -co BLOCKYSIZE=7",
        "-ot Float64 -co COMPRESS=DEFLATE -co PREDICTOR=3 -co ENDIANNESS=BIG",
        "-ot Int16 -co COMPRESS=DEFLATE -co TILED=YES -co BLOCKXSIZE=512 -co BLOCKYSIZE=48",
        "-ot UInt16 -a_nodata 0 -co COMPRESS=DEFLATE -co NBITS=12",
        "-ot Float32 -co COMPRESS=DEFLATE -co NBITS=24",
        "-ot Int16 -a_scale 0.01 -a_offset 500 -a_nodata -9999",
        "-ot Float32 -a_nodata nan",
        "-mo AREA_OR_POINT=Point",
        "-co INTERLEAVE=BAND -co BLOCKYSIZE=1",
        "-of COG",
    };
    for (const char* way : ways) {
        SCOPED_TRACE(way);
        const Workshop shop;
        shop.run("gdal_translate " + std::string(way) + " " + kTerrain + " out.tif");
        const api::Terrain terrain = read_tiff(shop.read("out.tif"));
        EXPECT_EQ(terrain.crs, "EPSG:32616");
        expect_same(terrain.mesh, posts_by_gdal(shop.path("out.tif")), 0.0, 200);
    }
}

TEST(Rasters, OfPicturesAreRefused) {
    const Workshop shop;
    shop.run("gdal_translate -ot Byte -co COMPRESS=JPEG " + kTerrain + " out.tif");
    const auto terrain = api::read_geotiff(shop.read("out.tif"), {}, {});
    ASSERT_FALSE(terrain);
    EXPECT_EQ(terrain.faults()[0].code, "TIFF_COMPRESSION");
    EXPECT_NE(terrain.faults()[0].detail.find("JPEG"), std::string::npos);
}

/// A tile as wide as the raster is no strip: it is whole where the raster ends.
TEST(Rasters, OfTilesAsWideAsTheRaster) {
    const Workshop shop;
    shop.run(
        "gdal_translate -srcwin 0 0 256 100 -co COMPRESS=DEFLATE -co TILED=YES -co "
        "BLOCKXSIZE=256 -co BLOCKYSIZE=64 " +
        kTerrain + " out.tif");
    expect_same(read_tiff(shop.read("out.tif")).mesh, posts_by_gdal(shop.path("out.tif")), 0.0, 20);
}

TEST(Rasters, WithOverviewsAndSouthUp) {
    const Workshop shop;
    shop.run("gdal_translate " + kTerrain + " in.tif && gdaladdo in.tif 2 4 8");
    expect_same(read_tiff(shop.read("in.tif")).mesh, posts_by_gdal(shop.path("in.tif")), 0.0, 200);
    shop.run("gdal_translate " + kTerrain + " up.tif");
    GDALAllRegister();
    GDALDatasetH raster = GDALOpen(shop.path("up.tif").c_str(), GA_Update);
    ASSERT_NE(raster, nullptr);
    std::array<double, 6> up{731728, 83, 0, 4004667, 0, 83};
    ASSERT_EQ(GDALSetGeoTransform(raster, up.data()), CE_None);
    GDALClose(raster);
    const api::Terrain terrain = read_tiff(shop.read("up.tif"));
    expect_same(terrain.mesh, posts_by_gdal(shop.path("up.tif")), 0.0, 200);
    EXPECT_LT(terrain.mesh.vertices.front().y, terrain.mesh.vertices.back().y);
}

TEST(Rasters, AsTextWithAllDigits) {
    for (const char* way : {"", "-co FORCE_CELLSIZE=YES -co DECIMAL_PRECISION=3",
                            "-ot Float64 -co SIGNIFICANT_DIGITS=17"}) {
        SCOPED_TRACE(way);
        const Workshop shop;
        shop.run("gdal_translate -of AAIGrid " + std::string(way) + " " + kTerrain + " out.asc");
        api::TerrainOptions options;
        options.crs = "EPSG:32616";
        const auto terrain =
            api::meshed(api::read_ascii_grid(shop.read("out.asc"), options, {}), {});
        ASSERT_TRUE(terrain) << terrain.faults()[0].detail;
        EXPECT_EQ(terrain->crs, "EPSG:32616");
        expect_same(terrain->mesh, posts_by_gdal(shop.path("out.asc")), 1e-4, 200);
    }
}

TEST(Rasters, OfDegreesAreWarpedAsByGdalwarp) {
    const Workshop shop;
    shop.run("gdalwarp -t_srs EPSG:4326 -r cubic " + kTerrain + " degrees.tif");
    for (const auto& [project, target] : {std::pair{"auto", "EPSG:32616"},
                                          {"EPSG:32617", "EPSG:32617"},
                                          {"EPSG:5070", "EPSG:5070"}}) {
        SCOPED_TRACE(project);
        shop.run(
            "gdalwarp -overwrite -r bilinear -et 0 -ot Float64 -srcnodata -9999 -dstnodata "
            "-9999 -t_srs " +
            std::string(target) + " degrees.tif there.tif");
        api::TerrainOptions options;
        options.project = project;
        const api::Terrain terrain = read_tiff(shop.read("degrees.tif"), options);
        EXPECT_EQ(terrain.crs, target);
        const Posts posts = posts_by_gdal(shop.path("there.tif"));
        expect_same(terrain.mesh, posts, 1e-6, 400);
    }
}

/// What others have made: see fetch_rasters.sh.
class RastersOfOthers : public ::testing::Test {
  protected:
    static std::string folder() {
        static const std::string where = [] {
            const std::string to = std::filesystem::temp_directory_path() / "tinsmith-rasters";
            const Workshop shop;
            shop.run("bash " TINSMITH_SOURCE_DIR "/tests/gdal/fetch_rasters.sh '" + to + "'");
            return to + "/";
        }();
        return where;
    }
    static std::string bytes_of(const std::string& name) {
        std::ifstream in(folder() + name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    /// Size, least and greatest elevation as gdalinfo has them.
    static void expect_gdalinfo(const std::string& name, const api::Terrain& terrain) {
        const Workshop shop;
        const std::string said = shop.run("gdalinfo -mm " + folder() + name);
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (const core::Point3& p : terrain.mesh.vertices) {
            low = std::min(low, p.z);
            high = std::max(high, p.z);
        }
        std::array<char, 80> line{};
        std::snprintf(line.data(), line.size(), "Computed Min/Max=%.3f,%.3f", low, high);
        EXPECT_NE(said.find(line.data()), std::string::npos) << line.data() << "\n" << said;
    }
};

TEST_F(RastersOfOthers, OlindaInUtm25South) {
    const api::Terrain terrain = read_tiff(bytes_of("olinda_dem_utm25s.tif"));
    expect_same(terrain.mesh, posts_by_gdal(folder() + "olinda_dem_utm25s.tif"), 0.0, 0);
    expect_gdalinfo("olinda_dem_utm25s.tif", terrain);
    EXPECT_EQ(terrain.mesh.vertices.size(), 111U * 111U);
    EXPECT_EQ(terrain.unit, "metre");
}

TEST_F(RastersOfOthers, TheMeuseFloodPlain) {
    const api::Terrain terrain = read_tiff(bytes_of("meuse.tif"));
    expect_same(terrain.mesh, posts_by_gdal(folder() + "meuse.tif"), 0.0, 20);
    expect_gdalinfo("meuse.tif", terrain);
}

TEST_F(RastersOfOthers, LuxembourgInDegrees) {
    const auto refused = api::read_geotiff(bytes_of("elev.tif"), {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.faults()[0].code, "CRS_GEOGRAPHIC");
    api::TerrainOptions options;
    options.project = "auto";
    const api::Terrain terrain = read_tiff(bytes_of("elev.tif"), options);
    EXPECT_EQ(terrain.crs, "EPSG:32632");
    const Workshop shop;
    shop.run("gdalwarp -r bilinear -et 0 -ot Float64 -t_srs EPSG:32632 " + folder() +
             "elev.tif there.tif");
    expect_same(terrain.mesh, posts_by_gdal(shop.path("there.tif")), 1e-6, 100);
    for (const core::Point3& p : terrain.mesh.vertices) {
        EXPECT_GE(p.z, 141.0);
        EXPECT_LE(p.z, 547.0);
    }
}

TEST_F(RastersOfOthers, NumbersThatAreNoneInDegrees) {
    api::TerrainOptions options;
    options.project = "EPSG:3413";  // the raster's corner is the North Pole
    const auto polar = api::read_geotiff(bytes_of("na.tif"), {}, options);
    EXPECT_TRUE(polar) << polar.faults()[0].detail;
    options.project = "auto";
    EXPECT_EQ(api::read_geotiff(bytes_of("na.tif"), {}, options).faults().at(0).code,
              "PROJECT_POLAR");
}

TEST_F(RastersOfOthers, WhatIsNoTerrainIsRefusedByName) {
    EXPECT_EQ(api::read_geotiff(bytes_of("geomatrix.tif"), {}).faults().at(0).code, "TIFF_ROTATED");
    EXPECT_EQ(api::read_geotiff(bytes_of("L7_ETMs.tif"), {}).faults().at(0).code, "TIFF_BANDS");
}

}  // namespace
}  // namespace tinsmith
