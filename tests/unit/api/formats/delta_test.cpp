// SPDX-License-Identifier: Apache-2.0
#include "api/formats/delta.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace tinsmith::api {
namespace {

/// Four vertices become five, six triangles become four; an old slot of each is written.
MeshDelta sample() {
    MeshDelta delta;
    delta.from = 3;
    delta.to = 5;
    delta.old_vertices = 4;
    delta.old_triangles = 6;
    delta.new_vertices = 5;
    delta.new_triangles = 4;
    delta.vertex_runs = {{1, 1}, {4, 1}};
    delta.triangle_runs = {{2, 2}};
    delta.vertices = {{1.5, -0.0, 3}, {0.1, 5e6, -7}};
    delta.triangles = {{0, 1, 4}, {1, 2, 3}};
    return delta;
}

bool is_refused(const std::string& bytes, const std::string& why) {
    const auto read = read_delta(bytes);
    return !read && read.faults().front().detail.find(why) != std::string::npos;
}

void set(std::string& bytes, std::size_t offset, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i)
        bytes[offset + i] = static_cast<char>(static_cast<unsigned char>(value >> (8 * i)));
}

TEST(Delta, LiesInItsBytesAsDescribed) {
    const std::string bytes = write_delta(sample());
    EXPECT_EQ(bytes.size(), 48U + 3 * 8 + 2 * 24 + 2 * 12);
    EXPECT_EQ(bytes.size(), delta_bytes({2, 2, 1, 2}));
    EXPECT_EQ(bytes.substr(0, 8), std::string("TNDL\1\0\0\0", 8));
    EXPECT_EQ(bytes.substr(8, 9), std::string("\3\0\0\0\0\0\0\0\5", 9));
    EXPECT_EQ(bytes.substr(40, 8), std::string("\2\0\0\0\1\0\0\0", 8));
    EXPECT_EQ(bytes.substr(72, 8), std::string("\0\0\0\0\0\0\xf8\x3f", 8)) << "1.5";
}

TEST(Delta, ReadsBackWhatWasWritten) {
    const MeshDelta delta = sample();
    const auto read = read_delta(write_delta(delta));
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(read->vertex_runs, delta.vertex_runs);
    EXPECT_EQ(read->triangle_runs, delta.triangle_runs);
    EXPECT_EQ(read->triangles, delta.triangles);
    EXPECT_TRUE(std::signbit(read->vertices[0].y));
    EXPECT_EQ(write_delta(*read), write_delta(delta));
}

TEST(Delta, RefusesEveryLengthButItsOwn) {
    const std::string bytes = write_delta(sample());
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_FALSE(read_delta(std::string_view(bytes).substr(0, size)).ok()) << size;
    EXPECT_TRUE(is_refused(bytes + '\0', "another length"));
}

TEST(Delta, RefusesWhatBreaksALaw) {
    const std::string good = write_delta(sample());
    const auto with = [&good](std::size_t offset, std::uint32_t value) {
        std::string bytes = good;
        set(bytes, offset, value);
        return bytes;
    };
    EXPECT_TRUE(is_refused(with(0, 0), "begin with"));
    EXPECT_TRUE(is_refused(with(4, 2), "format version"));
    EXPECT_TRUE(is_refused(with(4, 1 | 2 << 16), "flags"));
    EXPECT_TRUE(is_refused(with(8, 9), "earlier version"));
    EXPECT_TRUE(is_refused(with(40, UINT32_MAX), "within its runs"));
    EXPECT_TRUE(is_refused(with(48, 5), "out of range")) << "first beyond the count";
    EXPECT_TRUE(is_refused(with(48, 3), "out of order")) << "touches the next";
    EXPECT_TRUE(is_refused(with(52, 0), "out of order")) << "empty";
    EXPECT_TRUE(is_refused(with(24, 3), "leave slots out")) << "slot 3 is new by then";
    EXPECT_TRUE(is_refused(with(4, 1 | 1 << 16), "leave slots out")) << "no whole";
    EXPECT_TRUE(is_refused(with(120, 5), "corner"));
    EXPECT_TRUE(is_refused(with(76, 0x7ff00000), "not finite"));
}

TEST(Delta, TakesNoMemoryOnTheWordOfACount) {
    std::string bytes = write_delta(sample());
    set(bytes, 32, UINT32_MAX);
    EXPECT_FALSE(read_delta(bytes).ok());
    ReadLimits few;
    few.max_vertices = 4;
    EXPECT_EQ(read_delta(write_delta(sample()), few).kind(), FaultKind::TooLarge);
}

TEST(Delta, IsAsGoodInJson) {
    EXPECT_EQ(write_delta_json(sample()),
              R"({"from":3,"to":5,"whole":false,"vertex_count":{"old":4,"new":5},)"
              R"("triangle_count":{"old":6,"new":4},)"
              R"("vertices":[{"first":1,"positions":[[1.5,-0.0,3]]},)"
              R"({"first":4,"positions":[[0.1,5e+06,-7]]}],)"
              R"("triangles":[{"first":2,"corners":[[0,1,4],[1,2,3]]}]})"
              "\n");
}

}  // namespace
}  // namespace tinsmith::api
