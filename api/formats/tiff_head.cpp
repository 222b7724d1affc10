// SPDX-License-Identifier: Apache-2.0
#include "api/formats/tiff_head.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace tinsmith::api {

namespace {

constexpr std::uint64_t kSamplesPerPixel = 277;
constexpr std::uint64_t kTileWidth = 322;
constexpr std::uint64_t kShort = 3;
constexpr std::uint64_t kLong = 4;

/// Numbers of a file in its own byte order, as far as there are bytes.
class TiffNumbers {
  public:
    TiffNumbers(std::string_view bytes, bool big_endian) : bytes_(bytes), big_endian_(big_endian) {}

    std::optional<std::uint64_t> at(std::uint64_t place, std::size_t size) const {
        if (place > bytes_.size() || bytes_.size() - place < size) return std::nullopt;
        std::uint64_t number = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const std::size_t next = big_endian_ ? i : size - 1 - i;
            number = number << 8U | static_cast<unsigned char>(bytes_[place + next]);
        }
        return number;
    }

  private:
    std::string_view bytes_;
    bool big_endian_;
};

/// Bytes of a number of that type in a directory; 0: it is no whole number.
std::size_t size_of_type(std::uint64_t type) {
    switch (type) {
        case 1:
            return 1;  // BYTE
        case 3:
            return 2;  // SHORT
        case 4:
            return 4;  // LONG
        case 16:
            return 8;  // LONG8
        default:
            return 0;
    }
}

/// A TIFF or BigTIFF, by its first bytes.
class TiffFile {
  public:
    /// Nothing: it is none.
    static std::optional<TiffFile> open(std::string_view bytes) {
        const bool big_endian = bytes.starts_with("MM");
        if (!big_endian && !bytes.starts_with("II")) return std::nullopt;
        const TiffNumbers numbers(bytes, big_endian);
        const auto magic = numbers.at(2, 2);
        if (magic != 42 && magic != 43) return std::nullopt;
        return TiffFile(bytes.size(), numbers, magic == 43);
    }

    std::optional<std::uint64_t> first_directory() const {
        return numbers_.at(is_big_ ? 8 : 4, room_);
    }

    struct Entry {
        std::uint64_t tag = 0;
        std::uint64_t type = 0;
        std::uint64_t count = 0;
        std::optional<std::uint64_t>
            number;  ///< the first, where it is whole and stands right here
    };

    /// Calls visit(entry) for all entries of a directory that are there.
    template <typename Visit>
    void for_each_entry(std::uint64_t directory, const Visit& visit) const {
        const std::size_t count_size = is_big_ ? 8 : 2;
        const std::size_t entry_size = is_big_ ? 20 : 12;
        const auto count = numbers_.at(directory, count_size);
        if (!count) return;
        const std::uint64_t first = directory + count_size;
        const std::uint64_t there = std::min<std::uint64_t>(*count, (size_ - first) / entry_size);
        for (std::uint64_t i = 0; i < there; ++i) {
            const std::uint64_t place = first + i * entry_size;
            const std::uint64_t type = *numbers_.at(place + 2, 2);
            const std::size_t size = size_of_type(type);
            Entry entry{*numbers_.at(place, 2), type, *numbers_.at(place + 4, room_), {}};
            if (size > 0 && size <= room_)
                entry.number = numbers_.at(place + entry_size - room_, size);
            visit(entry);
        }
    }

  private:
    TiffFile(std::size_t size, TiffNumbers numbers, bool is_big)
        : size_(size), numbers_(numbers), is_big_(is_big), room_(is_big ? 8 : 4) {}

    std::size_t size_;
    TiffNumbers numbers_;
    bool is_big_;
    std::size_t room_;  ///< bytes of a place in the file, and of a count
};

}  // namespace

std::uint64_t tiff_band_count(std::string_view bytes) {
    const auto file = TiffFile::open(bytes);
    const auto directory = file ? file->first_directory() : std::nullopt;
    std::uint64_t most = 0;
    if (!directory) return most;
    file->for_each_entry(*directory, [&](const TiffFile::Entry& entry) {
        if (entry.tag == kSamplesPerPixel) most = std::max(most, entry.number.value_or(0));
    });
    return most;
}

bool tiff_is_tiled(std::string_view bytes, std::uint64_t directory, std::uint64_t width) {
    const auto file = TiffFile::open(bytes);
    if (!file) return false;
    std::size_t said = 0, plainly = 0;
    file->for_each_entry(directory, [&](const TiffFile::Entry& entry) {
        if (entry.tag != kTileWidth) return;
        ++said;
        const bool is_plain = entry.type == kShort || entry.type == kLong;
        if (is_plain && entry.count == 1 && entry.number == width) ++plainly;
    });
    return said == 1 && plainly == 1;
}

}  // namespace tinsmith::api
