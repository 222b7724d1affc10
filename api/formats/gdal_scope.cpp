// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gdal_scope.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <random>
#include <utility>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_vsi.h>
#include <gdal_frmts.h>
#include <ogr_srs_api.h>

#include "api/projection.hpp"

namespace tinsmith::api {

namespace {

constexpr std::array<std::pair<const char*, const char*>, 4> kOptions{{
    {"GTIFF_REPORT_COMPD_CS", "YES"},  // else the vertical unit is not told
    {"GDAL_DISABLE_READDIR_ON_OPEN", "EMPTY_DIR"},
    {"GDAL_PAM_ENABLED", "NO"},
    {"GDAL_GEOREF_SOURCES", "INTERNAL"},
}};

/// One may live within another of the same thread: the outermost takes the options back.
thread_local int depth = 0;

void CPL_STDCALL take(CPLErr level, CPLErrorNum, const char* message) {
    auto* const scope = static_cast<GdalScope*>(CPLGetErrorHandlerUserData());
    if (level >= CE_Failure && message != nullptr) scope->note(message);
}

}  // namespace

GdalScope::GdalScope() {
    static std::once_flag registered;
    std::call_once(registered, [] {
        GDALRegister_GTiff();
        GDALRegister_MEM();
        OSRSetPROJEnableNetwork(0);
        silence_proj();
    });
    CPLPushErrorHandlerEx(&take, this);
    if (depth++ > 0) return;
    for (const auto& [name, value] : kOptions)
        CPLSetThreadLocalConfigOption(name, value);
}

GdalScope::~GdalScope() {
    CPLPopErrorHandler();
    if (--depth > 0) return;
    for (const auto& [name, value] : kOptions)
        CPLSetThreadLocalConfigOption(name, nullptr);
}

void GdalScope::note(const char* message) {
    if (!first_.empty()) return;
    constexpr std::size_t longest = 200;
    first_ = std::string(message).substr(0, longest);
    // The random name of the file in memory says nothing to the caller.
    for (auto at = first_.find("/vsimem/"); at != std::string::npos; at = first_.find("/vsimem/")) {
        const auto end = first_.find_first_of(",: '\"", at);
        first_.replace(at, end == std::string::npos ? end : end - at, "the file");
    }
    for (char& c : first_) {
        if (c < ' ' || c > '~') c = '?';
    }
}

GdalMemoryFile::GdalMemoryFile(std::string_view bytes) {
    static std::atomic<std::uint64_t> count{0};
    std::random_device random;
    name_ = "/vsimem/tinsmith-" + std::to_string(random()) + "-" + std::to_string(random()) + "-" +
            std::to_string(++count) + ".tif";
    // GDAL's signature knows no const; opened for reading only, it never writes.
    auto* const data = const_cast<GByte*>(reinterpret_cast<const GByte*>(bytes.data()));  // NOLINT
    VSILFILE* const file = VSIFileFromMemBuffer(name_.c_str(), data, bytes.size(), FALSE);
    if (file != nullptr) VSIFCloseL(file);
}

GdalMemoryFile::~GdalMemoryFile() {
    VSIUnlink(name_.c_str());
}

}  // namespace tinsmith::api
