// SPDX-License-Identifier: Apache-2.0
#include "api/formats/raster_warp.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include <cpl_conv.h>
#include <cpl_string.h>
#include <gdal.h>
#include <gdal_alg.h>
#include <gdalwarper.h>
#include <ogr_srs_api.h>

#include "api/crs.hpp"
#include "api/formats/gdal_scope.hpp"
#include "api/projection.hpp"

namespace tinsmith::api {

namespace {

struct CloseDataset {
    void operator()(GDALDatasetH dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<void, CloseDataset>;

struct DestroySystem {
    void operator()(OGRSpatialReferenceH system) const { OSRDestroySpatialReference(system); }
};
using System = std::unique_ptr<std::remove_pointer_t<OGRSpatialReferenceH>, DestroySystem>;

struct DestroyTransformer {
    void operator()(void* transformer) const { GDALDestroyGenImgProjTransformer(transformer); }
};
using Transformer = std::unique_ptr<void, DestroyTransformer>;

struct DestroyOptions {
    void operator()(GDALWarpOptions* options) const { GDALDestroyWarpOptions(options); }
};

struct DestroyText {
    void operator()(char** list) const { CSLDestroy(list); }
};
using TextList = std::unique_ptr<char*, DestroyText>;

System system_of(const std::string& text) {
    System system(OSRNewSpatialReference(nullptr));
    OSRSetAxisMappingStrategy(system.get(), OAMS_TRADITIONAL_GIS_ORDER);
    if (OSRSetFromUserInput(system.get(), text.c_str()) != OGRERR_NONE) return nullptr;
    return system;
}

/// The corner of the first pixel, whose centre is the first post.
std::array<double, 6> geotransform_of(const Grid& grid) {
    return {grid.origin.x - 0.5 * grid.dx, grid.dx, 0.0,
            grid.origin.y - 0.5 * grid.dy, 0.0,     grid.dy};
}

/// The grid's elevations as a dataset, not copied. Requires: they outlive it.
Dataset dataset_of(const Grid& grid, double* elevations, OGRSpatialReferenceH system) {
    const auto width = static_cast<int>(grid.columns);
    const auto height = static_cast<int>(grid.rows);
    Dataset dataset(
        GDALCreate(GDALGetDriverByName("MEM"), "", width, height, 0, GDT_Float64, nullptr));
    if (!dataset) return nullptr;
    std::array<char, 64> pointer{};
    pointer[static_cast<std::size_t>(
        CPLPrintPointer(pointer.data(), elevations, static_cast<int>(pointer.size()) - 1))] = '\0';
    const TextList options(CSLSetNameValue(nullptr, "DATAPOINTER", pointer.data()));
    auto transform = geotransform_of(grid);
    if (GDALAddBand(dataset.get(), GDT_Float64, options.get()) != CE_None ||
        GDALSetGeoTransform(dataset.get(), transform.data()) != CE_None ||
        GDALSetSpatialRef(dataset.get(), system) != CE_None)
        return nullptr;
    GDALSetRasterNoDataValue(GDALGetRasterBand(dataset.get(), 1),
                             std::numeric_limits<double>::quiet_NaN());
    return dataset;
}

int CPL_STDCALL tell(double share, const char*, void* limits) {
    const auto& progress = static_cast<const ReadLimits*>(limits)->progress;
    return progress && !progress(share) ? FALSE : TRUE;
}

/// GDAL's own frees what is in them.
template <typename T>
T* one(T value) {
    auto* const made = static_cast<T*>(CPLMalloc(sizeof(T)));
    *made = value;
    return made;
}

core::Point2 centre_of(const Grid& grid) {
    return {grid.origin.x + 0.5 * grid.dx * static_cast<double>(grid.columns - 1),
            grid.origin.y + 0.5 * grid.dy * static_cast<double>(grid.rows - 1)};
}

/// Why the raster's centre has no place in a system, or lies far outside of where that is used.
/// Nothing too where PROJ does not know `from`, which may be a description that GDAL alone reads.
std::optional<Fault> misplaced(const Grid& grid, const std::string& from, const std::string& to) {
    const auto way = Transformation::between(from, to);
    const auto* known = std::get_if<Transformation>(&way);
    if (known == nullptr) return std::nullopt;
    const auto there = (*known)(centre_of(grid));
    const auto* no = std::get_if<NoPlace>(&there);
    if (no == nullptr) return std::nullopt;
    return Fault{no->code, "The raster's centre: " + no->detail, {}};
}

Fault failed(const GdalScope& messages) {
    return {"PROJECT_FAILED",
            "The raster cannot be brought into that system: " + messages.complaint() +
                ". Try another, or warp it yourself, for example with: gdalwarp -t_srs EPSG:32633 "
                "in.tif out.tif (with the zone of your place).",
            {}};
}

}  // namespace

std::variant<std::string, NoPlace> utm_zone_of(const Grid& grid, const std::string& from) {
    const GdalScope messages;
    core::Point2 centre = centre_of(grid);
    const System own = system_of(from), degrees = system_of("OGC:CRS84");
    OGRCoordinateTransformationH way =
        own && degrees ? OCTNewCoordinateTransformation(own.get(), degrees.get()) : nullptr;
    const bool known = way != nullptr && OCTTransform(way, 1, &centre.x, &centre.y, nullptr) != 0;
    OCTDestroyCoordinateTransformation(way);
    if (known) return utm_zone_at("OGC:CRS84", centre);
    return NoPlace{"PROJECT_FAILED",
                   "Where the raster's centre lies cannot be said: " + messages.complaint() +
                       ". Name a system, such as project=EPSG:32633."};
}

Parsed<Grid> warp_grid(const Grid& grid, const std::string& from, const std::string& to,
                       const ReadLimits& limits) {
    const GdalScope messages;
    if (auto fault = misplaced(grid, from, to)) return {FaultKind::Invalid, *std::move(fault)};
    const System source = system_of(from), target = system_of(to);
    if (!source || !target) return {FaultKind::Invalid, failed(messages)};
    // Read only: GDAL's signature knows no const.
    const Dataset old =
        dataset_of(grid, const_cast<double*>(grid.elevations.data()), source.get());  // NOLINT
    if (!old) return {FaultKind::Invalid, failed(messages)};

    char* wkt = nullptr;
    OSRExportToWkt(target.get(), &wkt);
    TextList how(CSLSetNameValue(nullptr, "DST_SRS", wkt));
    how.reset(CSLSetNameValue(how.release(), "ALLOW_BALLPARK", "NO"));
    CPLFree(wkt);
    Transformer transformer(GDALCreateGenImgProjTransformer2(old.get(), nullptr, how.get()));
    std::array<double, 6> place{};
    std::array<double, 4> extent{};
    int width = 0, height = 0;
    if (!transformer ||
        GDALSuggestedWarpOutput2(old.get(), &GDALGenImgProjTransform, transformer.get(),
                                 place.data(), &width, &height, extent.data(), 0) != CE_None ||
        width < 1 || height < 1)
        return {FaultKind::Invalid, failed(messages)};

    Grid out;
    out.columns = static_cast<std::size_t>(width);
    out.rows = static_cast<std::size_t>(height);
    if (out.columns > limits.max_vertices / out.rows) {
        return {FaultKind::TooLarge,
                {"TOO_MANY_VERTICES",
                 "In that system the raster would be " + std::to_string(width) + " by " +
                     std::to_string(height) + " pixels; at most " +
                     std::to_string(limits.max_vertices) + " are taken here.",
                 {}}};
    }
    out.origin = {place[0] + 0.5 * place[1], place[3] + 0.5 * place[5]};
    out.dx = place[1];
    out.dy = place[5];
    out.elevations.assign(out.columns * out.rows, std::numeric_limits<double>::quiet_NaN());
    const Dataset made = dataset_of(out, out.elevations.data(), target.get());
    if (!made) return {FaultKind::Invalid, failed(messages)};
    GDALSetGenImgProjTransformerDstGeoTransform(transformer.get(), place.data());

    const std::unique_ptr<GDALWarpOptions, DestroyOptions> options(GDALCreateWarpOptions());
    options->eResampleAlg = GRA_Bilinear;
    options->eWorkingDataType = GDT_Float64;
    options->hSrcDS = old.get();
    options->hDstDS = made.get();
    options->nBandCount = 1;
    options->panSrcBands = one(1);
    options->panDstBands = one(1);
    options->padfSrcNoDataReal = one(std::numeric_limits<double>::quiet_NaN());
    options->padfDstNoDataReal = one(std::numeric_limits<double>::quiet_NaN());
    options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "INIT_DEST", "NO_DATA");
    options->pfnTransformer = &GDALGenImgProjTransform;
    options->pTransformerArg = transformer.get();
    options->pfnProgress = &tell;
    options->pProgressArg = const_cast<ReadLimits*>(&limits);  // NOLINT: read only
    GDALWarpOperationH operation = GDALCreateWarpOperation(options.get());
    const bool done =
        operation != nullptr && GDALChunkAndWarpImage(operation, 0, 0, width, height) == CE_None;
    if (operation != nullptr) GDALDestroyWarpOperation(operation);
    if (limits.progress && !limits.progress(1.0)) return {FaultKind::Stopped, reading_stopped()};
    if (!done) return {FaultKind::Invalid, failed(messages)};
    return out;
}

}  // namespace tinsmith::api
