// SPDX-License-Identifier: Apache-2.0
// Writing by zlib; api/formats/deflated.cpp reads by it.
#include "server/gzip.hpp"

#include <algorithm>
#include <limits>

#include <zlib.h>

namespace tinsmith::server {

namespace {

constexpr int kLevel = 1;
constexpr int kGzipWindow = 15 + 16;  ///< 32 KiB, with the frame of gzip instead of zlib's
constexpr int kMemoryLevel = 8;

/// zlib counts its input in 32 bits: larger bodies go in by pieces.
bool deflate_all(z_stream& stream, std::string_view bytes, std::string& out) {
    static constexpr std::size_t kPiece = std::size_t{1} << 30;
    int status = Z_OK;
    while (status == Z_OK) {
        const std::size_t in = std::min(bytes.size(), kPiece);
        // The library only reads through this pointer; its type is older than const.
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
        stream.avail_in = static_cast<uInt>(in);
        const std::size_t used = out.size();
        out.resize(used + std::min(deflateBound(&stream, in), kPiece));
        stream.next_out = reinterpret_cast<Bytef*>(out.data() + used);
        stream.avail_out = static_cast<uInt>(out.size() - used);
        status = deflate(&stream, in == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
        bytes.remove_prefix(in - stream.avail_in);
        out.resize(out.size() - stream.avail_out);
    }
    return status == Z_STREAM_END;
}

}  // namespace

std::optional<std::string> gzip(std::string_view bytes) {
    z_stream stream{};
    if (deflateInit2(&stream, kLevel, Z_DEFLATED, kGzipWindow, kMemoryLevel, Z_DEFAULT_STRATEGY) !=
        Z_OK) {
        return std::nullopt;
    }
    std::string out;
    bool fine = false;
    try {
        fine = deflate_all(stream, bytes, out);
    } catch (...) {
        deflateEnd(&stream);
        throw;
    }
    deflateEnd(&stream);
    return fine ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace tinsmith::server
