// SPDX-License-Identifier: Apache-2.0
#include <thread>

#include "server/log.hpp"
#include "tests/unit/server/handlers.hpp"

namespace tinsmith::server {
namespace {

struct Part {
    std::string name, type, body;
};

class IntegrateRoutes : public Handlers {
  protected:
    static std::string form(const std::vector<Part>& parts) {
        std::string text;
        for (const Part& part : parts) {
            text += "--line\r\nContent-Disposition: form-data; name=\"" + part.name + "\"\r\n";
            if (!part.type.empty()) text += "Content-Type: " + part.type + "\r\n";
            text += "\r\n" + part.body + "\r\n";
        }
        return text + "--line--\r\n";
    }

    Response once(const std::vector<Part>& parts, std::vector<NameValue> headers = {}) {
        headers.emplace_back("content-type", "multipart/form-data; boundary=line");
        return ask("POST", "/v1/integrate", std::move(headers), form(parts));
    }

    static std::string places(const Response& response) {
        std::string places;
        const json body = json::parse(response.body);
        for (const json& error : body["errors"])
            places += (places.empty() ? "" : " ") + error.value("pointer", "-");
        return places;
    }

    const Part terrain{"terrain", "application/json", kSquare};
    const Part polygons{"polygons", "application/geo+json", kParcel};
};

TEST_F(IntegrateRoutes, DoTheMainJobAndKeepNothing) {
    const Response report = once({terrain, polygons});
    ASSERT_EQ(report.status, 200) << report.body;
    const std::string session = make_session();
    json kept = json::parse(post(session + "/polygons", kParcel).body);
    json told_of = json::parse(report.body);
    EXPECT_EQ(told_of["session"], nullptr);
    for (json* one : {&kept, &told_of}) {
        one->erase("session");
        one->erase("time_ms");
    }
    EXPECT_EQ(told_of, kept);
    const Response glb = once({terrain, polygons}, {{"accept", "model/gltf-binary"}});
    EXPECT_EQ(glb.content_type, "model/gltf-binary");
    EXPECT_EQ(glb.body, ask("GET", session + "/mesh.glb").body);
    EXPECT_NE(header(glb, "Tinsmith-Max-Error"), "");
    EXPECT_EQ(services.sessions.size(), 1U);
}

TEST_F(IntegrateRoutes, TakeOptionsOfPolygonsAndMesh) {
    const Part options{"options", "application/json",
                       R"({"improve": "none", "lock": true, "compression": "none"})"};
    const Response glb = once({options, polygons, terrain}, {{"accept", "model/gltf-binary"}});
    ASSERT_EQ(glb.status, 200) << glb.body;
    const std::string session = make_session();
    post(session + "/polygons?improve=none", kParcel);
    EXPECT_EQ(glb.body, ask("GET", session + "/mesh.glb?compression=none").body);
}

TEST_F(IntegrateRoutes, SendRegionsAndPartsOfTheMesh) {
    const auto options = [](const char* text) { return Part{"options", "application/json", text}; };
    const Response gltf =
        once({options(R"({"regions": true, "bbox": "0,0,3,3", "compression": "meshopt"})"),
              polygons, terrain},
             {{"accept", "model/gltf+json"}});
    ASSERT_EQ(gltf.status, 200) << gltf.body;
    EXPECT_EQ(gltf.content_type, "model/gltf+json");
    const std::string session = make_session();
    post(session + "/polygons", kParcel);
    EXPECT_EQ(
        gltf.body,
        ask("GET", session + "/mesh.gltf?regions=true&bbox=0,0,3,3&compression=meshopt").body);
    const std::vector<NameValue> as_glb{{"accept", "model/gltf-binary"}};
    const Response nothing =
        once({options(R"({"bbox": "20,20,30,30"})"), polygons, terrain}, as_glb);
    EXPECT_EQ(told(nothing), "NOTHING_WITHIN");
    EXPECT_EQ(places(nothing), "/options/bbox");
    const Response dry =
        once({options(R"({"regions": true, "dry_run": true})"), polygons, terrain}, as_glb);
    EXPECT_EQ(told(dry), "CONTRADICTION");
    EXPECT_EQ(places(dry), "/options/regions");
}

TEST_F(IntegrateRoutes, SayWhichPartIsAtFault) {
    const Response bad =
        once({{"terrain", "application/json", R"({"mesh": {"vertices": 3}})"},
              {"polygons", "", R"({"type": "Polygon", "coordinates": [[[1,"x"]]]})"},
              {"options", "", R"({"improve": "most", "up": "x", "colour": 1})"}});
    EXPECT_EQ(bad.status, 422);
    const std::string all = places(bad);
    for (const char* place :
         {"/terrain/mesh/vertices", "/options/improve", "/options/up", "/options/colour"})
        EXPECT_NE(all.find(place), std::string::npos) << place << " in " << all;
    EXPECT_EQ(places(once({{"terrain", "application/json", kSquare},
                           {"polygons", "", R"({"type": "Polygon", "coordinates": [[[1,"x"]]]})"}}))
                  .substr(0, 24),
              "/polygons/coordinates/0/");
    EXPECT_EQ(places(once({terrain, polygons, {"options", "", "[1]"}})), "/options");
    const Response outside = once({terrain, {"polygons", "", R"({"type": "Polygon",
        "coordinates": [[[20,20],[30,20],[30,30],[20,20]]]})"}});
    EXPECT_EQ(told(outside), "OUTSIDE_MESH");
    EXPECT_TRUE(places(outside).starts_with("/polygons") || places(outside) == "-");
    EXPECT_EQ(places(once({terrain, {"polygons", "", R"({"type": "Point", "coordinates": [1,1],
        "crs": {"type": "name", "properties": {"name": "EPSG:999999"}}})"}})),
              "/polygons/crs");
    EXPECT_EQ(services.sessions.size(), 0U);
}

TEST_F(IntegrateRoutes, WantTheirParts) {
    EXPECT_EQ(told(once({})), "PART_MISSING PART_MISSING");
    EXPECT_EQ(told(once({{"colour", "", "red"}})), "PART_UNKNOWN PART_MISSING PART_MISSING");
    EXPECT_EQ(told(once({terrain, terrain, polygons})), "PART_REPEATED");
    EXPECT_EQ(places(once({polygons})), "/terrain");
    EXPECT_EQ(told(once({{"terrain", "image/png", "x"}, polygons})), "PART_TYPE");
    EXPECT_EQ(once({{"terrain", "application/octet-stream", kSquare}, polygons}).status, 200);
    EXPECT_EQ(ask("POST", "/v1/integrate", {{"content-type", "application/json"}}, "{}").status,
              415);
    EXPECT_EQ(once({terrain, polygons}, {{"accept", "text/csv"}}).status, 406);
}

TEST_F(IntegrateRoutes, WorkAsJobs) {
    set_log_level(LogLevel::Off);
    const Response accepted = once({terrain, polygons}, {{"prefer", "respond-async"}});
    ASSERT_EQ(accepted.status, 202) << accepted.body;
    const std::string where = header(accepted, "Location");
    while (json::parse(ask("GET", where).body)["status"].is_null())
        std::this_thread::yield();
    const Response result = ask("GET", where + "/result");
    EXPECT_EQ(result.status, 200);
    EXPECT_EQ(json::parse(result.body)["polygons"][0]["id"], "p1");
    set_log_level(LogLevel::Info);
}

}  // namespace
}  // namespace tinsmith::server
