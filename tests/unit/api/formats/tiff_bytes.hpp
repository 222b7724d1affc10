// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace tinsmith::testing {

static_assert(std::endian::native == std::endian::little,
              "the bytes below are written as they are");

/// Writes a TIFF of one uncompressed strip tag by tag, so that a test can lie in any of them.
class TiffBytes {
  public:
    /// A raster of 32-bit floats without any georeference.
    TiffBytes(std::uint32_t width, std::uint32_t height, const std::vector<float>& pixels)
        : data_(bytes_of(pixels)) {
        set_long(256, width);
        set_long(257, height);
        set_short(258, 32);  // bits
        set_short(259, 1);   // not compressed
        set_short(262, 1);   // black is zero
        set_short(277, 1);   // samples
        set_long(278, height);
        set_long(279, static_cast<std::uint32_t>(data_.size()));
        set_short(339, 3);  // IEEE floating point
    }

    /// The strip as it is in the file, by a compression of that number.
    TiffBytes& coded(std::uint16_t compression, std::string data) {
        data_ = std::move(data);
        set_long(279, static_cast<std::uint32_t>(data_.size()));
        return set_short(259, compression);
    }

    /// The upper left corner of the first pixel, or its centre with `pixel_is_point`.
    TiffBytes& place(double x, double y, double dx, double dy, bool pixel_is_point = false) {
        set_doubles(33550, {dx, dy, 0});
        set_doubles(33922, {0, 0, 0, x, y, 0});
        raster_type_ = pixel_is_point ? 2 : 1;
        return *this;
    }
    TiffBytes& transformation(const std::vector<double>& matrix) {
        set_doubles(34264, matrix);
        return *this;
    }
    TiffBytes& projected(std::uint16_t epsg) { return keys({1, 3072, epsg}); }
    TiffBytes& geographic(std::uint16_t epsg) { return keys({2, 2048, epsg}); }
    TiffBytes& vertical(std::uint16_t epsg) {
        vertical_ = epsg;
        return keys({1, 3072, 32616});
    }

    TiffBytes& set_short(std::uint16_t tag, std::uint16_t value) {
        return set(tag, 3, 1, bytes_of(std::vector<std::uint16_t>{value}));
    }
    TiffBytes& set_long(std::uint16_t tag, std::uint32_t value) {
        return set(tag, 4, 1, bytes_of(std::vector<std::uint32_t>{value}));
    }
    TiffBytes& set_doubles(std::uint16_t tag, const std::vector<double>& values) {
        return set(tag, 12, values.size(), bytes_of(values));
    }
    TiffBytes& set_shorts(std::uint16_t tag, const std::vector<std::uint16_t>& values) {
        return set(tag, 3, values.size(), bytes_of(values));
    }
    TiffBytes& set_text(std::uint16_t tag, const std::string& text) {
        return set(tag, 2, text.size() + 1, text + '\0');
    }

    /// Header, pixels, values too long for the directory, directory.
    std::string bytes() const {
        auto tags = tags_;
        std::string out("II\x2a\0\0\0\0\0", 8);
        if (!tags.contains(273)) {
            tags[273] = {4, 1, bytes_of(std::vector<std::uint32_t>{8})};  // where the strip is
        }
        out += data_;
        for (auto& [tag, entry] : tags) {
            if (entry.value.size() <= 4) {
                entry.value.resize(4, '\0');
                continue;
            }
            out.resize((out.size() + 1) / 2 * 2, '\0');
            const auto at = static_cast<std::uint32_t>(out.size());
            out += entry.value;
            entry.value = bytes_of(std::vector<std::uint32_t>{at});
        }
        out.resize((out.size() + 1) / 2 * 2, '\0');
        const auto directory = static_cast<std::uint32_t>(out.size());
        std::memcpy(out.data() + 4, &directory, 4);
        out += bytes_of(std::vector<std::uint16_t>{static_cast<std::uint16_t>(tags.size())});
        for (const auto& [tag, entry] : tags) {
            out += bytes_of(std::vector<std::uint16_t>{tag, entry.type});
            out += bytes_of(std::vector<std::uint32_t>{entry.count});
            out += entry.value;
        }
        return out + std::string(4, '\0');
    }

  private:
    struct Entry {
        std::uint16_t type = 0;
        std::uint32_t count = 0;
        std::string value;
    };

    template <typename T>
    static std::string bytes_of(const std::vector<T>& values) {
        std::string out(values.size() * sizeof(T), '\0');
        if (!values.empty()) std::memcpy(out.data(), values.data(), out.size());
        return out;
    }

    TiffBytes& set(std::uint16_t tag, std::uint16_t type, std::size_t count, std::string value) {
        tags_[tag] = {type, static_cast<std::uint32_t>(count), std::move(value)};
        return *this;
    }

    struct Keys {
        std::uint16_t model, key, value;
    };
    TiffBytes& keys(Keys keys) {
        std::vector<std::uint16_t> list{1,        1,          0,    3,         1024, 0,
                                        1,        keys.model, 1025, 0,         1,    raster_type_,
                                        keys.key, 0,          1,    keys.value};
        if (vertical_ != 0) {
            list[3] = 4;
            list.insert(list.end(), {4096, 0, 1, vertical_});
        }
        return set_shorts(34735, list);
    }

    std::string data_;
    std::uint16_t raster_type_ = 1;
    std::uint16_t vertical_ = 0;
    std::map<std::uint16_t, Entry> tags_;  ///< a directory is sorted by tag
};

}  // namespace tinsmith::testing
