// SPDX-License-Identifier: Apache-2.0
// Rasters by GDAL, of which only the driver for GeoTIFF is let at the bytes.
#include "api/formats/geotiff.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include <cpl_conv.h>
#include <gdal.h>
#include <ogr_srs_api.h>

#include "api/crs.hpp"
#include "api/formats/gdal_blocks.hpp"
#include "api/formats/gdal_scope.hpp"
#include "api/formats/grid_mesh.hpp"
#include "api/formats/json_reader.hpp"
#include "api/formats/raster_warp.hpp"
#include "api/formats/tiff_head.hpp"
#include "api/projection.hpp"
#include "api/terrain_system.hpp"

namespace tinsmith::api {

namespace {

/// GDAL makes an object of some kilobytes for each band before anybody can ask how many there are.
constexpr std::uint64_t kMostBandsOpened = 64;

std::string too_many_bands(std::uint64_t bands) {
    return "The raster has " + std::to_string(bands) +
           " bands, and one of elevations is needed. Pick it, for example with: gdal_translate -b "
           "1 "
           "in.tif out.tif";
}

/// A block of a raster is held decoded: one may be larger than the raster, not without bound.
constexpr std::size_t kSmallestBlockLimit = std::size_t{4096} * 4096;
/// All blocks together may have so many times the raster's pixels: a column of one pixel in wide
/// tiles, each the same few bytes of the file, would be decoded for hours.
constexpr std::uint64_t kMostInBlocks = 4;

struct Refused {
    FaultKind kind;
    Fault fault;
};

Refused refused(FaultKind kind, std::string code, std::string detail) {
    return {kind, {std::move(code), std::move(detail), ""}};
}

struct CloseDataset {
    void operator()(GDALDatasetH dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<void, CloseDataset>;

/// Reads one open raster into a grid and a Terrain; each step may refuse.
class Raster {
  public:
    Raster(std::string_view bytes, GDALDatasetH dataset, const TerrainOptions& options,
           const ReadLimits& limits, GdalScope& messages)
        : bytes_(bytes),
          dataset_(dataset),
          options_(options),
          limits_(limits),
          messages_(messages),
          width_(static_cast<std::size_t>(GDALGetRasterXSize(dataset))),
          height_(static_cast<std::size_t>(GDALGetRasterYSize(dataset))) {}

    Parsed<Terrain> read() {
        using Step = std::optional<Refused> (Raster::*)();
        for (const Step step : {&Raster::check_size, &Raster::check_band, &Raster::read_place,
                                &Raster::read_crs, &Raster::read_elevations}) {
            if (auto no = (this->*step)()) return {no->kind, std::move(no->fault)};
        }
        if (!settled_.warp_from.empty()) {
            auto warped = warp_grid(grid_, settled_.warp_from, settled_.crs, limits_);
            if (!warped) return {warped.kind(), std::move(warped.faults())};
            grid_ = *std::move(warped);
        }
        terrain_.grid = std::move(grid_);
        return std::move(terrain_);
    }

  private:
    std::optional<Refused> check_size();
    std::optional<Refused> check_band();
    std::optional<Refused> read_place();
    std::optional<Refused> read_crs();
    std::optional<Refused> read_system(OGRSpatialReferenceH srs, SystemSaid& said) const;
    std::optional<Refused> read_elevation_unit(OGRSpatialReferenceH srs, SystemSaid& said) const;
    std::optional<Refused> read_elevations();
    std::optional<Refused> check_coding() const;
    std::optional<Refused> check_blocks() const;
    bool has_mask() const;
    CPLErr mask_rows(int row, int rows, double* elevations);
    std::optional<Refused> convert();
    std::array<double, 2> no_data_values() const;

    std::string_view bytes_;
    GDALDatasetH dataset_;
    const TerrainOptions& options_;
    const ReadLimits& limits_;
    GdalScope& messages_;
    std::size_t width_;
    std::size_t height_;
    GDALRasterBandH band_ = nullptr;
    std::optional<double> no_data_;
    SystemSettled settled_;
    Grid grid_;
    Terrain terrain_;
};

std::optional<Refused> Raster::check_size() {
    if (width_ > limits_.max_vertices / height_) {
        return refused(FaultKind::TooLarge, "TOO_MANY_VERTICES",
                       "The raster is " + std::to_string(width_) + " by " +
                           std::to_string(height_) + " pixels; at most " +
                           std::to_string(limits_.max_vertices) + " are taken here.");
    }
    return std::nullopt;
}

std::optional<Refused> Raster::check_band() {
    if (const int bands = GDALGetRasterCount(dataset_); bands != 1)
        return refused(FaultKind::Unsupported, "TIFF_BANDS",
                       too_many_bands(static_cast<std::uint64_t>(std::max(bands, 0))));
    band_ = GDALGetRasterBand(dataset_, 1);
    const GDALDataType type = GDALGetRasterDataType(band_);
    if (GDALDataTypeIsComplex(type) != 0 || type == GDT_Int64 || type == GDT_UInt64) {
        return refused(FaultKind::Unsupported, "TIFF_DATA_TYPE",
                       "Elevations are integers of 8 to 32 bits or real numbers; these are " +
                           std::string(GDALGetDataTypeName(type)) + ".");
    }
    int block_width = 0;
    int block_height = 0;
    GDALGetBlockSize(band_, &block_width, &block_height);
    const auto across = static_cast<std::uint64_t>(std::max(block_width, 1));
    const auto down = static_cast<std::uint64_t>(std::max(block_height, 1));
    const std::uint64_t block = across * down;
    const std::uint64_t all =
        (width_ + across - 1) / across * ((height_ + down - 1) / down) * block;
    const std::uint64_t pixels = std::max<std::uint64_t>(width_ * height_, kSmallestBlockLimit);
    if (block > std::max(limits_.max_vertices, kSmallestBlockLimit) ||
        all / kMostInBlocks > pixels) {
        return refused(FaultKind::TooLarge, "TIFF_BLOCK_SIZE",
                       "The raster of " + std::to_string(width_) + " by " +
                           std::to_string(height_) + " pixels is stored in tiles of " +
                           std::to_string(block) + " pixels each; no more than " +
                           std::to_string(kSmallestBlockLimit) +
                           " are taken here, nor so many that are mostly outside of the raster.");
    }
    int has_no_data = 0;
    const double no_data = GDALGetRasterNoDataValue(band_, &has_no_data);
    if (has_no_data != 0) no_data_ = no_data;
    return std::nullopt;
}

std::optional<Refused> Raster::read_place() {
    // x = t[0] + column * t[1] + row * t[2]; y = t[3] + column * t[4] + row * t[5], from corners
    // of pixels. GDAL has shifted a PixelIsPoint raster so that this holds for both conventions.
    std::array<double, 6> t{};
    if (GDALGetGeoTransform(dataset_, t.data()) != CE_None) {
        return refused(FaultKind::Invalid, "TIFF_NOT_GEOREFERENCED",
                       "The raster does not say where it lies: it has no tie point and pixel "
                       "size, nor a transformation.");
    }
    if (t[2] != 0.0 || t[4] != 0.0) {
        return refused(FaultKind::Unsupported, "TIFF_ROTATED",
                       "The raster is rotated against its coordinates. Turn it north up, for "
                       "example with: gdalwarp in.tif out.tif");
    }
    grid_.origin = {t[0] + 0.5 * t[1], t[3] + 0.5 * t[5]};
    grid_.dx = t[1];
    grid_.dy = t[5];
    grid_.columns = width_;
    grid_.rows = height_;
    return std::nullopt;
}

std::optional<Refused> Raster::read_crs() {
    SystemSaid said;
    OGRSpatialReferenceH srs = GDALGetSpatialRef(dataset_);
    if (srs != nullptr) {
        if (auto no = read_system(srs, said)) return no;
    }
    if (auto no = read_elevation_unit(srs, said)) return no;
    auto settled = reconcile_system(said, options_, [&]() -> std::variant<std::string, NoPlace> {
        const std::string from = said.source.empty() ? options_.crs : said.source;
        return utm_zone_of(grid_, from);
    });
    if (!settled) return Refused{settled.kind(), std::move(settled.faults().front())};
    settled_ = *std::move(settled);
    terrain_.crs = settled_.crs;
    terrain_.unit = settled_.unit;
    terrain_.settled = true;
    return std::nullopt;
}

std::optional<Refused> Raster::read_system(OGRSpatialReferenceH srs, SystemSaid& said) const {
    said.geographic = OSRIsGeographic(srs) != 0;
    if (!said.geographic && OSRIsProjected(srs) == 0 && OSRIsLocal(srs) == 0) {
        return refused(FaultKind::Unsupported, "CRS_UNFIT",
                       "The raster's coordinates are neither projected nor geographic. Project it "
                       "first, for example with: gdalwarp -t_srs EPSG:32633 in.tif out.tif (with "
                       "the zone of your place).");
    }
    said.named = true;
    // Of a compound system the plan part counts: elevations have no name of their own here.
    const char* const part = said.geographic ? "GEOGCS" : "PROJCS";
    const char* const authority = OSRGetAuthorityName(srs, part);
    const char* const code = OSRGetAuthorityCode(srs, part);
    if (authority != nullptr && code != nullptr)
        said.crs = normalise_crs(std::string(authority) + ":" + code).value_or("");
    said.source = said.crs;
    char* name = nullptr;
    if (!said.geographic) said.plan_metres = OSRGetLinearUnits(srs, &name);
    if (!said.source.empty()) return std::nullopt;
    char* wkt = nullptr;
    const std::array<const char*, 2> format{"FORMAT=WKT2_2019", nullptr};
    if (OSRExportToWktEx(srs, &wkt, format.data()) == OGRERR_NONE && wkt != nullptr)
        said.source = wkt;
    CPLFree(wkt);
    return std::nullopt;
}

/// The band may name the unit of its elevations, and a compound system theirs.
std::optional<Refused> Raster::read_elevation_unit(OGRSpatialReferenceH srs,
                                                   SystemSaid& said) const {
    const std::string name = GDALGetRasterUnitType(band_);
    if (const auto unit = normalise_unit(name)) said.elevation_metres = metres_per(*unit);
    if (!name.empty() && !said.elevation_metres) {
        return refused(FaultKind::Unsupported, "UNIT_UNKNOWN",
                       "The raster's elevations are in a unit called " + json::quoted(name) +
                           ". Known are metre, foot and US survey foot. If it is one of them, say "
                           "so, for example with: gdal_edit.py -units metre in.tif");
    }
    if (srs == nullptr || OSRIsCompound(srs) == 0) return std::nullopt;
    char* vertical_name = nullptr;
    const double vertical = OSRGetTargetLinearUnits(srs, "VERT_CS", &vertical_name);
    if (said.elevation_metres && std::fabs(*said.elevation_metres - vertical) > 1e-9) {
        return refused(FaultKind::Invalid, "CONTRADICTION",
                       "The raster's band says that elevations are in " + json::quoted(name) +
                           ", and its system that they are in a unit of " +
                           std::to_string(vertical) + " metres.");
    }
    said.elevation_metres = vertical;
    return std::nullopt;
}

std::optional<Refused> Raster::check_blocks() const {
    if (no_data_) return std::nullopt;
    const auto missing = find_missing_block(band_);
    if (!missing) return std::nullopt;
    return refused(FaultKind::Invalid, "TIFF_BLOCK_MISSING",
                   "The file holds no data for block " + *missing +
                       " (column, row) and names no no-data value.");
}

std::optional<Refused> Raster::check_coding() const {
    std::vector<GDALRasterBandH> read{band_};
    if (has_mask()) read.push_back(GDALGetMaskBand(band_));
    for (const GDALRasterBandH band : read) {
        const auto bad = find_bad_coding(
            bytes_, band, [this] { return !limits_.progress || limits_.progress(0.0); });
        if (!bad) continue;
        if (bad->is_stopped) return Refused{FaultKind::Stopped, reading_stopped()};
        if (bad->coding.empty())
            return refused(FaultKind::Invalid, "TIFF_DAMAGED",
                           "Block " + bad->block +
                               " (column, row) does not inflate to as many bytes as it has pixels "
                               "for.");
        return refused(FaultKind::Unsupported, "TIFF_COMPRESSION",
                       "The pixels are compressed by " + bad->coding +
                           ", which is for pictures. Write them without loss, for example with: "
                           "gdal_translate -co COMPRESS=DEFLATE in.tif out.tif");
    }
    return std::nullopt;
}

bool Raster::has_mask() const {
    return (GDALGetMaskFlags(band_) & GMF_PER_DATASET) != 0;
}

/// A mask inside the file says no-data too.
CPLErr Raster::mask_rows(int row, int rows, double* elevations) {
    if (!has_mask()) return CE_None;
    const auto width = GDALGetRasterXSize(dataset_);
    std::vector<GByte> mask(static_cast<std::size_t>(rows) * width_, 255);
    const CPLErr status = GDALRasterIO(GDALGetMaskBand(band_), GF_Read, 0, row, width, rows,
                                       mask.data(), width, rows, GDT_Byte, 0, 0);
    for (std::size_t i = 0; i < mask.size(); ++i) {
        if (mask[i] == 0) elevations[i] = std::numeric_limits<double>::quiet_NaN();
    }
    return status;
}

std::optional<Refused> Raster::read_elevations() {
    if (auto no = check_blocks()) return no;
    if (auto no = check_coding()) return no;
    messages_.forget();  // what was said of the reference system is no damage
    grid_.elevations.reserve(width_ * height_);
    int block_width = 0, block_height = 0;
    GDALGetBlockSize(band_, &block_width, &block_height);
    const auto width = GDALGetRasterXSize(dataset_);
    const auto height = GDALGetRasterYSize(dataset_);
    // A row of blocks at a time, so that each block is decoded once.
    const int rows_at_once = std::clamp(block_height, 1, height);
    for (int row = 0; row < height; row += rows_at_once) {
        if (limits_.progress && !limits_.progress(static_cast<double>(row) / height))
            return Refused{FaultKind::Stopped, reading_stopped()};
        const int rows = std::min(rows_at_once, height - row);
        // Only reserved, not touched, until its data is at hand: a header may promise anything.
        const std::size_t begin = grid_.elevations.size();
        grid_.elevations.resize(begin + static_cast<std::size_t>(rows) * width_);
        double* const to = grid_.elevations.data() + begin;
        CPLErr status =
            GDALRasterIO(band_, GF_Read, 0, row, width, rows, to, width, rows, GDT_Float64, 0, 0);
        if (status == CE_None) status = mask_rows(row, rows, to);
        if (status == CE_None && !messages_.complained()) continue;
        return refused(FaultKind::Invalid, "TIFF_DAMAGED",
                       "The raster cannot be read at row " + std::to_string(row) + ": " +
                           messages_.complaint());
    }
    return convert();
}

/// The values that mean no data, both the same where there is one: the value is written as text,
/// and in a band of floats -9999.9 means the nearest float, too. NaN where there is none.
std::array<double, 2> Raster::no_data_values() const {
    const double exact = no_data_.value_or(std::numeric_limits<double>::quiet_NaN());
    if (GDALGetRasterDataType(band_) != GDT_Float32) return {exact, exact};
    const double limit = std::numeric_limits<float>::max();
    return {exact, static_cast<double>(static_cast<float>(std::clamp(exact, -limit, limit)))};
}

std::optional<Refused> Raster::convert() {
    const double scale = GDALGetRasterScale(band_, nullptr);
    const double offset = GDALGetRasterOffset(band_, nullptr);
    const bool scaled = scale != 1.0 || offset != 0.0;
    const bool other_unit = settled_.elevation_factor != 1.0;
    const auto [no_data, nearest] = no_data_values();
    std::size_t wild = 0;
    std::size_t first_wild = 0;
    for (std::size_t i = 0; i < grid_.elevations.size(); ++i) {
        double& elevation = grid_.elevations[i];
        if (std::isnan(elevation) || elevation == no_data || elevation == nearest) {
            elevation = std::numeric_limits<double>::quiet_NaN();
            continue;
        }
        if (scaled) elevation = elevation * scale + offset;
        if (other_unit) elevation *= settled_.elevation_factor;
        if (std::fabs(elevation) <= kMaxCoordinate) continue;
        if (wild++ == 0) first_wild = i;
    }
    if (wild == 0) return std::nullopt;
    auto no = refused(FaultKind::Invalid, "COORDINATE_OUT_OF_RANGE",
                      std::to_string(wild) +
                          " elevations are beyond 1e9; the first is at the coordinate told. If "
                          "they mean no-data, say so, for example with: gdal_translate "
                          "-a_nodata VALUE in.tif out.tif");
    no.fault.coordinate = {grid_.origin.x + static_cast<double>(first_wild % width_) * grid_.dx,
                           grid_.origin.y + static_cast<double>(first_wild / width_) * grid_.dy};
    no.fault.index = first_wild;
    return no;
}

}  // namespace

Parsed<Terrain> read_geotiff(std::string_view bytes, const ReadLimits& limits,
                             const TerrainOptions& options) {
    if (const std::uint64_t bands = tiff_band_count(bytes); bands > kMostBandsOpened)
        return {FaultKind::Unsupported, {"TIFF_BANDS", too_many_bands(bands), ""}};
    GdalScope messages;
    const GdalMemoryFile file(bytes);
    constexpr std::array<const char*, 2> drivers{"GTiff", nullptr};
    const Dataset dataset(GDALOpenEx(file.name(),
                                     GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_INTERNAL,
                                     drivers.data(), nullptr, nullptr));
    if (dataset == nullptr) {
        return {FaultKind::Syntax,
                {"TIFF_SYNTAX",
                 "The body is no GeoTIFF that can be read: " +
                     (messages.complained() ? messages.complaint()
                                            : "it does not begin as a TIFF does."),
                 ""}};
    }
    return Raster(bytes, dataset.get(), options, limits, messages).read();
}

}  // namespace tinsmith::api
