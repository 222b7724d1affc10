// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace tinsmith::api {

/// While it lives, GDAL's messages of this thread come here and not to stderr, and GDAL looks for
/// no files beside the one it is given, nor into a network. The first one makes GDAL ready, with
/// two drivers: GeoTIFF, and datasets in memory.
class GdalScope {
  public:
    GdalScope();
    GdalScope(const GdalScope&) = delete;
    GdalScope& operator=(const GdalScope&) = delete;
    ~GdalScope();

    /// GDAL's first complaint, in printable ASCII; it may quote the file's bytes.
    std::string complaint() const { return first_.empty() ? "no reason given" : first_; }
    bool complained() const { return !first_.empty(); }
    void forget() { first_.clear(); }
    /// Keeps GDAL's message where it is the first.
    void note(const char* message);

  private:
    std::string first_;
};

/// The caller's bytes under a name nobody can guess, as long as it lives. The bytes are not copied.
class GdalMemoryFile {
  public:
    explicit GdalMemoryFile(std::string_view bytes);
    GdalMemoryFile(const GdalMemoryFile&) = delete;
    GdalMemoryFile& operator=(const GdalMemoryFile&) = delete;
    ~GdalMemoryFile();

    const char* name() const { return name_.c_str(); }

  private:
    std::string name_;
};

}  // namespace tinsmith::api
