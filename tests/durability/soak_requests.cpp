// SPDX-License-Identifier: Apache-2.0
#include "tests/durability/soak_requests.hpp"

namespace tinsmith::e2e {

namespace {

const std::string kJson = "Content-Type: application/json";
const std::string kDelta = "Accept: application/vnd.tinsmith.delta";

double place(Dice& dice) {
    return dice.between(2, kSoakPosts - 3);
}

std::string ring(Dice& dice) {
    return ring_text(dice, place(dice), place(dice), dice.between(0.3, 2), 4 + dice.below(8));
}

std::string line(Dice& dice) {
    return R"({"type":"LineString","coordinates":[)" + position_text(place(dice), place(dice)) +
           "," + position_text(place(dice), place(dice)) + "]}";
}

std::string polygon_id(Dice& dice) {
    return "p" + std::to_string(1 + dice.below(30));
}

SoakRequest change(Dice& dice, const SoakSession& session, const std::string& base) {
    static const std::vector<std::string> kOptions{
        "", "?improve=none", "?improve=paper", "?lock=true", "?snap=0.01", "?winding=nonzero"};
    switch (dice.below(12)) {
        case 0:
            return {"dry run",
                    "POST",
                    base + "/polygons?dry_run=true",
                    {kJson},
                    polygon_text(ring(dice))};
        case 1:
            return {"polygons, delta",
                    "POST",
                    base + "/polygons",
                    {kJson, kDelta},
                    polygon_text(ring(dice))};
        case 2:
            return {"polygons, mesh",
                    "POST",
                    base + "/polygons",
                    {kJson, "Accept: model/gltf-binary"},
                    polygon_text(ring(dice))};
        case 3:
            return {"polygons, If-Match",
                    "POST",
                    base + "/polygons",
                    {kJson, "If-Match: " + (session.tag.empty() ? "*" : session.tag)},
                    polygon_text(ring(dice))};
        case 4:
            return {"edits",
                    "POST",
                    base + "/edits",
                    {kJson},
                    R"({"operation":"offset","by":0.1,"rim":0.01,"polygon":")" + polygon_id(dice) +
                        "\"}"};
        case 5:
            return {"edits, smooth",
                    "POST",
                    base + "/edits",
                    {kJson},
                    R"({"operation":"smooth","passes":2,"polygon":")" + polygon_id(dice) + "\"}"};
        case 6:
            return {"undo", "POST", base + "/undo"};
        case 7:
            return {"redo", "POST", base + "/redo", {kDelta}};
        case 8:
            return {"removal", "DELETE", base + "/polygons/" + polygon_id(dice) + "?cascade=true"};
        case 9:
            return {"locks",
                    dice.chance(0.5) ? "PUT" : "DELETE",
                    base + "/locks?snap=0.01",
                    {kJson},
                    R"({"type":"LineString","coordinates":[[1,1],[2,1],[3,1]]})"};
        case 10:
            return {"polygons, line", "POST", base + "/polygons", {kJson}, line(dice)};
        default:
            return {"polygons",
                    "POST",
                    base + "/polygons" + dice.one_of(kOptions),
                    {kJson},
                    polygon_text(ring(dice))};
    }
}

SoakRequest mesh(Dice& dice, const SoakSession& session, const std::string& base) {
    static const std::vector<std::string> kMeshes{"/mesh",
                                                  "/mesh.glb?tolerance=0.01&up=z",
                                                  "/mesh.glb?compression=meshopt&regions=true",
                                                  "/mesh.glb?compression=none&normals=true",
                                                  "/mesh.gltf?bbox=2,2,9,9",
                                                  "/mesh.gltf?constraints=true",
                                                  "/mesh.json",
                                                  "/mesh.obj?constraints=true",
                                                  "/mesh.xml"};
    const auto version = static_cast<int>(session.version);
    switch (dice.below(14)) {
        case 0:
            return {"delta since",
                    "GET",
                    base + "/mesh?since=" + std::to_string(dice.below(version + 1)),
                    {kDelta}};
        case 1:
            return {"delta as JSON",
                    "GET",
                    base + "/mesh?since=" + std::to_string(dice.below(version + 1)),
                    {"Accept: application/json", "Accept-Encoding: gzip"}};
        case 2:
            return {"mesh then", "GET",
                    base + "/mesh?version=" + std::to_string(1 + dice.below(version))};
        case 3:
            return {"mesh unless known",
                    "GET",
                    base + "/mesh.json",
                    {"If-None-Match: " + (session.tag.empty() ? "\"none\"" : session.tag),
                     "Accept-Encoding: gzip"}};
        case 4:
            return {"mesh head", "HEAD", base + "/mesh.obj"};
        default: {
            const std::string& path = dice.one_of(kMeshes);
            return {path, "GET", base + path};
        }
    }
}

SoakRequest question(Dice& dice, const SoakSession& session, const std::string& base) {
    static const std::vector<std::string> kLists{"",         "/polygons", "/polygons?limit=2",
                                                 "/regions", "/history",  "/constraints?limit=20",
                                                 "/locks"};
    const std::string version = std::to_string(1 + dice.below(static_cast<int>(session.version)));
    switch (dice.below(13)) {
        case 0:
            return {"elevation", "GET", base + "/elevation?x=5.5&y=7.25"};
        case 1:
            return {"elevations",
                    "POST",
                    base + "/elevation",
                    {kJson},
                    R"({"points":[[1.5,2.5],[3,4],[-9,0]]})"};
        case 2:
            return {"profile", "POST", base + "/profile", {kJson}, line(dice)};
        case 3:
            return {"volume", "POST", base + "/volume", {kJson}, R"({"against":{"elevation":2}})"};
        case 4:
            return {"volume, version",
                    "POST",
                    base + "/volume",
                    {kJson},
                    R"({"against":{"version":)" + version + "}}"};
        case 5:
            return {"volume, session",
                    "POST",
                    base + "/volume",
                    {kJson},
                    R"({"against":{"session":")" + session.other + "\"}}"};
        case 6:
            return {"polygon", "GET", base + "/polygons/" + polygon_id(dice)};
        case 7:
            return {"region", "GET", base + "/regions/" + polygon_id(dice)};
        case 8:
            return {"regions, GeoJSON", "GET", base + "/regions", {"Accept: application/geo+json"}};
        case 9:
            return {"history of one", "GET", base + "/history/" + version};
        default: {
            const std::string& path = dice.one_of(kLists);
            return {"session" + path, "GET", base + path};
        }
    }
}

SoakRequest service(Dice& dice, const std::string& base) {
    static const std::vector<std::string> kPaths{"/healthz",     "/readyz",       "/metrics",
                                                 "/v1/limits",   "/openapi.json", "/docs",
                                                 "/v1/sessions", "/v1/jobs"};
    switch (dice.below(8)) {
        case 0:
            return {"fork", "POST", base + "/fork"};
        case 1:
            return {"integrate",
                    "POST",
                    "/v1/integrate",
                    {"Content-Type: multipart/form-data; boundary=xx"},
                    "--xx\r\nContent-Disposition: form-data; name=\"terrain\"\r\n"
                    "Content-Type: application/json\r\n\r\n" +
                        grid_text(dice, 8) +
                        "\r\n--xx\r\nContent-Disposition: form-data; name=\"polygons\"\r\n\r\n" +
                        R"({"type":"LineString","coordinates":[[1,1],[5,3]]})" + "\r\n--xx--\r\n"};
        case 2:
            return {"job",
                    "POST",
                    base + "/volume",
                    {kJson, "Prefer: respond-async"},
                    R"({"against":{"elevation":1}})"};
        case 3:
            return {"job, polygons",
                    "POST",
                    base + "/polygons",
                    {kJson, "Prefer: respond-async"},
                    polygon_text(ring(dice))};
        default: {
            const std::string& path = dice.one_of(kPaths);
            return {path, "GET", path};
        }
    }
}

}  // namespace

SoakRequest soak_request(Dice& dice, const SoakSession& session) {
    const std::string base = "/v1/sessions/" + session.id;
    const double what = dice.between(0, 1);
    if (what < 0.4) return change(dice, session, base);
    if (what < 0.65) return mesh(dice, session, base);
    if (what < 0.9) return question(dice, session, base);
    return service(dice, base);
}

}  // namespace tinsmith::e2e
