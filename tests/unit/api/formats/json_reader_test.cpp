// SPDX-License-Identifier: Apache-2.0
#include "api/formats/json_reader.hpp"

#include <string>

#include <gtest/gtest.h>

#include "api/formats/json_reader_text.hpp"
#include "api/formats/json_reader_values.hpp"

namespace tinsmith::api::json {
namespace {

/// An object {"name": text, "count": 1..9, "data": any object}, name needed.
struct Sample : Object {
    Sample() {
        data.write_to(data_text);
        expect({{"name", &name, true}, {"count", &count}, {"data", &data}});
    }
    std::string name_text;
    std::uint64_t count_number = 0;
    std::string data_text = "{}";
    Text name{name_text, 10};
    Whole count{count_number, 1, 9};
    ObjectText data;
};

struct Outcome {
    std::string name;
    std::uint64_t count = 0;
    std::string data;
    FaultKind kind = FaultKind::Invalid;
    Faults faults;
};

Outcome read_sample(std::string_view body) {
    Sample sample;
    Reader reader(sample, {});
    read(body, reader);
    Outcome out{sample.name_text, sample.count_number, sample.data_text, {}, {}};
    if (reader.log().empty()) return out;
    auto refusal = std::move(reader.log()).refusal<int>();
    out.kind = refusal.kind();
    out.faults = refusal.faults();
    return out;
}

TEST(JsonReader, ReadsWhatIsExpected) {
    const Outcome out = read_sample(R"({"count": 3.0, "name": "hill"})");
    EXPECT_TRUE(out.faults.empty());
    EXPECT_EQ(out.name, "hill");
    EXPECT_EQ(out.count, 3U);
}

struct BadBody {
    std::string body;
    FaultKind kind;
    std::string code;
    std::string pointer;
};

TEST(JsonReader, NamesWhatIsWrongAndWhere) {
    const BadBody cases[] = {
        {"", FaultKind::Syntax, "JSON_SYNTAX", ""},
        {"{\"name\": \"a\",}", FaultKind::Syntax, "JSON_SYNTAX", ""},
        {"{\"name\": NaN}", FaultKind::Syntax, "JSON_SYNTAX", ""},
        {"{\"count\": Infinity}", FaultKind::Syntax, "JSON_SYNTAX", ""},
        {"{\"name\": \"\xff\"}", FaultKind::Syntax, "JSON_SYNTAX", ""},
        {"{\"name\": \"a\"} {}", FaultKind::Syntax, "JSON_SYNTAX", ""},
        {std::string("{\"name\": \"a\"}\0{}", 16), FaultKind::Syntax, "JSON_SYNTAX", ""},
        {"[]", FaultKind::Invalid, "WRONG_TYPE", ""},
        {"{}", FaultKind::Invalid, "MEMBER_MISSING", ""},
        {R"({"name": 4})", FaultKind::Invalid, "WRONG_TYPE", "/name"},
        {R"({"name": ["a"]})", FaultKind::Invalid, "WRONG_TYPE", "/name"},
        {R"({"name": "01234567890"})", FaultKind::Invalid, "TEXT_TOO_LONG", "/name"},
        {R"({"name": "a", "name": "b"})", FaultKind::Invalid, "MEMBER_REPEATED", "/name"},
        {R"({"name": "a", "c/o~": 1})", FaultKind::Invalid, "MEMBER_UNKNOWN", "/c~1o~0"},
        {R"({"name": "a", "count": 0})", FaultKind::Invalid, "NUMBER_OUT_OF_RANGE", "/count"},
        {R"({"name": "a", "count": 2.5})", FaultKind::Invalid, "NUMBER_OUT_OF_RANGE", "/count"},
        {R"({"name": "a", "count": 1e400})", FaultKind::Invalid, "NUMBER_OUT_OF_RANGE", "/count"},
        {R"({"name": "a", "data": {"b": [1, 1e999]}})", FaultKind::Invalid, "NUMBER_OUT_OF_RANGE",
         "/data/b/1"},
        {R"({"name": "a", "data": 7})", FaultKind::Invalid, "WRONG_TYPE", "/data"},
        {R"({"name": "a", "data": {"b": [{"c": 1, "d": 2, "c": 3}]}})", FaultKind::Invalid,
         "MEMBER_REPEATED", "/data/b/0/c"},
    };
    for (const BadBody& bad : cases) {
        SCOPED_TRACE(bad.body);
        const Outcome out = read_sample(bad.body);
        ASSERT_EQ(out.faults.size(), 1U);
        EXPECT_EQ(out.kind, bad.kind);
        EXPECT_EQ(out.faults[0].code, bad.code);
        EXPECT_EQ(out.faults[0].pointer, bad.pointer);
    }
}

TEST(JsonReader, SyntaxFaultsTellLineColumnAndByte) {
    const Outcome out = read_sample("{\n  \"name\": tru }");
    ASSERT_EQ(out.faults.size(), 1U);
    EXPECT_NE(out.faults[0].detail.find("line 2, column 14 (byte 16)"), std::string::npos)
        << out.faults[0].detail;
    EXPECT_EQ(out.faults[0].detail.find("json.exception"), std::string::npos);
}

TEST(JsonReader, DetailsArePrintableWhateverTheBodyHolds) {
    const Outcome out = read_sample("{\"name\": \"\xff\xfe\x01");
    ASSERT_EQ(out.faults.size(), 1U);
    for (const char c : out.faults[0].detail)
        EXPECT_TRUE(c >= ' ' && c <= '~');
    const Outcome long_token = read_sample("{\"name\": \"" + std::string(100000, 'x'));
    EXPECT_LT(long_token.faults.at(0).detail.size(), 500U);
}

TEST(JsonReader, TenMegabytesOfBracketsStopAtTheThirtyThird) {
    const Outcome out = read_sample(std::string(10'000'000, '['));
    ASSERT_EQ(out.faults.size(), 2U);  // the body is no object, either
    EXPECT_EQ(out.kind, FaultKind::Syntax);
    EXPECT_EQ(out.faults[1].code, "JSON_TOO_DEEP");
    std::string pointer;
    for (std::size_t i = 0; i < kMaxDepth; ++i)
        pointer += "/0";
    EXPECT_EQ(out.faults[1].pointer, pointer);
}

TEST(JsonReader, DepthThirtyTwoIsTaken) {
    const std::string body =
        R"({"name": "a", "data": {"a": )" + std::string(30, '[') + std::string(30, ']') + "}}";
    EXPECT_TRUE(read_sample(body).faults.empty());
    const std::string deeper =
        R"({"name": "a", "data": {"a": )" + std::string(31, '[') + std::string(31, ']') + "}}";
    EXPECT_EQ(read_sample(deeper).faults.at(0).code, "JSON_TOO_DEEP");
}

TEST(JsonReader, StopsAtTheHundredthFault) {
    std::string body = "{\"name\": \"a\"";
    for (int i = 0; i < 500; ++i)
        body += ", \"x" + std::to_string(i) + "\": 1";
    const Outcome out = read_sample(body + "} and this is not even JSON");
    EXPECT_EQ(out.faults.size(), kMaxFaults);
    EXPECT_EQ(out.kind, FaultKind::Invalid);
}

TEST(JsonReader, LongNamesAreCutBetweenCharacters) {
    std::string name;
    for (int i = 0; i < 1000; ++i)
        name += "\u00fc";
    const Outcome out = read_sample("{\"name\": \"a\", \"" + name + "\": 1}");
    ASSERT_EQ(out.faults.size(), 1U);
    EXPECT_EQ(out.faults[0].pointer, "/" + name.substr(0, 200));
    EXPECT_NE(out.faults[0].detail.find("\"" + name.substr(0, 60) + "...\""), std::string::npos);
}

TEST(JsonReader, KeepsPropertiesAsText) {
    const Outcome out = read_sample(
        R"({"name": "a", "data": {"b": [1, -2, 2.50, true, null, {}, []], "\"\\\n\u0001ü": "\tx"}})");
    EXPECT_TRUE(out.faults.empty());
    EXPECT_EQ(out.data, R"({"b":[1,-2,2.50,true,null,{},[]],"\"\\\n\u0001ü":"\u0009x"})");
    EXPECT_EQ(read_sample(R"({"name": "a", "data": null})").data, "{}");
}

TEST(JsonReader, ByteOrderMarkIsPassedOver) {
    EXPECT_TRUE(read_sample("\xEF\xBB\xBF{\"name\": \"a\"}").faults.empty());
}

}  // namespace
}  // namespace tinsmith::api::json
