// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gltf_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/formats/base64.hpp"
#include "api/formats/glb_chunks.hpp"
#include "api/formats/gltf_document.hpp"
#include "api/formats/json_reader.hpp"
#include "api/formats/json_text.hpp"

namespace tinsmith::api {

namespace {

/// Extensions that change nothing about where the triangles are; a trailing star: all such.
constexpr std::string_view kHarmless[] = {"KHR_draco_mesh_compression",
                                          "KHR_mesh_quantization",
                                          "EXT_meshopt_compression",
                                          "KHR_materials_*",
                                          "KHR_texture_*",
                                          "EXT_texture_*",
                                          "KHR_lights_*",
                                          "EXT_mesh_features",
                                          "EXT_structural_metadata",
                                          "KHR_xmp*",
                                          "EXT_feature_metadata",
                                          "MSFT_texture_*"};

bool is_harmless(std::string_view extension) {
    return std::any_of(std::begin(kHarmless), std::end(kHarmless), [&](std::string_view known) {
        if (!known.ends_with('*')) return extension == known;
        return extension.starts_with(known.substr(0, known.size() - 1));
    });
}

class ModelReader : private GltfDocument {
  public:
    explicit ModelReader(FaultLog& log) : GltfDocument(log) {}

    std::optional<GltfModel> read(std::string_view bytes) {
        const auto chunks = split_glb(bytes, log_);
        if (!chunks) return std::nullopt;
        const std::size_t before = log_.size();
        if (!is_sound(chunks->json)) return std::nullopt;
        const JsonText document(chunks->json);
        if (!document.is_object()) {
            fault(FaultKind::Syntax, "GLTF_SYNTAX", "A glTF is a JSON object.");
            return std::nullopt;
        }
        read_asset(document);
        read_extensions(document);
        read_buffers(document, chunks->bin);
        read_views(document);
        read_accessors(document);
        read_meshes(document);
        read_nodes(document);
        read_scene(document);
        if (log_.size() > before) return std::nullopt;
        return std::move(model_);
    }

  private:
    void read_asset(const JsonText& document) {
        const auto asset = document.member("asset");
        if (!asset || !asset->is_object())
            return invalid("There is no \"asset\": is this a glTF?", "");
        if (!text(*asset, "version").starts_with("2."))
            fault(FaultKind::Unsupported, "GLTF_VERSION", "Only glTF 2.0 is read.",
                  "/asset/version");
        model_.is_ours = text(*asset, "generator") == "Tinsmith";
    }

    void read_extensions(const JsonText& document) {
        const auto list = document.member("extensionsRequired");
        if (!list || !list->is_array()) return;
        std::size_t i = 0;
        for (JsonText::Elements all(*list); const auto element = all.next(); ++i) {
            if (log_.full()) return;
            const std::string name = text_of(*element);
            if (is_harmless(name)) continue;
            fault(FaultKind::Unsupported, "GLTF_EXTENSION",
                  "The file cannot be read without the extension " + json::quoted(name) +
                      ", which is not known here.",
                  "/extensionsRequired/" + std::to_string(i));
        }
    }

    /// A file that was cut short says so here, also where no view reaches its end.
    void hold(std::size_t promised, std::size_t there, const std::string& pointer) {
        if (promised > there)
            invalid("It has " + std::to_string(there) + " bytes of the " +
                        std::to_string(promised) + " that it promises.",
                    pointer + "/byteLength");
    }

    void read_buffers(const JsonText& document, std::optional<std::string_view> bin) {
        // Views into `decoded` stay where they are: it is filled before they are taken.
        std::vector<std::pair<std::size_t, std::size_t>> own;
        const auto begin = [](std::size_t) {};
        each(document, "buffers", "", begin,
             [&](const JsonText& buffer, const std::string& pointer) {
                 const std::size_t length = needed(buffer, "byteLength", pointer);
                 std::string_view& bytes = model_.buffers.emplace_back();
                 const auto uri = buffer.member("uri");
                 if (!uri || !uri->is_text()) {
                     // Others without bytes are there for clients that cannot decompress.
                     if (model_.buffers.size() > 1 || !bin) return;
                     bytes = bin->substr(0, length);
                     return hold(length, bytes.size(), pointer);
                 }
                 // A slash may be written with a backslash; then it is short of what
                 // look_through_json calls long, or refused there.
                 const std::string escaped = whole_text_of_escaped(*uri);
                 const std::string_view name =
                     escaped.empty() ? uri->text().substr(1, uri->text().size() - 2) : escaped;
                 const std::size_t comma = name.find(',');
                 const bool is_data = name.starts_with("data:") && comma != name.npos &&
                                      name.substr(0, comma).ends_with(";base64");
                 if (!is_data) {
                     fault(FaultKind::Unsupported, "GLTF_URI",
                           "The file's bytes are elsewhere, at " + json::quoted(name) +
                               ": nothing is fetched. Pack it into one file (GLB) first.",
                           pointer + "/uri");
                     return;
                 }
                 auto decoded = decode_base64(name.substr(comma + 1));
                 if (!decoded) return invalid("This is no base64.", pointer + "/uri");
                 hold(length, decoded->size(), pointer);
                 own.emplace_back(model_.buffers.size() - 1, model_.decoded.size());
                 model_.decoded.push_back(std::move(*decoded));
             });
        for (const auto& [buffer, which] : own)
            model_.buffers[buffer] = model_.decoded[which];
    }

    void read_views(const JsonText& document) {
        const auto begin = [&](std::size_t all) { model_.views.reserve(all); };
        each(document, "bufferViews", "", begin,
             [&](const JsonText& view, const std::string& pointer) {
                 GltfView out;
                 out.buffer = needed(view, "buffer", pointer);
                 out.offset = number(view, "byteOffset", pointer, 0);
                 out.length = needed(view, "byteLength", pointer);
                 out.stride = number(view, "byteStride", pointer, 0);
                 if (const auto packed = extension(view, "EXT_meshopt_compression")) {
                     const std::string place = pointer + "/extensions/EXT_meshopt_compression";
                     GltfMeshopt& meshopt = out.meshopt.emplace();
                     meshopt.buffer = needed(*packed, "buffer", place);
                     meshopt.offset = number(*packed, "byteOffset", place, 0);
                     meshopt.length = needed(*packed, "byteLength", place);
                     meshopt.stride = needed(*packed, "byteStride", place);
                     meshopt.count = needed(*packed, "count", place);
                     meshopt.mode = text(*packed, "mode");
                     meshopt.filter = text(*packed, "filter");
                 }
                 model_.views.push_back(std::move(out));
             });
    }

    void read_accessors(const JsonText& document) {
        const auto begin = [&](std::size_t all) { model_.accessors.reserve(all); };
        each(document, "accessors", "", begin,
             [&](const JsonText& accessor, const std::string& pointer) {
                 GltfAccessor out;
                 out.view = index(accessor, "bufferView", pointer);
                 out.offset = number(accessor, "byteOffset", pointer, 0);
                 out.count = needed(accessor, "count", pointer);
                 out.component = needed(accessor, "componentType", pointer);
                 out.type = text(accessor, "type");
                 out.normalized = flag(accessor, "normalized");
                 out.sparse = accessor.member("sparse").has_value();
                 model_.accessors.push_back(std::move(out));
             });
    }

    void read_meshes(const JsonText& document) {
        const auto begin = [&](std::size_t all) { model_.meshes.reserve(all); };
        each(document, "meshes", "", begin, [&](const JsonText& mesh, const std::string& pointer) {
            auto& primitives = model_.meshes.emplace_back();
            const auto begin_mesh = [&](std::size_t all) { primitives.reserve(all); };
            each(mesh, "primitives", pointer, begin_mesh,
                 [&](const JsonText& from, const std::string& place) {
                     GltfPrimitive out;
                     out.mesh = static_cast<std::uint32_t>(model_.meshes.size() - 1);
                     out.number = static_cast<std::uint32_t>(primitives.size());
                     out.mode = number(from, "mode", place, 4);
                     out.indices = index(from, "indices", place);
                     if (const auto attributes = from.member("attributes"))
                         out.position = index(*attributes, "POSITION", place + "/attributes");
                     if (const auto draco = extension(from, "KHR_draco_mesh_compression")) {
                         const std::string there = place + "/extensions/KHR_draco_mesh_compression";
                         const auto ids = draco->member("attributes");
                         out.draco =
                             GltfDraco{needed(*draco, "bufferView", there),
                                       ids ? needed(*ids, "POSITION", there + "/attributes") : 0};
                     }
                     primitives.push_back(out);
                 });
        });
    }

    static GltfMatrix matrix_of(const std::array<double, 3>& t, const std::array<double, 4>& q,
                                const std::array<double, 3>& s) {
        const auto [x, y, z, w] = q;
        return {(1 - 2 * (y * y + z * z)) * s[0],
                2 * (x * y + z * w) * s[0],
                2 * (x * z - y * w) * s[0],
                0,
                2 * (x * y - z * w) * s[1],
                (1 - 2 * (x * x + z * z)) * s[1],
                2 * (y * z + x * w) * s[1],
                0,
                2 * (x * z + y * w) * s[2],
                2 * (y * z - x * w) * s[2],
                (1 - 2 * (x * x + y * y)) * s[2],
                0,
                t[0],
                t[1],
                t[2],
                1};
    }

    void read_nodes(const JsonText& document) {
        const auto begin = [&](std::size_t all) { model_.nodes.reserve(all); };
        each(document, "nodes", "", begin, [&](const JsonText& node, const std::string& pointer) {
            GltfNode out;
            out.mesh = index(node, "mesh", pointer);
            out.is_skinned = node.member("skin").has_value();
            out.children = indices(node, "children", pointer);
            if (extension(node, "EXT_mesh_gpu_instancing"))
                fault(FaultKind::Unsupported, "GLTF_EXTENSION",
                      "Instances by EXT_mesh_gpu_instancing are not read.", pointer);
            GltfMatrix matrix{};
            std::array<double, 3> translation{0, 0, 0}, scale{1, 1, 1};
            std::array<double, 4> rotation{0, 0, 0, 1};
            bool is_placed = read_numbers(node, "matrix", pointer, matrix);
            if (!is_placed) {
                is_placed |= read_numbers(node, "translation", pointer, translation);
                is_placed |= read_numbers(node, "rotation", pointer, rotation);
                is_placed |= read_numbers(node, "scale", pointer, scale);
                matrix = matrix_of(translation, rotation, scale);
            }
            if (is_placed) {
                out.matrix = static_cast<std::uint32_t>(model_.matrices.size());
                model_.matrices.push_back(matrix);
            }
            model_.nodes.push_back(std::move(out));
        });
    }

    std::vector<std::size_t> indices(const JsonText& object, const char* name,
                                     const std::string& pointer) {
        std::vector<std::size_t> out;
        const auto list = object.member(name);
        const std::string here = pointer + "/" + name;
        if (!list || !list->is_array()) return out;
        const std::size_t elements = list->element_count();
        if (!count(indices_, elements, "children of nodes in all", here)) return out;
        out.reserve(elements);
        std::size_t i = 0;
        for (JsonText::Elements all(*list); const auto element = all.next(); ++i) {
            if (const auto n = whole(*element, here + "/" + std::to_string(i))) out.push_back(*n);
        }
        return out;
    }

    /// The scene that the file wants shown, or its first; without any, all nodes on top.
    void read_scene(const JsonText& document) {
        const std::size_t which = number(document, "scene", "", 0);
        std::size_t at = 0;
        bool found = false;
        const auto begin = [](std::size_t) {};
        each(document, "scenes", "", begin, [&](const JsonText& scene, const std::string& pointer) {
            if (at++ != which) return;
            found = true;
            model_.roots = indices(scene, "nodes", pointer);
            if (!model_.is_ours) return;
            if (const auto extras = scene.member("extras")) {
                model_.is_z_up = text(*extras, "up") == "z";
                model_.crs = text(*extras, "crs");
                const auto unit = extras->member("unit_to_metre");
                if (const auto metres = unit ? number_of(*unit) : std::nullopt)
                    model_.unit_to_metre = *metres;
            }
        });
        if (found) return;
        if (at > 0) return invalid("There is no such scene.", "/scene");
        std::vector<bool> is_child(model_.nodes.size(), false);
        for (const GltfNode& node : model_.nodes)
            for (const std::size_t child : node.children)
                if (child < is_child.size()) is_child[child] = true;
        for (std::size_t i = 0; i < is_child.size(); ++i)
            if (!is_child[i]) model_.roots.push_back(i);
    }

    GltfModel model_;
    std::size_t indices_ = 0;  ///< of nodes under nodes and scenes, so far
};

}  // namespace

std::optional<GltfModel> read_gltf_model(std::string_view bytes, FaultLog& log) {
    return ModelReader(log).read(bytes);
}

}  // namespace tinsmith::api
