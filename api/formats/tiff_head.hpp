// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace tinsmith::api {

/// How many bands the first directory of a TIFF or BigTIFF says that there are (SamplesPerPixel),
/// the most where it says so more than once; 0 where it says nothing or cannot be read. For a look
/// before a library makes an object of each. Cost: linear in the directory.
/// Source: TIFF 6.0, section 2; the BigTIFF design at libtiff.gitlab.io.
std::uint64_t tiff_band_count(std::string_view bytes);

/// Whether the directory at that place says plainly, once and as a SHORT or LONG, that its raster
/// is in tiles of that width; where it says so in another way libraries differ in what they
/// believe.
bool tiff_is_tiled(std::string_view bytes, std::uint64_t directory, std::uint64_t width);

}  // namespace tinsmith::api
