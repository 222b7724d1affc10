// SPDX-License-Identifier: Apache-2.0
#include <set>

#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

class MeshRoutes : public Handlers {
  protected:
    std::string session = make_session();
    std::string mesh = session + "/mesh";

    void cut(const std::string& coordinates, const std::string& properties = "{}") {
        const Response made =
            post(session + "/polygons", R"({"type": "Feature", "properties": )" + properties +
                                            R"(, "geometry": {"type": "Polygon", "coordinates": )" +
                                            coordinates + "}}");
        ASSERT_EQ(made.status, 200) << made.body;
    }
    json gltf(const std::string& query) {
        const Response answer = ask("GET", mesh + ".gltf?" + query);
        EXPECT_EQ(answer.status, 200) << answer.body;
        EXPECT_EQ(answer.content_type, "model/gltf+json");
        return json::parse(answer.body, nullptr, false);
    }
    /// {polygons: triangles} of the primitives.
    static std::map<json, std::size_t> regions_of(const json& gltf) {
        std::map<json, std::size_t> regions;
        for (const json& primitive : gltf["meshes"][0]["primitives"]) {
            if (primitive.value("mode", 4) != 4) continue;
            const std::size_t indices = primitive["indices"];
            const std::size_t count = gltf["accessors"][indices]["count"];
            regions[primitive["extras"]["polygons"]] += count / 3;
        }
        return regions;
    }
};

TEST_F(MeshRoutes, SendEveryFormatByAcceptAndByName) {
    for (const auto& [type, path] : {std::pair("model/gltf-binary", ".glb"),
                                     {"model/gltf+json", ".gltf"},
                                     {"application/json", ".json"},
                                     {"model/obj", ".obj"},
                                     {"application/xml", ".xml"}}) {
        const Response named = ask("GET", mesh + path);
        const Response asked = ask("GET", mesh, {{"accept", type}});
        EXPECT_EQ(named.status, 200) << path;
        EXPECT_EQ(named.content_type, type);
        EXPECT_EQ(named.body, asked.body);
        EXPECT_EQ(header(named, "ETag"), header(asked, "ETag"));
        EXPECT_EQ(header(named, "Tinsmith-Triangles"), "2");
        EXPECT_EQ(ask("GET", mesh + path, {{"if-none-match", header(named, "ETag")}}).status, 304);
    }
}

TEST_F(MeshRoutes, TagEveryOptionApart) {
    std::set<std::string> tags;
    std::size_t asked = 0;
    for (const char* path :
         {".glb", ".gltf", ".json", ".obj", ".obj?constraints=true", ".xml",
          ".xml?constraints=false", ".glb?compression=meshopt", ".glb?compression=none",
          ".glb?regions=true", ".glb?regions=true&compression=meshopt", ".glb?bbox=0,0,1,1",
          ".glb?bbox=0,0,1,2", ".json?bbox=0,0,1,1", ".obj?bbox=0,0,1,1", ".gltf?up=z"}) {
        tags.insert(header(ask("GET", mesh + path), "ETag"));
        ++asked;
    }
    EXPECT_EQ(tags.size(), asked);
}

TEST_F(MeshRoutes, RefuseOptionsThatAFormatHasNot) {
    EXPECT_EQ(ask("GET", mesh + ".obj?up=z").status, 400);
    EXPECT_EQ(ask("GET", mesh + "?compression=none", {{"accept", "model/obj"}}).status, 400);
    EXPECT_EQ(ask("GET", mesh + "?constraints=true", {{"accept", "application/json"}}).status, 400);
    EXPECT_EQ(ask("GET", mesh + "?constraints=true", {{"accept", "model/obj"}}).status, 200);
    EXPECT_EQ(ask("GET", mesh + ".xml?constraints=maybe").status, 400);
}

TEST_F(MeshRoutes, SendTheTrianglesThatMeetABox) {
    const Response one = ask("GET", mesh + ".json?bbox=8,1,9,2");
    EXPECT_EQ(header(one, "Tinsmith-Triangles"), "1");
    EXPECT_EQ(json::parse(one.body)["triangles"].size(), 1U);
    EXPECT_EQ(json::parse(one.body)["vertices"].size(), 3U);
    EXPECT_EQ(header(ask("GET", mesh + ".glb?bbox=5,5,5,5"), "Tinsmith-Triangles"), "2");
    const Response none = ask("GET", mesh + ".obj?bbox=11,11,12,12");
    EXPECT_EQ(none.status, 400);
    EXPECT_EQ(told(none), "NOTHING_WITHIN");
    EXPECT_NE(none.body.find("0,0,10,10"), std::string::npos) << "what there is";
    EXPECT_EQ(told(ask("GET", mesh + ".glb?bbox=2,0,1,1")), "INVALID_OPTION");
}

TEST_F(MeshRoutes, MakeAPrimitiveOfEachRegion) {
    cut("[[[1,1],[6,1],[6,6],[1,6],[1,1]]]", R"({"use": "pad", "floors": 3})");
    cut("[[[4,2],[9,2],[9,5],[4,5],[4,2]]]");
    const json mesh_now = json::parse(ask("GET", mesh + ".json").body);
    for (const char* compression : {"draco", "meshopt", "none"}) {
        const json made = gltf("regions=true&compression=" + std::string(compression));
        const auto regions = regions_of(made);
        ASSERT_EQ(regions.size(), 4U);
        std::size_t sum = 0;
        for (const auto& [polygons, triangles] : regions)
            sum += triangles;
        EXPECT_EQ(sum, mesh_now["triangles"].size());
        const json first = json::parse(ask("GET", session + "/regions/p1").body);
        EXPECT_EQ(regions.at({"p1"}) + regions.at({"p1", "p2"}), first["triangles"].size());
        const json& told = made["scenes"][0]["extras"]["regions"];
        EXPECT_EQ(told[0]["plan_area"], first["plan_area"]);
        EXPECT_EQ(told[0]["surface_area"], first["surface_area"]);
        EXPECT_EQ(told[0]["properties"]["use"], "pad");
    }
    const auto boxed = regions_of(gltf("regions=true&bbox=8,3,8.5,4"));
    EXPECT_EQ(boxed.count({"p1"}), 0U) << "none of its triangles meets the box";
    EXPECT_GT(boxed.at({"p2"}), 0U);
}

TEST_F(MeshRoutes, HaveTheRegionsOfAnEarlierVersion) {
    cut("[[[1,1],[3,1],[3,3],[1,3],[1,1]]]");  // version 2
    const std::string then = ask("GET", mesh + ".glb?regions=true").body;
    cut("[[[4,4],[7,4],[7,7],[4,7],[4,4]]]");  // version 3
    EXPECT_EQ(ask("GET", mesh + ".glb?regions=true&version=2").body, then);
    const std::string both = ask("GET", mesh + ".glb?regions=true").body;
    ASSERT_EQ(ask("DELETE", session + "/polygons/p1").status, 200);  // version 4
    EXPECT_EQ(regions_of(gltf("regions=true")).size(), 2U);
    EXPECT_EQ(ask("GET", mesh + ".glb?regions=true&version=3").body, both);
    EXPECT_EQ(ask("GET", mesh + ".glb?regions=true&version=2").body, then);
    EXPECT_EQ(gltf("regions=true&version=1")["scenes"][0]["extras"]["regions"], json::array());
}

TEST_F(MeshRoutes, AnswerAnEditWithGltfToo) {
    const Response made = post(session + "/polygons", kParcel, {{"accept", "model/gltf+json"}});
    EXPECT_EQ(made.status, 200);
    EXPECT_EQ(made.content_type, "model/gltf+json");
    EXPECT_EQ(made.body, ask("GET", mesh + ".gltf").body);
    const Response edited =
        post(session + "/edits", R"({"operation": "offset", "polygon": "p1", "by": 1})",
             {{"accept", "model/gltf+json"}});
    EXPECT_EQ(edited.body, ask("GET", mesh + ".gltf").body);
}

TEST_F(MeshRoutes, SayTheSystemInLandXml) {
    const std::string text = ask("GET", mesh + ".xml").body;
    EXPECT_NE(text.find("epsgCode=\"32616\""), std::string::npos);
    EXPECT_NE(text.find("linearUnit=\"meter\""), std::string::npos);
    EXPECT_NE(text.find("<Surface name=\"Square\">"), std::string::npos);
}

TEST_F(MeshRoutes, CountTheMemoryOfCopiesAndEncodings) {
    const std::size_t free =
        services.limits.max_memory_bytes - services.sessions.memory_bytes() - 1000;
    auto all = services.sessions.borrow(free);
    ASSERT_TRUE(all);
    for (const char* path : {".glb", ".json", ".obj", ".xml"})
        EXPECT_EQ(ask("GET", mesh + path).status, 507) << path;
    const std::string made = header(ask("GET", session), "ETag");
    const Response edited =
        ask("POST", session + "/polygons",
            {{"content-type", "application/geo+json"}, {"accept", "model/gltf-binary"}}, kParcel);
    EXPECT_EQ(edited.status, 507) << edited.body;
    EXPECT_EQ(header(ask("GET", session), "ETag"), made);  // refused before it was done
    all.reset();
    EXPECT_EQ(ask("GET", mesh + ".glb").status, 200);
}

TEST_F(MeshRoutes, CountTheMemoryOfWhatFeaturesSay) {
    cut("[[[1,1],[2,1],[2,2],[1,1]]]", R"({"text": ")" + std::string(100'000, 'x') + R"("})");
    const std::size_t free =
        services.limits.max_memory_bytes - services.sessions.memory_bytes() - 1'000'000;
    auto most = services.sessions.borrow(free);
    ASSERT_TRUE(most);
    EXPECT_EQ(ask("GET", mesh + ".glb").status, 200);
    EXPECT_EQ(ask("GET", mesh + ".glb?regions=true").status, 507);
    most.reset();
    EXPECT_EQ(ask("GET", mesh + ".glb?regions=true").status, 200);
}

}  // namespace
}  // namespace tinsmith::server
