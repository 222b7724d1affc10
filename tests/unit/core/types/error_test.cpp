// SPDX-License-Identifier: Apache-2.0
#include "core/types/error.hpp"

#include <cctype>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "core/types/result.hpp"

namespace tinsmith::core {
namespace {

constexpr ErrorCode kCodes[] = {
    ErrorCode::CoordinateNotFinite, ErrorCode::CoordinateOutOfRange,
    ErrorCode::MeshEmpty,           ErrorCode::VertexIndexOutOfRange,
    ErrorCode::TriangleFlat,        ErrorCode::EdgeNotManifold,
    ErrorCode::VertexUnused,        ErrorCode::TriangleClockwise,
    ErrorCode::VertexFolded,        ErrorCode::MeshTooLarge,
    ErrorCode::RingTooShort,        ErrorCode::LineTooShort,
    ErrorCode::ShapeEmpty,          ErrorCode::OutsideMesh,
    ErrorCode::LeavesMesh,          ErrorCode::NotRepresentable,
    ErrorCode::CrossingBudget,      ErrorCode::TriangleBudget,
    ErrorCode::Cancelled,           ErrorCode::StepBudget,
    ErrorCode::NoEdgeAlong,         ErrorCode::IdBudget,
    ErrorCode::NothingInside,       ErrorCode::NothingLeft,
    ErrorCode::TooFewPoints,        ErrorCode::PointsCollinear,
};

TEST(ErrorCode, EachHasAWordOfItsOwn) {
    std::set<std::string> words;
    std::set<int> numbers;
    for (const ErrorCode code : kCodes) {
        words.insert(std::string(code_name(code)));
        numbers.insert(static_cast<int>(code));
    }
    EXPECT_EQ(words.size(), std::size(kCodes));
    EXPECT_EQ(numbers.size(), std::size(kCodes));
}

TEST(ErrorCode, ItsWordIsOfCapitalsAndUnderscores) {
    for (const ErrorCode code : kCodes) {
        EXPECT_FALSE(code_name(code).empty());
        for (const char letter : code_name(code))
            EXPECT_TRUE((letter >= 'A' && letter <= 'Z') || letter == '_') << code_name(code);
    }
    EXPECT_EQ(code_name(ErrorCode::RingTooShort), "RING_TOO_SHORT");
}

TEST(Result, HoldsAValueOrErrors) {
    const Result<int> good = 7;
    EXPECT_TRUE(good.ok());
    EXPECT_EQ(*good, 7);
    const Result<int> bad = Error{ErrorCode::ShapeEmpty, "nothing", {}};
    EXPECT_FALSE(bad);
    ASSERT_EQ(bad.errors().size(), 1u);
    EXPECT_EQ(bad.errors()[0].code, ErrorCode::ShapeEmpty);
}

}  // namespace
}  // namespace tinsmith::core
