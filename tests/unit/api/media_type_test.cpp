// SPDX-License-Identifier: Apache-2.0
#include "api/media_type.hpp"

#include <array>

#include <gtest/gtest.h>

namespace tinsmith::api {
namespace {

constexpr std::array<std::string_view, 2> kOffers{"application/json", "model/gltf-binary"};

/// The chosen offer, or "none".
std::string_view chosen(std::string_view accept) {
    const auto index = choose_media_type(accept, kOffers);
    return index ? kOffers[*index] : "none";
}

TEST(MediaTypeOf, DropsParametersAndCase) {
    EXPECT_EQ(media_type_of("Application/JSON; charset=utf-8"), "application/json");
    EXPECT_EQ(media_type_of("  image/tiff "), "image/tiff");
    EXPECT_EQ(media_type_of(""), "");
    EXPECT_EQ(media_type_of(";"), "");
}

TEST(ChooseMediaType, TakesTheFirstOfferWhereNothingIsAskedFor) {
    EXPECT_EQ(chosen(""), "application/json");
    EXPECT_EQ(chosen("  "), "application/json");
    EXPECT_EQ(chosen("*/*"), "application/json");
}

TEST(ChooseMediaType, TakesWhatIsNamed) {
    EXPECT_EQ(chosen("model/gltf-binary"), "model/gltf-binary");
    EXPECT_EQ(chosen("MODEL/GLTF-BINARY"), "model/gltf-binary");
    EXPECT_EQ(chosen("model/*"), "model/gltf-binary");
    EXPECT_EQ(chosen("text/html, application/json"), "application/json");
}

TEST(ChooseMediaType, WeighsByQuality) {
    EXPECT_EQ(chosen("application/json;q=0.5, model/gltf-binary"), "model/gltf-binary");
    EXPECT_EQ(chosen("application/json;q=0.5, model/gltf-binary;q=0.4"), "application/json");
    EXPECT_EQ(chosen("*/*;q=0.1, model/gltf-binary ; q=0.2"), "model/gltf-binary");
}

TEST(ChooseMediaType, LetsTheMoreSpecificRangeDecide) {
    EXPECT_EQ(chosen("*/*, application/json;q=0"), "model/gltf-binary");
    EXPECT_EQ(chosen("application/*;q=0.9, application/json;q=0.1, model/*;q=0.5"),
              "model/gltf-binary");
}

TEST(ChooseMediaType, RefusesWhatIsNotThere) {
    EXPECT_EQ(chosen("text/html"), "none");
    EXPECT_EQ(chosen("application/json;q=0"), "none");
    EXPECT_EQ(chosen("application/jso"), "none");
    EXPECT_EQ(chosen("mod/*"), "none");
}

TEST(ChooseMediaType, PassesOverWhatItCannotRead) {
    EXPECT_EQ(chosen(",,;q=1, nonsense, application/json;q=2, model/gltf-binary"),
              "model/gltf-binary");
    EXPECT_EQ(chosen("application/json;q=nan"), "none");
    EXPECT_EQ(chosen("application/json;q=-1"), "none");
}

}  // namespace
}  // namespace tinsmith::api
