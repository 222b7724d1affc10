// SPDX-License-Identifier: Apache-2.0
#include "tests/attack/lying_files.hpp"

#include <array>
#include <bit>
#include <map>

#include <zlib.h>

namespace tinsmith::e2e {

namespace {

/// Tags of TIFF, as its standard numbers them.
enum Tag : std::uint16_t {
    kWidth = 256,
    kLength = 257,
    kBitsPerSample = 258,
    kCompression = 259,
    kPhotometric = 262,
    kStripOffsets = 273,
    kSamplesPerPixel = 277,
    kRowsPerStrip = 278,
    kStripByteCounts = 279,
    kTileWidth = 322,
    kTileLength = 323,
    kTileOffsets = 324,
    kTileByteCounts = 325,
    kSampleFormat = 339,
    kPixelScale = 33550,
    kTiePoint = 33922,
};
constexpr std::uint32_t kDeflate = 8;

/// Pixels of a metre, the first at (1000, 2000).
constexpr std::array<double, 9> kPlace{1, 1, 0, 0, 0, 0, 1000, 2000, 0};

/// A TIFF of one image that says where it lies, all else of one number each; the data right after
/// the head of 8 bytes, then the place.
std::string tiff(const std::map<std::uint16_t, std::uint32_t>& tags, const std::string& data,
                 std::uint32_t next = 0) {
    constexpr std::uint16_t kLong = 4, kDouble = 12;
    std::string out = "II*";
    out.push_back('\0');
    const std::string padded = data + std::string(data.size() % 2, '\0');
    append_number(out, static_cast<std::uint32_t>(8 + padded.size() + sizeof kPlace));
    out += padded;
    const auto place = static_cast<std::uint32_t>(out.size());
    for (const double number : kPlace)
        append_number(out, std::bit_cast<std::uint64_t>(number));
    append_number(out, static_cast<std::uint16_t>(tags.size() + 2));
    const auto append_entry = [&out](std::uint16_t tag, std::uint16_t type, std::uint32_t count,
                                     std::uint32_t value) {
        append_number(out, tag);
        append_number(out, type);
        append_number(out, count);
        append_number(out, value);
    };
    for (const auto& [tag, value] : tags)
        append_entry(tag, kLong, 1, value);
    append_entry(kPixelScale, kDouble, 3, place);
    append_entry(kTiePoint, kDouble, 6, place + 3 * sizeof(double));
    append_number(out, next);
    return out;
}

/// Tags of elevations in floats, with what else is given.
std::map<std::uint16_t, std::uint32_t> floats(std::uint32_t width, std::uint32_t length,
                                              std::map<std::uint16_t, std::uint32_t> more) {
    std::map<std::uint16_t, std::uint32_t> tags{
        {kWidth, width},   {kLength, length},     {kBitsPerSample, 32}, {kCompression, 1},
        {kPhotometric, 1}, {kSamplesPerPixel, 1}, {kSampleFormat, 3}};
    for (const auto& [tag, value] : more)
        tags[tag] = value;
    return tags;
}

std::map<std::uint16_t, std::uint32_t> strip(std::uint32_t rows, std::uint32_t bytes) {
    return {{kStripOffsets, 8}, {kRowsPerStrip, rows}, {kStripByteCounts, bytes}};
}

std::map<std::uint16_t, std::uint32_t> tile(std::uint32_t side, std::uint32_t bytes) {
    return {{kTileWidth, side}, {kTileLength, side}, {kTileOffsets, 8}, {kTileByteCounts, bytes}};
}

std::string deflated_zeros(std::size_t count) {
    const std::string zeros(count, '\0');
    std::string packed(compressBound(static_cast<uLong>(count)), '\0');
    auto size = static_cast<uLongf>(packed.size());
    compress(reinterpret_cast<Bytef*>(packed.data()), &size,
             reinterpret_cast<const Bytef*>(zeros.data()), static_cast<uLong>(count));
    packed.resize(size);
    return packed;
}

/// Ten entities, each ten of the one before: 10^10 characters where they are put in.
std::string billion_laughs() {
    std::string xml = "<?xml version=\"1.0\"?>\n<!DOCTYPE LandXML [<!ENTITY l0 \"ha\">";
    for (int i = 1; i <= 10; ++i) {
        xml += "<!ENTITY l" + std::to_string(i) + " \"" +
               repeated("&l" + std::to_string(i - 1) + ";", 10) + "\">";
    }
    return xml + "]>\n<LandXML version=\"1.2\">&l10;</LandXML>";
}

std::string json_grid(const std::string& columns, const std::string& rows) {
    return R"({"grid":{"origin":[0,0],"cell":[1,1],"columns":)" + columns + R"(,"rows":)" + rows +
           R"(,"elevations":[1,2,3,4]}})";
}

}  // namespace

std::vector<LyingFile> lying_tiffs() {
    const std::string four(16 * 4, '\0');
    const std::string type = "image/tiff";
    std::map<std::uint16_t, std::uint32_t> compressed = strip(3000, 0);
    compressed[kCompression] = kDeflate;
    const std::string bomb = deflated_zeros(std::size_t{36'000'000});
    compressed[kStripByteCounts] = static_cast<std::uint32_t>(bomb.size());
    std::string directory_of_65535 = tiff(floats(4, 4, strip(4, 64)), four);
    const std::uint32_t directory = 8 + 64 + sizeof kPlace;
    directory_of_65535[directory] = '\xFF', directory_of_65535[directory + 1] = '\xFF';
    std::string big = "II+";
    big.push_back('\0');
    append_number(big, std::uint16_t{8});
    append_number(big, std::uint16_t{0});
    append_number(big, std::uint64_t{16});
    append_number(big, ~std::uint64_t{0});
    // Stored, and far longer than the strip: what reads it stops without having written any of it.
    auto too_long = strip(4, 0);
    too_long[kCompression] = kDeflate;
    const std::string stored =
        "\x78\x01\x01\xff\xff" + std::string(2, '\0') + std::string(65'535, '\1');
    too_long[kStripByteCounts] = static_cast<std::uint32_t>(stored.size());
    auto bands = strip(4, 64);
    bands[kSamplesPerPixel] = 46'774;
    return {
        {"46,774 bands", type, tiff(floats(4, 4, bands), four), 422, "TIFF_BANDS"},
        {"4e9 by 4e9 pixels", type, tiff(floats(4'000'000'000, 4'000'000'000, strip(4, 64)), four),
         400},
        {"2e9 by 2e9 pixels", type, tiff(floats(2'000'000'000, 2'000'000'000, strip(4, 64)), four),
         413},
        {"30,000 by 30,000 pixels of nothing", type,
         tiff(floats(30'000, 30'000, strip(30'000, 64)), four), 413},
        {"a strip of 4 GiB that is not there", type,
         tiff(floats(4, 4, strip(4, 0xFFFFFFFF)), "\1\2\3\4").substr(0, 8 + 4), 400},
        {"a strip beyond the end", type, tiff(floats(16, 16, strip(16, 1024)), four), 422,
         "TIFF_DAMAGED"},
        {"a strip that inflates to more than its pixels", type,
         tiff(floats(4, 4, too_long), stored), 422, "TIFF_DAMAGED"},
        {"a tile of 4 GiB", type, tiff(floats(4, 4, tile(32'768, 64)), four), 413},
        {"a tile of 16 EiB", type, tiff(floats(4, 4, tile(0xFFFFFFF0, 64)), four), 400},
        {"a column of one pixel in wide tiles", type,
         tiff(floats(1, 1'000'000, tile(4096, 64)), four), 413, "TIFF_BLOCK_SIZE"},
        {"a bomb of deflate beyond what is taken", type,
         tiff(floats(12'000, 12'000, compressed), bomb), 413},
        {"a directory of 65,535 entries", type, directory_of_65535, 400},
        {"a directory that goes on in itself", type,
         tiff(floats(12'000, 12'000, strip(4, 64)), four, directory), 413},
        {"BigTIFF of 2^64 entries", type, big, 400},
    };
}

std::vector<LyingFile> lying_texts() {
    const std::string json = "application/json";
    const std::string xml = "application/xml";
    const std::string grid = "text/plain";
    return {
        {"entities of entities", xml, billion_laughs(), 422},
        {"one entity ten thousand times", xml,
         "<!DOCTYPE LandXML [<!ENTITY a \"" + std::string(100'000, 'a') + "\">]><LandXML>" +
             repeated("&a;", 10'000) + "</LandXML>",
         422},
        {"an entity of a file", xml,
         "<!DOCTYPE LandXML [<!ENTITY a SYSTEM \"file:///etc/passwd\">]><LandXML>&a;</LandXML>",
         422},
        {"a zip in place of XML", xml, "PK\x03\x04" + std::string(1'000'000, '\0'), 400},
        {"an encoding that nobody knows", xml,
         "<?xml version=\"1.0\" encoding=\"x-" + std::string(1'000'000, 'y') +
             "\"?><LandXML version=\"1.2\"/>",
         422},
        {"elements 300,000 deep", xml, repeated("<a>", 300'000) + repeated("</a>", 300'000), 422},
        {"300,000 empty elements", xml, "<LandXML>" + repeated("<a/>", 300'000) + "</LandXML>",
         422},
        {"300,000 attributes", xml, "<LandXML" + repeated(" a=''", 300'000) + "/>", 422},
        {"grid of 2e9 by 2e9", grid,
         "ncols 2000000000\nnrows 2000000000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n", 413},
        {"grid of 1e30 columns", grid,
         "ncols 1e30\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n", 422},
        {"a line of 4 MB in CSV", "text/csv", std::string(4'000'000, '1'), 422},
        {"a face of 200,000 corners", "model/obj",
         "v 0 0 0\nv 1 0 0\nv 0 1 0\nf " + repeated("1 2 3 ", 66'667) + "\n", 422},
        {"JSON grid of 4e9 by 4e9", json, json_grid("4000000000", "4000000000"), 413},
        {"JSON grid of 2^32 by 2^32", json, json_grid("4294967296", "4294967296"), 422},
        {"terrain of 500,000 opening brackets", json, std::string(500'000, '['), 400},
        {"terrain of 300,000 unknown members", json,
         "{\"a\":0" + repeated(",\"a\":{}", 300'000) + "}", 422},
    };
}

}  // namespace tinsmith::e2e
