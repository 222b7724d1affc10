// SPDX-License-Identifier: Apache-2.0
#include "api/formats/form.hpp"

#include <gtest/gtest.h>

namespace tinsmith::api {
namespace {

constexpr const char* kType = "multipart/form-data; boundary=\"a b\"";

std::string codes(std::string_view body, std::string_view type = kType) {
    const auto parts = read_form(body, type);
    return parts ? "" : parts.faults().front().code;
}

TEST(Form, IsTakenApart) {
    const auto parts = read_form(
        "preamble\r\n--a b\r\nContent-Disposition: form-data; filename=\"x;name=no\"; "
        "name=\"ter\\\"rain\"\r\nContent-Type: Image/TIFF; q=1\r\n\r\nII\r\n--a\r\n\r\n--a b\t\r\n"
        "content-disposition:form-data;name=b\r\n\r\n\r\n--a b--\r\nepilogue",
        kType);
    ASSERT_TRUE(parts);
    ASSERT_EQ(parts->size(), 2U);
    EXPECT_EQ((*parts)[0].name, "ter\"rain");
    EXPECT_EQ((*parts)[0].media_type, "image/tiff");
    EXPECT_EQ((*parts)[0].body, "II\r\n--a\r\n");
    EXPECT_EQ((*parts)[1].name, "b");
    EXPECT_EQ((*parts)[1].media_type, "");
    EXPECT_EQ((*parts)[1].body, "");
}

TEST(Form, IsRefusedWhereItIsBroken) {
    const std::string part = "--a b\r\nContent-Disposition: form-data; name=x\r\n\r\n1\r\n";
    EXPECT_EQ(codes(part + "--a b--"), "");
    EXPECT_EQ(codes(part + "--a b--", "multipart/form-data"), "FORM_MALFORMED");
    EXPECT_EQ(codes(part + "--a b--", "multipart/form-data; boundary="), "FORM_MALFORMED");
    EXPECT_EQ(codes(part + "--a b--", "multipart/form-data; boundary=\"a"), "FORM_MALFORMED");
    EXPECT_EQ(codes(part), "FORM_MALFORMED") << "no end";
    EXPECT_EQ(codes(""), "FORM_MALFORMED");
    EXPECT_EQ(codes("--a b"), "FORM_MALFORMED");
    EXPECT_EQ(codes("--a b\r\n\r\n1\r\n--a b--"), "FORM_MALFORMED") << "no name";
    EXPECT_EQ(codes("--a b\r\nX: " + std::string(9000, 'y') + "\r\n\r\n1\r\n--a b--"),
              "FORM_MALFORMED");
    std::string many;
    for (int i = 0; i < 17; ++i)
        many += part;
    EXPECT_EQ(read_form(many + "--a b--", kType).kind(), FaultKind::TooLarge);
    for (std::size_t size = 0; size < part.size() + 5; ++size)
        EXPECT_EQ(codes((part + "--a b--").substr(0, size)), "FORM_MALFORMED") << size;
}

}  // namespace
}  // namespace tinsmith::api
