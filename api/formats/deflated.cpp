// SPDX-License-Identifier: Apache-2.0
#include "api/formats/deflated.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include <zlib.h>

namespace tinsmith::api {
namespace {

/// zlib's state for reading, given back at the end.
class Inflater {
  public:
    Inflater() { is_ready_ = inflateInit(&stream_) == Z_OK; }
    ~Inflater() {
        if (is_ready_) inflateEnd(&stream_);
    }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;

    bool holds_exactly(std::string_view deflated, std::uint64_t size) {
        // Written before anybody reads; a file may have a million blocks.
        // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init)
        std::array<Bytef, std::size_t{1} << 15> scratch;
        std::uint64_t made = 0;
        // Ends: each call takes input or makes output, or it is the last.
        for (int status = is_ready_ ? Z_OK : Z_MEM_ERROR; status == Z_OK && made <= size;) {
            if (stream_.avail_in == 0) feed(deflated);
            stream_.next_out = scratch.data();
            stream_.avail_out = static_cast<uInt>(scratch.size());
            status = inflate(&stream_, Z_NO_FLUSH);
            made += scratch.size() - stream_.avail_out;
            if (status == Z_STREAM_END) return made == size;
        }
        return false;
    }

  private:
    void feed(std::string_view& deflated) {
        const std::size_t some =
            std::min<std::size_t>(deflated.size(), std::numeric_limits<uInt>::max());
        // zlib writes to its input only if it is told so.
        stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(deflated.data()));
        stream_.avail_in = static_cast<uInt>(some);
        deflated.remove_prefix(some);
    }

    z_stream stream_{};
    bool is_ready_ = false;
};

}  // namespace

bool inflates_to(std::string_view deflated, std::uint64_t size) {
    return Inflater().holds_exactly(deflated, size);
}

}  // namespace tinsmith::api
