// SPDX-License-Identifier: Apache-2.0
#include "api/formats/tiff_head.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace tinsmith::api {

namespace {

constexpr std::uint64_t kSamplesPerPixel = 277;

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

}  // namespace

std::uint64_t tiff_band_count(std::string_view bytes) {
    const bool big_endian = bytes.starts_with("MM");
    if (!big_endian && !bytes.starts_with("II")) return 0;
    const TiffNumbers numbers(bytes, big_endian);
    const auto magic = numbers.at(2, 2);
    if (magic != 42 && magic != 43) return 0;
    const bool is_big = magic == 43;
    const auto directory = is_big ? numbers.at(8, 8) : numbers.at(4, 4);
    const std::size_t count_size = is_big ? 8 : 2;
    const std::size_t entry_size = is_big ? 20 : 12;
    const auto count = directory ? numbers.at(*directory, count_size) : std::nullopt;
    if (!count) return 0;
    const std::uint64_t first = *directory + count_size;
    const std::uint64_t there =
        std::min<std::uint64_t>(*count, (bytes.size() - first) / entry_size);
    std::uint64_t most = 0;
    for (std::uint64_t i = 0; i < there; ++i) {
        const std::uint64_t entry = first + i * entry_size;
        if (numbers.at(entry, 2) != kSamplesPerPixel) continue;
        const std::size_t size = size_of_type(*numbers.at(entry + 2, 2));
        const std::size_t room = is_big ? 8 : 4;
        if (size > 0 && size <= room)
            most = std::max(most, *numbers.at(entry + entry_size - room, size));
    }
    return most;
}

}  // namespace tinsmith::api
