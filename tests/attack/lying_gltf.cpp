// SPDX-License-Identifier: Apache-2.0
#include "tests/attack/lying_files.hpp"

namespace tinsmith::e2e {

namespace {

const std::string kGlb = "model/gltf-binary";
const std::string kScene = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)";
const std::string kNode = R"("nodes":[{"mesh":0}],)";
const std::string kPlainMesh =
    R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)";

std::string chunk(const char* type, std::string bytes, char padding) {
    bytes.resize((bytes.size() + 3) / 4 * 4, padding);
    std::string out;
    append_number(out, static_cast<std::uint32_t>(bytes.size()));
    out.append(type, 4);
    return out + bytes;
}

std::string glb(const std::string& json, const std::string& bin) {
    const std::string chunks = chunk("JSON", json, ' ') + chunk("BIN\0", bin, '\0');
    std::string out = "glTF";
    append_number(out, std::uint32_t{2});
    append_number(out, static_cast<std::uint32_t>(chunks.size() + 12));
    return out + chunks;
}

/// One triangle: three positions of 12 bytes, three indices of 4.
std::string triangle() {
    std::string bin(36, '\0');
    bin[12 + 2] = '\x80', bin[12 + 3] = '\x3F';  // 1, 0, 0
    bin[24 + 10] = '\x80', bin[24 + 11] = '\xBF';
    for (const std::uint32_t index : {0U, 1U, 2U})
        append_number(bin, index);
    return bin;
}

std::string views(const std::string& positions, const std::string& indices) {
    return R"("buffers":[{"byteLength":48}],"bufferViews":[{"buffer":0,)" + positions +
           R"(},{"buffer":0,)" + indices + "}],";
}
const std::string kViews = views(R"("byteLength":36)", R"("byteOffset":36,"byteLength":12)");

std::string accessors(const std::string& positions, const std::string& indices) {
    return R"("accessors":[{"componentType":5126,"type":"VEC3",)" + positions +
           R"(},{"componentType":5125,"type":"SCALAR",)" + indices + "}]}";
}
const std::string kHonestAccessors =
    accessors(R"("bufferView":0,"count":3)", R"("bufferView":1,"count":3)");

/// Draco's head, then so many faces and points as its numbers of any length say.
std::string draco(const std::string& method, const std::string& counts) {
    using namespace std::string_literals;
    return "DRACO\x02\x02\x01"s + method + "\0\0"s + counts;
}

std::string draco_glb(const std::string& packed, const std::string& count) {
    const std::string size = std::to_string(packed.size());
    return glb(kScene + kNode +
                   R"("extensionsUsed":["KHR_draco_mesh_compression"],)"
                   R"("extensionsRequired":["KHR_draco_mesh_compression"],)"
                   R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,)"
                   R"("extensions":{"KHR_draco_mesh_compression":{"bufferView":0,)"
                   R"("attributes":{"POSITION":0}}}}]}],)"
                   R"("buffers":[{"byteLength":)" +
                   size + R"(}],"bufferViews":[{"buffer":0,"byteLength":)" + size + "}]," +
                   accessors("\"count\":" + count, "\"count\":" + count),
               packed);
}

std::string meshopt_glb(const std::string& count) {
    const std::string packed = "\xA0" + std::string(63, '\0');
    return glb(
        kScene + kNode + kPlainMesh +
            R"("extensionsUsed":["EXT_meshopt_compression"],)"
            R"("extensionsRequired":["EXT_meshopt_compression"],)"
            R"("buffers":[{"byteLength":64},{"byteLength":)" +
            count + R"(0}],"bufferViews":[{"buffer":1,"byteLength":)" + count +
            R"(0,"extensions":{"EXT_meshopt_compression":{"buffer":0,"byteLength":64,)"
            R"("byteStride":12,"mode":"ATTRIBUTES","count":)" +
            count + "}}}]," +
            accessors("\"bufferView\":0,\"count\":" + count, "\"bufferView\":0,\"count\":" + count),
        packed);
}

/// Nodes that each have the next one twice: 2^count of them where they are followed blindly.
std::string doubling_nodes(std::size_t count) {
    std::string nodes = "\"nodes\":[";
    for (std::size_t i = 1; i < count; ++i) {
        const std::string next = std::to_string(i);
        nodes += "{\"children\":[" + next + "," + next + "]},";
    }
    return nodes + "{\"mesh\":0}],";
}

std::string chain_of_nodes(std::size_t count) {
    std::string nodes = "\"nodes\":[";
    for (std::size_t i = 1; i < count; ++i)
        nodes += "{\"children\":[" + std::to_string(i) + "]},";
    return nodes + "{\"mesh\":0}],";
}

/// A mesh in many places: each is its triangles again.
std::string many_places(std::size_t count) {
    std::string roots, nodes;
    for (std::size_t i = 0; i < count; ++i) {
        roots += (i > 0 ? "," : "") + std::to_string(i);
        nodes += (i > 0 ? "," : "") + std::string("{\"mesh\":0}");
    }
    std::string primitives = R"({"attributes":{"POSITION":0},"indices":1})";
    primitives += repeated("," + primitives, count - 1);
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + roots +
           R"(]}],"nodes":[)" + nodes + R"(],"meshes":[{"primitives":[)" + primitives + "]}]," +
           kViews + kHonestAccessors;
}

/// So many members of one object, after another.
std::string repeated_names(std::size_t count) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i)
        text += ",\"" + std::to_string(i) + "\":0";
    return text;
}

std::string with_word(std::string bytes, std::size_t at, std::uint32_t word) {
    std::string number;
    append_number(number, word);
    return bytes.replace(at, number.size(), number);
}

}  // namespace

std::string repeated(const std::string& text, std::size_t count) {
    std::string out;
    out.reserve(text.size() * count);
    for (std::size_t i = 0; i < count; ++i)
        out += text;
    return out;
}

std::vector<LyingFile> lying_gltf() {
    using namespace std::string_literals;
    const std::string plain = kScene + kNode + kPlainMesh;
    const std::string honest = glb(plain + kViews + kHonestAccessors, triangle());
    const std::string most = "\xFF\xFF\xFF\xFF\x0F";  // 2^32 - 1 as Draco writes it
    const std::string deep = std::string(200'000, '[') + std::string(200'000, ']');
    const auto of_json = [](const std::string& json) { return glb(json, triangle()); };
    return {
        {"length of 4 GiB", kGlb, with_word(honest, 8, 0xFFFFFFFF), 400},
        {"JSON of 4 GiB", kGlb, with_word(honest, 12, 0xFFFFFFFC), 400},
        {"accessor of 4e9 positions", kGlb,
         of_json(plain + kViews +
                 accessors(R"("bufferView":0,"count":4000000000)", R"("bufferView":1,"count":3)")),
         413},
        {"accessor of nothing but zeros", kGlb,
         of_json(plain + kViews + accessors(R"("count":4000000000)", R"("count":4000000000)")),
         422},
        {"sparse accessor of 4e9 zeros", kGlb,
         of_json(plain + kViews +
                 accessors(R"("count":4000000000,"sparse":{"count":1,"indices":{"bufferView":1,)"
                           R"("componentType":5125},"values":{"bufferView":0}})",
                           R"("bufferView":1,"count":3)")),
         422},
        {"count of 2^64", kGlb,
         of_json(plain + kViews +
                 accessors(R"("bufferView":0,"count":18446744073709551615)",
                           R"("bufferView":1,"count":3)")),
         422},
        {"view of a tebibyte", kGlb,
         of_json(plain +
                 views(R"("byteLength":1099511627776)", R"("byteOffset":36,"byteLength":12)") +
                 kHonestAccessors),
         422},
        {"Draco of 4e9 faces, one by one", kGlb,
         draco_glb(draco("\0"s, most + most + std::string(64, '\0')), "3"), 413},
        {"Draco of 4e9 faces, by edges", kGlb,
         draco_glb(draco("\x01", "\0"s + most + most + most + std::string(64, '\0')), "3"), 413},
        {"Draco of 4e9 vertices, as told outside", kGlb,
         draco_glb(draco("\x01", "\0"s + most + most + most + std::string(64, '\0')), "4000000000"),
         413},
        {"meshopt of 1e9 vertices", kGlb, meshopt_glb("1000000000"), 413},
        {"extras nested 200,000 deep", kGlb,
         of_json(plain + kViews + "\"extras\":" + deep + "," + kHonestAccessors), 413},
        {"nested 200,000 deep", "model/gltf+json", deep, 413},
        {"five million extras, and a count of 2^64", kGlb,
         of_json(plain + kViews + "\"extras\":[" + repeated("0,", 5'000'000) + "0]," +
                 accessors(R"("bufferView":0,"count":18446744073709551615)",
                           R"("bufferView":1,"count":3)")),
         422},
        {"nodes that double forty times", kGlb,
         of_json(kScene + doubling_nodes(40) + kPlainMesh + kViews + kHonestAccessors), 422},
        {"a chain of 20,000 nodes", kGlb,
         of_json(kScene + chain_of_nodes(20'000) + kPlainMesh + kViews + kHonestAccessors), 422},
        {"a ring of nodes", kGlb,
         of_json(kScene + R"("nodes":[{"mesh":0,"children":[0]}],)" + kPlainMesh + kViews +
                 kHonestAccessors),
         422},
    };
}

std::vector<LyingFile> crowded_gltf() {
    const auto of_json = [](const std::string& json) { return glb(json, triangle()); };
    const std::string rest = kPlainMesh + kViews + kHonestAccessors;
    const std::string nodes = kScene + R"("nodes":[{"mesh":0})";
    const std::string broken = R"(,{"mesh":-1}],)";
    const std::string plain = kScene + kNode;
    // Just as many as are taken, and one part that is wrong at the end.
    constexpr std::size_t kMost = 99'990;
    return {
        {"a million empty nodes", kGlb, of_json(nodes + repeated(",{}", 1'000'000) + "]," + rest),
         413},
        {"99,990 empty nodes", kGlb, of_json(nodes + repeated(",{}", kMost) + broken + rest), 422},
        {"99,990 scaled nodes", kGlb,
         of_json(nodes + repeated(R"(,{"scale":[1,1,1]})", kMost) + broken + rest), 422},
        {"a node with a million children", kGlb,
         of_json(kScene + R"("nodes":[{"mesh":0,"children":[1)" + repeated(",1", 1'000'000) +
                 "]}]," + rest),
         413},
        {"a scene of a million roots", kGlb,
         of_json(R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0)" + repeated(",0", 1'000'000) +
                 "]}]," + kNode + rest),
         413},
        {"99,990 roots that are one node", kGlb,
         of_json(R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0)" + repeated(",0", kMost) +
                 "]}]," + kNode + rest),
         422},
        {"a million meshes", kGlb,
         of_json(plain + R"("meshes":[{"primitives":[{}]})" + repeated(",{}", 1'000'000) + "]," +
                 kViews + kHonestAccessors),
         413},
        {"99,990 primitives of nothing", kGlb,
         of_json(plain + R"("meshes":[{"primitives":[{})" + repeated(",{}", kMost) + "]}]," +
                 kViews + kHonestAccessors),
         422},
        {"a million accessors of nothing", kGlb,
         of_json(plain + kPlainMesh + kViews + R"("accessors":[{})" + repeated(",{}", 1'000'000) +
                 "]}"),
         413},
        {"99,990 accessors of one number", kGlb,
         of_json(plain + kPlainMesh + kViews + R"("accessors":[{"count":1})" +
                 repeated(R"(,{"count":1})", kMost) + "]}"),
         422},
        {"a million names in an object", kGlb,
         of_json(plain + kPlainMesh + kViews + R"("extras":{"a":0)" + repeated_names(1'000'000) +
                 "}," + kHonestAccessors),
         413},
        {"one name twice", kGlb, of_json(plain + R"("extras":{"a":[{"b":0,"b":1}]},)" + rest), 422},
        {"a number of four million digits", kGlb,
         of_json(plain + R"("extras":)" + std::string(4'000'000, '9') + "," + rest), 413},
        {"a text of eight million bytes that is no base64", "model/gltf+json",
         plain + kPlainMesh + R"("buffers":[{"byteLength":48,"uri":"data:;base64,)" +
             std::string(8'000'000, '!') + R"("}],)" + kHonestAccessors,
         422},
        {"six million bytes as base64, of a file that promises more", "model/gltf+json",
         plain + kPlainMesh + R"("buffers":[{"byteLength":6000001,"uri":"data:;base64,)" +
             std::string(8'000'000, 'A') + R"("}],)" + kHonestAccessors,
         422},
        {"texts without an end", "model/gltf+json", plain + "\"" + std::string(8'000'000, 'a'),
         413},
    };
}

LyingFile mesh_in_many_places() {
    return {"8,000 primitives in 8,000 places", kGlb, glb(many_places(8000), triangle()), 413};
}

}  // namespace tinsmith::e2e
