// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gltf_writer.hpp"

#include <cstring>
// tinygltf uses std::ifstream in what TINYGLTF_NO_FS leaves, without including it.
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <sstream>

#include "api/formats/gltf_container.hpp"

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

constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";
constexpr const char* kFeatureExtension = "EXT_mesh_features";

int as_index(std::size_t n) {
    return static_cast<int>(n);
}

/// Puts a scene into a model of tinygltf, and its bytes beside it.
class ModelBuilder {
  public:
    explicit ModelBuilder(const GlbScene& from) : from_(from) {
        model_.asset.version = "2.0";
        model_.asset.generator = from.generator;
        tinygltf::Scene scene;
        for (const GlbNode& node : from.nodes)
            add_node(scene, node);
        Value::Object extras;
        for (const auto& [name, extra] : from.extras)
            extras[name] = extra_value(extra);
        scene.extras = Value(std::move(extras));
        model_.scenes.push_back(std::move(scene));
        model_.defaultScene = 0;
        for (const auto& [name, is_required] : extensions_) {
            model_.extensionsUsed.emplace_back(name);
            if (is_required) model_.extensionsRequired.emplace_back(name);
        }
    }

    /// The model as JSON, but for what tinygltf cannot write: the buffers, extensions of their
    /// views, the metadata.
    std::string json() const {
        std::ostringstream out;
        tinygltf::TinyGLTF().WriteGltfSceneToStream(&model_, out, false, false);
        return std::move(out).str();
    }

    GltfBytes take_bytes() { return std::move(bytes_); }

  private:
    int add_view(std::string_view bytes, int target) {
        return add_view(bytes_.append(bytes), bytes.size(), target, 0);
    }

    int add_view(std::size_t offset, std::size_t size, int target, std::size_t stride) {
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = offset;
        view.byteLength = size;
        view.byteStride = stride;
        view.target = target;
        model_.bufferViews.push_back(std::move(view));
        return as_index(model_.bufferViews.size() - 1);
    }

    int add_view(const MeshoptView& from) {
        tinygltf::BufferView view;
        view.buffer = 1;
        view.byteLength = from.count * from.stride;
        view.byteOffset = bytes_.append_compressed(model_.bufferViews.size(), from);
        if (!from.is_triangles) view.byteStride = from.stride;
        view.target =
            from.is_triangles ? TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER : TINYGLTF_TARGET_ARRAY_BUFFER;
        model_.bufferViews.push_back(std::move(view));
        return as_index(model_.bufferViews.size() - 1);
    }

    /// `view` is -1 for what Draco holds: the accessor then only tells counts and bounds.
    int add_accessor(int view, int component, int type, std::size_t count) {
        tinygltf::Accessor accessor;
        accessor.bufferView = view;
        accessor.componentType = component;
        accessor.type = type;
        accessor.count = count;
        model_.accessors.push_back(std::move(accessor));
        return as_index(model_.accessors.size() - 1);
    }

    int add_vectors(int view, std::size_t count) {
        return add_accessor(view, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, count);
    }
    int add_indices(int view, std::size_t count) {
        return add_accessor(view, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR,
                            count);
    }
    int add_features(int view, std::size_t count) {
        return add_accessor(view, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_SCALAR,
                            count);
    }

    int add_plain_vectors(std::string_view bytes) {
        return add_vectors(add_view(bytes, TINYGLTF_TARGET_ARRAY_BUFFER),
                           bytes.size() / (3 * sizeof(float)));
    }

    static std::string feature_attribute(std::size_t i) {
        return "_FEATURE_ID_" + std::to_string(i);
    }

    void fill_plain(const GlbPrimitive& from, tinygltf::Primitive& to) {
        to.attributes["POSITION"] =
            add_plain_vectors(bytes_of(from.positions.data(), from.positions.size()));
        if (!from.normals.empty())
            to.attributes["NORMAL"] =
                add_plain_vectors(bytes_of(from.normals.data(), from.normals.size()));
        const std::size_t vertices = from.positions.size();
        for (std::size_t i = 0; i < from.features.size(); ++i) {
            // 16 bits each and as many of padding: vertices begin at multiples of 4 bytes.
            const std::vector<std::uint32_t> ids(vertices, from.features[i]);
            const std::string_view bytes = bytes_of(ids.data(), ids.size());
            const int view = add_view(bytes_.append_own(std::string(bytes)), bytes.size(),
                                      TINYGLTF_TARGET_ARRAY_BUFFER, sizeof(ids[0]));
            to.attributes[feature_attribute(i)] = add_features(view, vertices);
        }
        const std::span<const std::uint32_t> indices = from.plain_indices();
        const int view = add_view(bytes_of(indices.data(), indices.size()),
                                  TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
        to.indices = add_indices(view, indices.size());
    }

    void fill_draco(const DracoBytes& from, tinygltf::Primitive& to) {
        // No target: the bytes are neither vertices nor indices until a client has decoded them.
        const int view = add_view(from.bytes, 0);
        Value::Object attributes;
        attributes["POSITION"] = Value(from.position_id);
        to.attributes["POSITION"] = add_vectors(-1, from.points);
        if (from.normal_id) {
            attributes["NORMAL"] = Value(*from.normal_id);
            to.attributes["NORMAL"] = add_vectors(-1, from.points);
        }
        for (std::size_t i = 0; i < from.feature_ids.size(); ++i) {
            attributes[feature_attribute(i)] = Value(from.feature_ids[i]);
            to.attributes[feature_attribute(i)] = add_features(-1, from.points);
        }
        to.indices = add_indices(-1, from.triangles * 3);
        Value::Object extension;
        extension["bufferView"] = Value(view);
        extension["attributes"] = Value(std::move(attributes));
        to.extensions[kDracoExtension] = Value(std::move(extension));
        extensions_[kDracoExtension] = true;
    }

    void fill_meshopt(const MeshoptBytes& from, tinygltf::Primitive& to) {
        const std::size_t vertices = from.positions.count;
        to.attributes["POSITION"] = add_vectors(add_view(from.positions), vertices);
        for (const MeshoptView& normals : from.normals)
            to.attributes["NORMAL"] = add_vectors(add_view(normals), vertices);
        for (std::size_t i = 0; i < from.features.size(); ++i)
            to.attributes[feature_attribute(i)] =
                add_features(add_view(from.features[i]), vertices);
        to.indices = add_indices(add_view(from.indices), from.indices.count);
        extensions_[std::string(kMeshoptExtension)] = true;
    }

    void tell_features(const GlbPrimitive& from, tinygltf::Primitive& to) {
        const std::size_t none = from_.table->rows;
        Value::Array sets;
        for (std::size_t i = 0; i < from.features.size(); ++i) {
            Value::Object set;
            set["attribute"] = Value(as_index(i));
            set["featureCount"] = Value(1);
            set["propertyTable"] = Value(0);
            if (from.features[i] == none) set["nullFeatureId"] = Value(as_index(none));
            sets.emplace_back(std::move(set));
        }
        Value::Object extension;
        extension["featureIds"] = Value(std::move(sets));
        to.extensions[kFeatureExtension] = Value(std::move(extension));
        extensions_[kFeatureExtension] = false;
        extensions_[std::string(kMetadataExtension)] = false;
        Value::Array polygons;
        for (const std::string& id : from.polygons)
            polygons.emplace_back(id);
        Value::Object extras;
        extras["polygons"] = Value(std::move(polygons));
        to.extras = Value(std::move(extras));
    }

    /// One for all triangles and one for all lines, written where there are some. glTF's own
    /// default is a mirror of metal, black in most viewers.
    int material_of(GlbMode mode) {
        std::optional<int>& known = mode == GlbMode::Lines ? line_material_ : ground_material_;
        if (known) return *known;
        tinygltf::Material material;
        material.name = mode == GlbMode::Lines ? "constraints" : "terrain";
        material.doubleSided = true;
        auto& look = material.pbrMetallicRoughness;
        const double grey = mode == GlbMode::Lines ? 0.02 : 0.5;  // linear
        look.baseColorFactor = {grey, grey, grey, 1.0};
        look.metallicFactor = 0.0;
        look.roughnessFactor = 0.9;
        model_.materials.push_back(std::move(material));
        known = as_index(model_.materials.size() - 1);
        return *known;
    }

    void add_primitive(tinygltf::Mesh& mesh, const GlbPrimitive& from) {
        tinygltf::Primitive to;
        to.material = material_of(from.mode);
        to.mode = from.mode == GlbMode::Lines ? TINYGLTF_MODE_LINE : TINYGLTF_MODE_TRIANGLES;
        if (from.draco) {
            fill_draco(*from.draco, to);
        } else if (from.meshopt) {
            fill_meshopt(*from.meshopt, to);
        } else {
            fill_plain(from, to);
        }
        if (from_.table && !from.features.empty()) tell_features(from, to);
        auto& position = model_.accessors[static_cast<std::size_t>(to.attributes["POSITION"])];
        position.minValues.assign(from.low.begin(), from.low.end());
        position.maxValues.assign(from.high.begin(), from.high.end());
        mesh.primitives.push_back(std::move(to));
    }

    void add_node(tinygltf::Scene& scene, const GlbNode& from) {
        tinygltf::Mesh mesh;
        mesh.name = from.name;
        for (const GlbPrimitive& primitive : from.primitives)
            add_primitive(mesh, primitive);
        model_.meshes.push_back(std::move(mesh));
        tinygltf::Node node;
        node.name = from.name;
        node.mesh = as_index(model_.meshes.size() - 1);
        node.translation.assign(from.translation.begin(), from.translation.end());
        model_.nodes.push_back(std::move(node));
        scene.nodes.push_back(as_index(model_.nodes.size() - 1));
    }

    static Value extra_value(const GlbExtra& extra) {
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

    const GlbScene& from_;
    tinygltf::Model model_;
    GltfBytes bytes_;
    std::optional<int> ground_material_;
    std::optional<int> line_material_;
    std::map<std::string, bool> extensions_;  ///< those in use; whether nothing works without
};

}  // namespace

std::variant<std::string, EncodeError> write_gltf_file(const GlbScene& from,
                                                       GltfContainer container) {
    ModelBuilder model(from);
    const std::string json = model.json();
    return pack_gltf(json, from, model.take_bytes(), container);
}

}  // namespace tinsmith::api
