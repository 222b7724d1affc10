// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gltf_writer.hpp"

#include <cstring>
// tinygltf uses std::ifstream in what TINYGLTF_NO_FS leaves, without including it.
#include <fstream>
#include <limits>
#include <sstream>
#include <string_view>

// Compiled here rather than linked from the distribution: without files, images and image
// downloads, which a server has no use for.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

namespace tinsmith::api {
namespace {

using tinygltf::Value;

constexpr std::string_view kDracoExtension = "KHR_draco_mesh_compression";

int as_index(std::size_t n) {
    return static_cast<int>(n);
}

/// Appends bytes at the next multiple of 4 and gives the new view's index.
int add_view(tinygltf::Model& model, const void* bytes, std::size_t size, int target) {
    std::vector<unsigned char>& data = model.buffers.front().data;
    data.resize((data.size() + 3) / 4 * 4, 0);
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = size;
    view.target = target;
    data.resize(data.size() + size);
    std::memcpy(data.data() + view.byteOffset, bytes, size);
    model.bufferViews.push_back(std::move(view));
    return as_index(model.bufferViews.size() - 1);
}

/// `view` is -1 for what Draco holds: the accessor then only tells counts and bounds.
int add_accessor(tinygltf::Model& model, int view, int component, int type, std::size_t count) {
    tinygltf::Accessor accessor;
    accessor.bufferView = view;
    accessor.componentType = component;
    accessor.type = type;
    accessor.count = count;
    model.accessors.push_back(std::move(accessor));
    return as_index(model.accessors.size() - 1);
}

int add_vectors(tinygltf::Model& model, int view, std::size_t count) {
    return add_accessor(model, view, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, count);
}

void set_box(tinygltf::Accessor& accessor, const GlbPrimitive& primitive) {
    accessor.minValues.assign(primitive.low.begin(), primitive.low.end());
    accessor.maxValues.assign(primitive.high.begin(), primitive.high.end());
}

int add_plain_vectors(tinygltf::Model& model, const std::vector<float>& values) {
    const int view =
        add_view(model, values.data(), values.size() * sizeof(float), TINYGLTF_TARGET_ARRAY_BUFFER);
    return add_vectors(model, view, values.size() / 3);
}

void fill_plain(tinygltf::Model& model, const GlbPrimitive& from, tinygltf::Primitive& to) {
    to.attributes["POSITION"] = add_plain_vectors(model, from.positions);
    if (!from.normals.empty()) to.attributes["NORMAL"] = add_plain_vectors(model, from.normals);
    const int view =
        add_view(model, from.indices.data(), from.indices.size() * sizeof(std::uint32_t),
                 TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    to.indices = add_accessor(model, view, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                              TINYGLTF_TYPE_SCALAR, from.indices.size());
}

void fill_draco(tinygltf::Model& model, const DracoBytes& from, tinygltf::Primitive& to) {
    // No target: the bytes are neither vertices nor indices until a client has decoded them.
    const int view = add_view(model, from.bytes.data(), from.bytes.size(), 0);
    Value::Object attributes;
    attributes["POSITION"] = Value(from.position_id);
    to.attributes["POSITION"] = add_vectors(model, -1, from.points);
    if (from.normal_id) {
        attributes["NORMAL"] = Value(*from.normal_id);
        to.attributes["NORMAL"] = add_vectors(model, -1, from.points);
    }
    to.indices = add_accessor(model, -1, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR,
                              from.triangles * 3);
    Value::Object extension;
    extension["bufferView"] = Value(view);
    extension["attributes"] = Value(std::move(attributes));
    to.extensions[std::string(kDracoExtension)] = Value(std::move(extension));
}

void add_primitive(tinygltf::Model& model, tinygltf::Mesh& mesh, const GlbPrimitive& from) {
    tinygltf::Primitive to;
    to.mode = from.mode == GlbMode::Lines ? TINYGLTF_MODE_LINE : TINYGLTF_MODE_TRIANGLES;
    if (from.draco) {
        fill_draco(model, *from.draco, to);
        if (model.extensionsRequired.empty()) {
            model.extensionsUsed.emplace_back(kDracoExtension);
            model.extensionsRequired.emplace_back(kDracoExtension);
        }
    } else {
        fill_plain(model, from, to);
    }
    set_box(model.accessors[static_cast<std::size_t>(to.attributes["POSITION"])], from);
    mesh.primitives.push_back(std::move(to));
}

Value extra_value(const GlbExtra& extra) {
    if (const auto* number = std::get_if<double>(&extra)) return Value(*number);
    if (const auto* text = std::get_if<std::string>(&extra)) return Value(*text);
    if (const auto* count = std::get_if<std::size_t>(&extra)) {
        // tinygltf's integers are ints; a count beyond is whole as a double too.
        if (*count > static_cast<std::size_t>(std::numeric_limits<int>::max()))
            return Value(static_cast<double>(*count));
        return Value(static_cast<int>(*count));
    }
    Value::Array numbers;
    for (const double number : std::get<std::array<double, 3>>(extra))
        numbers.emplace_back(number);
    return Value(std::move(numbers));
}

void add_node(tinygltf::Model& model, tinygltf::Scene& scene, const GlbNode& from) {
    tinygltf::Mesh mesh;
    mesh.name = from.name;
    for (const GlbPrimitive& primitive : from.primitives)
        add_primitive(model, mesh, primitive);
    model.meshes.push_back(std::move(mesh));
    tinygltf::Node node;
    node.name = from.name;
    node.mesh = as_index(model.meshes.size() - 1);
    node.translation.assign(from.translation.begin(), from.translation.end());
    model.nodes.push_back(std::move(node));
    scene.nodes.push_back(as_index(model.nodes.size() - 1));
}

}  // namespace

std::variant<std::string, EncodeError> write_glb_file(const GlbScene& from) {
    tinygltf::Model model;
    model.asset.version = "2.0";
    model.asset.generator = from.generator;
    model.buffers.emplace_back();
    tinygltf::Scene scene;
    for (const GlbNode& node : from.nodes)
        add_node(model, scene, node);
    Value::Object extras;
    for (const auto& [name, extra] : from.extras)
        extras[name] = extra_value(extra);
    scene.extras = Value(std::move(extras));
    model.scenes.push_back(std::move(scene));
    model.defaultScene = 0;

    // The lengths in a GLB are 32 bits, and tinygltf does not check; the JSON is about a kilobyte
    // for each primitive.
    constexpr std::size_t kRoomForJson = std::size_t{1} << 28;
    if (model.buffers.front().data.size() >
        std::numeric_limits<std::uint32_t>::max() - kRoomForJson)
        return EncodeError{EncodeFault::TooLarge,
                           "the mesh passes the 4 GiB that a GLB can hold; ask for a smaller bbox "
                           "or for compression=draco"};
    std::ostringstream out;
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, out, false, true);
    return std::move(out).str();
}

}  // namespace tinsmith::api
