// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/dem.hpp"

#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include <gdal.h>

namespace tinsmith::bench {

namespace {

struct Close {
    void operator()(GDALDatasetH dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<void, Close>;

}  // namespace

std::size_t write_dem(const std::string& path, std::size_t triangles) {
    GDALAllRegister();
    const auto rows = static_cast<int>(std::lround(std::sqrt(static_cast<double>(triangles) / 2)));
    const int columns = rows;
    const Dataset from(GDALOpen(TINSMITH_SOURCE_DIR "/tests/data/jacksboro.tif", GA_ReadOnly));
    if (!from) throw std::runtime_error("tests/data/jacksboro.tif cannot be read");
    GDALRasterBandH band = GDALGetRasterBand(from.get(), 1);
    const int width = GDALGetRasterXSize(from.get()), height = GDALGetRasterYSize(from.get());
    std::vector<float> posts(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    GDALRasterIOExtraArg bilinear;
    INIT_RASTERIO_EXTRA_ARG(bilinear);
    bilinear.eResampleAlg = GRIORA_Bilinear;
    const CPLErr read = GDALRasterIOEx(band, GF_Read, 0, 0, width, height, posts.data(), columns,
                                       rows, GDT_Float32, 0, 0, &bilinear);
    const Dataset to(GDALCreate(GDALGetDriverByName("GTiff"), path.c_str(), columns, rows, 1,
                                GDT_Float32, nullptr));
    if (read != CE_None || !to) throw std::runtime_error(path + " cannot be written");
    double place[6];
    GDALGetGeoTransform(from.get(), place);
    place[1] *= static_cast<double>(width) / columns;
    place[5] *= static_cast<double>(height) / rows;
    GDALSetGeoTransform(to.get(), place);
    GDALSetSpatialRef(to.get(), GDALGetSpatialRef(from.get()));
    if (GDALRasterIO(GDALGetRasterBand(to.get(), 1), GF_Write, 0, 0, columns, rows, posts.data(),
                     columns, rows, GDT_Float32, 0, 0) != CE_None)
        throw std::runtime_error(path + " cannot be written");
    const auto cells = static_cast<std::size_t>(rows - 1);
    return 2 * cells * cells;
}

}  // namespace tinsmith::bench
