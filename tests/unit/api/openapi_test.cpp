// SPDX-License-Identifier: Apache-2.0
// The options in /openapi.json against their parsers: names, values, defaults and bounds.
#include "api/openapi.hpp"

#include <algorithm>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "api/requests.hpp"
#include "api/terrain_options.hpp"

namespace tinsmith::api {
namespace {

using Json = nlohmann::ordered_json;
using Names = std::set<std::string>;

/// Whether an option of that value is taken, with the others that it needs.
using Takes = bool (*)(const std::string& name, const std::string& value);

bool polygons_take(const std::string& name, const std::string& value) {
    std::vector<NamedOption> options{{name, value, {}}};
    if (name == "on_crossing") options.push_back({"elevation", "own", {}});
    if (name == "max_deviation") options.push_back({"improve", "bounded", {}});
    if (name == "improve" && value == "bounded") options.push_back({"max_deviation", "1", {}});
    return parse_polygon_options(options).ok();
}

bool meshes_take(const std::string& name, const std::string& value) {
    return parse_mesh_options(std::vector<NamedOption>{{name, value, {}}}).ok();
}

/// The words of "none, strict, paper or bounded"; one of several words is none.
Names words_of(std::string_view values) {
    Names words;
    std::string text(values);
    for (std::size_t at = 0; (at = text.find(" or ", at)) != text.npos;)
        text.replace(at, 4, ", ");
    std::istringstream list(text);
    for (std::string word; std::getline(list >> std::ws, word, ',');)
        words.insert(word);
    return words;
}

std::string text_of(const Json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
}

Names described_words(const Json& schema) {
    Names words;
    if (schema.contains("enum")) {
        for (const Json& value : schema["enum"])
            words.insert(text_of(value));
    } else if (schema.contains("const")) {
        words.insert(text_of(schema["const"]));
    } else {
        words = {"true", "false"};
    }
    return words;
}

void expect_bounds(const std::string& name, const Json& schema, Takes takes) {
    if (schema.contains("minimum")) {
        const double least = schema["minimum"].get<double>();
        EXPECT_TRUE(takes(name, std::to_string(least))) << name;
        EXPECT_FALSE(takes(name, std::to_string(least - 1e-3))) << name;
    }
    if (schema.contains("exclusiveMinimum")) {
        const double bound = schema["exclusiveMinimum"].get<double>();
        EXPECT_FALSE(takes(name, std::to_string(bound))) << name;
        EXPECT_TRUE(takes(name, std::to_string(bound + 1e-3))) << name;
    }
    if (schema.contains("maximum")) {
        const double most = schema["maximum"].get<double>();
        EXPECT_TRUE(takes(name, std::to_string(most))) << name;
        EXPECT_FALSE(takes(name, std::to_string(most + 1))) << name;
    } else if (schema["type"] == "number") {
        EXPECT_TRUE(takes(name, "1e300")) << name;
    }
}

/// Every property of the schema is an option as the parser has it.
void expect_options(const std::string& schema_name, std::span<const std::string_view> names,
                    Takes takes) {
    static const Json document = Json::parse(openapi_document());
    const Json& schemas = document["components"]["schemas"];
    const Json& properties = schemas[schema_name]["properties"];
    Names described;
    for (const auto& [name, schema] : properties.items())
        described.insert(name);
    EXPECT_EQ(described, Names(names.begin(), names.end())) << schema_name;
    for (const auto& [name, schema] : properties.items()) {
        if (schema.contains("x-not-yet")) {
            EXPECT_FALSE(takes(name, "1")) << name << " is there by now: describe it";
            continue;
        }
        // Read before the parser gets to see the rest.
        if (schema.contains("x-of-the-route")) continue;
        const bool is_number = schema.contains("type") && schema["type"] == "number";
        const bool is_text = schema.contains("type") && schema["type"] == "string";
        if (!is_number && !is_text) {
            EXPECT_EQ(described_words(schema), words_of(option_values(name))) << name;
            for (const std::string& word : described_words(schema))
                EXPECT_TRUE(takes(name, word)) << name << "=" << word;
        }
        EXPECT_EQ(takes(name, "nonsense"), is_text && name != "crs" && name != "bbox") << name;
        if (is_number) expect_bounds(name, schema, takes);
        for (const Json& example : schema.value("examples", Json::array()))
            EXPECT_TRUE(takes(name, text_of(example))) << name;
    }
}

/// The options as they are described to be where nothing is said.
std::vector<NamedOption> described_defaults(const std::string& schema_name) {
    const Json document = Json::parse(openapi_document());
    std::vector<NamedOption> options;
    for (const auto& [name, schema] :
         document["components"]["schemas"][schema_name]["properties"].items()) {
        if (schema.contains("default")) options.push_back({name, text_of(schema["default"]), {}});
    }
    return options;
}

TEST(OpenApiOptions, AreThoseOfPolygons) {
    expect_options("PolygonOptions", polygon_option_names(), polygons_take);
    auto options = described_defaults("PolygonOptions");
    // It would need another than the default beside it; only its own default is read.
    std::erase_if(options, [](const NamedOption& o) { return o.name == "on_crossing"; });
    const auto said = parse_polygon_options(options);
    const auto unsaid = parse_polygon_options({});
    ASSERT_TRUE(said && unsaid);
    EXPECT_EQ(said->own_elevations, unsaid->own_elevations);
    EXPECT_EQ(said->winding, unsaid->winding);
    EXPECT_EQ(said->dry_run, unsaid->dry_run);
    EXPECT_EQ(said->angles, unsaid->angles);
    EXPECT_EQ(said->crs, unsaid->crs);
    EXPECT_EQ(said->integrate.improve, unsaid->integrate.improve);
    EXPECT_EQ(said->integrate.snap, unsaid->integrate.snap);
    EXPECT_EQ(said->integrate.outside, unsaid->integrate.outside);
    EXPECT_EQ(said->integrate.lock, unsaid->integrate.lock);
    EXPECT_EQ(core::IntegrateOptions{}.on_crossing, core::OnCrossing::New);
}

TEST(OpenApiOptions, AreThoseOfMeshes) {
    expect_options("MeshOptions", mesh_option_names(), meshes_take);
    const auto said = parse_mesh_options(described_defaults("MeshOptions"));
    const auto unsaid = parse_mesh_options({});
    ASSERT_TRUE(said && unsaid);
    EXPECT_EQ(said->gltf.compression, unsaid->gltf.compression);
    EXPECT_EQ(said->gltf.tolerance, unsaid->gltf.tolerance);
    EXPECT_EQ(said->gltf.up, unsaid->gltf.up);
    EXPECT_EQ(said->gltf.constraints, unsaid->gltf.constraints);
    EXPECT_EQ(said->gltf.normals, unsaid->gltf.normals);
    EXPECT_EQ(said->regions, unsaid->regions);
    EXPECT_EQ(said->bbox.has_value(), unsaid->bbox.has_value());
}

TEST(OpenApiOptions, OfOneRequestForAllAreThoseOfItsParts) {
    Names wanted;
    for (const auto names :
         {polygon_option_names(), mesh_option_names(), terrain_option_names_beside()})
        wanted.insert(names.begin(), names.end());
    wanted.erase("version");  // there is but one
    const Json document = Json::parse(openapi_document());
    Names described;
    for (const auto& [name, schema] :
         document["components"]["schemas"]["IntegrateOptions"]["properties"].items())
        described.insert(name);
    EXPECT_EQ(described, wanted);
}

}  // namespace
}  // namespace tinsmith::api
