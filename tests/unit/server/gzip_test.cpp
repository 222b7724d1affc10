// SPDX-License-Identifier: Apache-2.0
#include "server/gzip.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

namespace tinsmith::server {
namespace {

std::string gunzip(std::string bytes, std::size_t size) {
    std::string out(size + 1, '\0');
    z_stream stream{};
    EXPECT_EQ(inflateInit2(&stream, 15 + 16), Z_OK);
    stream.next_in = reinterpret_cast<Bytef*>(bytes.data());
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
    EXPECT_EQ(stream.avail_in, 0U) << "one member and nothing after it";
    out.resize(out.size() - stream.avail_out);
    inflateEnd(&stream);
    return out;
}

TEST(Gzip, ComesBackAsItWas) {
    std::string noise;
    std::uint32_t state = 1;
    for (int i = 0; i < 300'000; ++i) {
        state = state * 1664525U + 1013904223U;
        noise.push_back(static_cast<char>(state >> 24));
    }
    for (const std::string& text :
         {std::string(), std::string("a"), std::string(5'000'000, 'x'), noise}) {
        const auto coded = gzip(text);
        ASSERT_TRUE(coded);
        EXPECT_TRUE(gunzip(*coded, text.size()) == text) << text.size();
        EXPECT_EQ(gzip(text), coded) << "the same bytes every time";
    }
}

}  // namespace
}  // namespace tinsmith::server
