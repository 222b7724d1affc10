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
        {R"({"name": "a", "count": 1e-999})", FaultKind::Invalid, "NUMBER_OUT_OF_RANGE", "/count"},
        {R"({"name": "a", "count": 9007199254740993.0})", FaultKind::Invalid, "NUMBER_OUT_OF_RANGE",
         "/count"},
        {R"({"name": "a", "count": 18446744073709551617})", FaultKind::Invalid,
         "NUMBER_OUT_OF_RANGE", "/count"},
        {R"({"name": "a", "count": "NaN"})", FaultKind::Invalid, "WRONG_TYPE", "/count"},
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
    const Outcome long_token = read_sample("{\"name\": \"" + std::string(kLongestText, 'x'));
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

TEST(JsonReader, NamesAreTakenOnceInEveryObjectAlsoWhereNobodyLooks) {
    struct Nothing : Value {
        Container* object(Reader&) override { return nullptr; }
        std::string_view expected() const override { return "an object"; }
    } nothing;
    const std::string many = [] {
        std::string text = R"({"a": {"b": {"x": 1}, "c": [{"x": 1}, {"x": 2}]})";
        for (int i = 0; i < 200; ++i)
            text += ", \"m" + std::to_string(i) + "\": " + std::to_string(i);
        return text;
    }();
    const auto faults_of = [&](const std::string& body) {
        Reader reader(nothing, {});
        read(body, reader);
        if (reader.log().empty()) return Faults{};
        return std::move(reader.log()).refusal<int>().faults();
    };
    EXPECT_TRUE(faults_of(many + "}").empty());
    const Faults again = faults_of(many + R"(, "m5": 1, "m150": {"a": 1, "\u0061": 2}})");
    ASSERT_EQ(again.size(), 3U);
    EXPECT_EQ(again[0].pointer, "/m5");
    EXPECT_EQ(again[1].pointer, "/m150");
    EXPECT_EQ(again[2].pointer, "/m150/a") << "names are what they say, not how they are written";
    for (const Fault& fault : again)
        EXPECT_EQ(fault.code, "MEMBER_REPEATED");
    std::string wide = "{\"m\": 0";
    for (std::size_t i = 1; i < kMostMembers; ++i)
        wide += ",\"" + std::to_string(i) + "\":0";
    EXPECT_TRUE(faults_of(wide + "}").empty());
    const Faults wider = faults_of(wide + R"(, "one more": 0})");
    ASSERT_EQ(wider.size(), 1U);
    EXPECT_EQ(wider[0].code, "TOO_MANY_MEMBERS");
    EXPECT_EQ(wider[0].pointer, "/one more");
}

TEST(JsonReader, LongTextsAndNumbersAreRefusedByTheirPlace) {
    const std::string text(kLongestText, 'x');
    const std::string number(kLongestNumber, '1');
    const BadBody cases[] = {
        {R"({"name": "a", "data": {"a": [1, ")" + text + "y\"]}}", FaultKind::Invalid,
         "TEXT_TOO_LONG", "/data/a/1"},
        {R"({"name": "a", "data": {"a": ")" + text + "y", FaultKind::Invalid, "TEXT_TOO_LONG",
         "/data/a"},
        {R"({"name": "a", "data": {"a": 1, ")" + text + "y\": 1}}", FaultKind::Invalid,
         "TEXT_TOO_LONG", "/data"},
        {"\"" + text + "y\"", FaultKind::Invalid, "TEXT_TOO_LONG", ""},
        {R"({"name": "a", "data": {"a": [-0.)" + number + "]}}", FaultKind::Invalid,
         "NUMBER_TOO_LONG", "/data/a/0"},
        {"1" + number, FaultKind::Invalid, "NUMBER_TOO_LONG", ""},
        {R"({"name": } ")" + text + "y\"", FaultKind::Syntax, "JSON_SYNTAX", ""},
    };
    for (const BadBody& bad : cases) {
        SCOPED_TRACE(bad.body.substr(0, 40));
        const Outcome out = read_sample(bad.body);
        ASSERT_EQ(out.faults.size(), 1U);
        EXPECT_EQ(out.kind, bad.kind);
        EXPECT_EQ(out.faults[0].code, bad.code) << out.faults[0].detail;
        EXPECT_EQ(out.faults[0].pointer, bad.pointer);
        EXPECT_LT(out.faults[0].detail.size(), 500U);
    }
    const Outcome told = read_sample("{\"name\": \"a\",\n \"count\": 1" + number + "}");
    ASSERT_EQ(told.faults.size(), 1U);
    EXPECT_NE(told.faults[0].detail.find("line 2, column 11"), std::string::npos)
        << told.faults[0].detail;
    // As long as they may be, and with quotes within.
    EXPECT_TRUE(read_sample(R"({"name": "a", "data": {"a": ")" + text.substr(2) + R"(\"", ")" +
                            text + "\": 0." + number.substr(2) + "}}")
                    .faults.empty());
}

TEST(JsonReader, WhatPeopleWriteForNoNumberIsNamed) {
    for (const char* word : {"NaN", "nan", "Infinity", "-Infinity", "inf", "-inf"}) {
        const Outcome out = read_sample(R"({"name": "a", "count": )" + std::string(word) + "}");
        ASSERT_EQ(out.faults.size(), 1U) << word;
        EXPECT_NE(out.faults[0].detail.find("no NaN and no Infinity"), std::string::npos)
            << word << ": " << out.faults[0].detail;
    }
    EXPECT_EQ(read_sample(R"({"name": nul})").faults.at(0).detail.find("NaN"), std::string::npos);
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
