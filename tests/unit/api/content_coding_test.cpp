// SPDX-License-Identifier: Apache-2.0
#include "api/content_coding.hpp"

#include <gtest/gtest.h>

namespace tinsmith::api {
namespace {

TEST(AcceptEncoding, AllowsGzipByNameOrStar) {
    for (const char* field :
         {"gzip", "GZIP", "x-gzip", "br, gzip", "gzip;q=0.5", "*", "br;q=1,*;q=0.1", "gzip;q=0.001",
          "identity;q=0.5, gzip", "identity;q=0, gzip;q=0.1"}) {
        EXPECT_TRUE(accepts_gzip(field)) << field;
    }
}

TEST(AcceptEncoding, AllowsNothingElse) {
    for (const char* field : {"", "br", "gzip;q=0", "*;q=0", "gzip;q=0, *", "identity", "gzip;q=2",
                              "identity, gzip;q=0.5", "gzipped", ";q=1", "gzip;q=x"}) {
        EXPECT_FALSE(accepts_gzip(field)) << field;
    }
}

}  // namespace
}  // namespace tinsmith::api
