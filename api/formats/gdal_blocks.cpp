// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gdal_blocks.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <utility>

#include <gdal.h>

#include "api/formats/deflated.hpp"
#include "api/formats/tiff_head.hpp"

namespace tinsmith::api {
namespace {

/// Those whose decoders fill a block or say that there is not enough. JPEG's gives what its frame
/// holds, however small that is.
constexpr std::array<std::string_view, 8> kCodings{"LZW",  "DEFLATE", "PACKBITS",     "LZMA",
                                                   "ZSTD", "LERC",    "LERC_DEFLATE", "LERC_ZSTD"};

std::string_view item_of(GDALMajorObjectH object, const char* name, const char* domain) {
    const char* const text = GDALGetMetadataItem(object, name, domain);
    return text == nullptr ? std::string_view() : std::string_view(text);
}

std::optional<std::uint64_t> number_of(std::string_view text) {
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

/// How a band's pixels are laid out in blocks.
class Blocks {
  public:
    Blocks(std::string_view bytes, GDALRasterBandH band)
        : bytes_(bytes), band_(band), rows_(GDALGetRasterBandYSize(band)) {
        GDALGetBlockSize(band, &block_width_, &block_height_);
        const auto directory = number_of(item_of(band, "IFD_OFFSET", "TIFF"));
        is_tiled_ =
            directory && tiff_is_tiled(bytes, *directory, static_cast<std::uint64_t>(block_width_));
        bits_ = number_of(item_of(band, "NBITS", "IMAGE_STRUCTURE"))
                    .value_or(static_cast<std::uint64_t>(
                        GDALGetDataTypeSizeBits(GDALGetRasterDataType(band))));
    }

    /// The first that the file has no data for.
    std::optional<std::string> find_missing() const {
        std::optional<std::string> missing;
        for_each([&](std::string& name, int /*row*/) {
            if (!item_of(band_, ("BLOCK_OFFSET_" + name).c_str(), "TIFF").empty()) return true;
            missing = std::move(name);
            return false;
        });
        return missing;
    }

    /// The first that does not inflate to its size.
    std::optional<BadCoding> find_of_other_size(const std::function<bool()>& may_go_on) const {
        std::optional<BadCoding> found;
        for_each([&](std::string& name, int row) {
            const bool is_stopped = !may_go_on();
            if (!is_stopped && is_of_its_size(name, row)) return true;
            found = BadCoding{{}, std::move(name), is_stopped};
            return false;
        });
        return found;
    }

  private:
    /// Calls visit("column_row", row) for all, row by row, until it gives false.
    template <typename Visit>
    void for_each(const Visit& visit) const {
        const int across = (GDALGetRasterBandXSize(band_) + block_width_ - 1) / block_width_;
        const int down = (rows_ + block_height_ - 1) / block_height_;
        for (int y = 0; y < down; ++y) {
            for (int x = 0; x < across; ++x) {
                std::string name = std::to_string(x) + "_" + std::to_string(y);
                if (!visit(name, y)) return;
            }
        }
    }

    /// Where the file has no data for a block there is none to be wrong.
    bool is_of_its_size(const std::string& name, int row) const {
        const auto offset = number_of(item_of(band_, ("BLOCK_OFFSET_" + name).c_str(), "TIFF"));
        const auto size = number_of(item_of(band_, ("BLOCK_SIZE_" + name).c_str(), "TIFF"));
        if (!offset || !size) return !offset && !size;
        if (*offset > bytes_.size() || *size > bytes_.size() - *offset) return false;
        return inflates_to(bytes_.substr(*offset, *size), bytes_of_row() * rows_of(row));
    }

    std::uint64_t bytes_of_row() const {
        return (static_cast<std::uint64_t>(block_width_) * bits_ + 7) / 8;
    }

    /// Tiles are whole, strips end with the raster.
    std::uint64_t rows_of(int row) const {
        const int left = rows_ - row * block_height_;
        return static_cast<std::uint64_t>(is_tiled_ ? block_height_
                                                    : std::min(block_height_, left));
    }

    std::string_view bytes_;
    GDALRasterBandH band_;
    int rows_;
    int block_width_ = 1;
    int block_height_ = 1;
    bool is_tiled_ = false;
    std::uint64_t bits_ = 0;
};

}  // namespace

std::optional<std::string> find_missing_block(void* band) {
    return Blocks({}, band).find_missing();
}

std::optional<BadCoding> find_bad_coding(std::string_view bytes, void* band,
                                         const std::function<bool()>& may_go_on) {
    const std::string_view coding =
        item_of(GDALGetBandDataset(band), "COMPRESSION", "IMAGE_STRUCTURE");
    if (coding.empty()) return std::nullopt;
    if (std::ranges::find(kCodings, coding) == kCodings.end())
        return BadCoding{std::string(coding), {}};
    if (coding != "DEFLATE") return std::nullopt;
    return Blocks(bytes, band).find_of_other_size(may_go_on);
}

}  // namespace tinsmith::api
