// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace tinsmith::api {

/// The first block of the band that the file has no data for, as "column_row". GDAL reads such a
/// block as no-data, or as zeros where no-data has no value: ground at sea level that nobody
/// measured. `band`: GDAL's handle.
std::optional<std::string> find_missing_block(void* band);

/// What is wrong with how a band's pixels lie in the file.
struct BadCoding {
    std::string coding;  ///< the name of one that is not taken; empty: it is a block that is wrong
    std::string block;   ///< "column_row"
    bool is_stopped = false;
};

/// A coding that is not among those whose decoders fill every block or fail; or a deflated block
/// that does not hold exactly as many bytes as it has pixels for. libtiff takes such a block for a
/// whole one, and pixels that it did not write are what the process had in that memory before.
/// `bytes`: the file that the band is of. Cost: deflated blocks are inflated once;
/// a small file may name one block very often, so `may_go_on` is asked before each, and ends it.
std::optional<BadCoding> find_bad_coding(std::string_view bytes, void* band,
                                         const std::function<bool()>& may_go_on);

}  // namespace tinsmith::api
