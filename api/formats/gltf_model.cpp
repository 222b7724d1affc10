// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gltf_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "api/formats/base64.hpp"
#include "api/formats/glb_chunks.hpp"
#include "api/formats/json_reader.hpp"
#include "api/formats/json_size.hpp"

namespace tinsmith::api {

namespace {

using Json = nlohmann::json;

constexpr JsonLimits kDocument{4'000'000, 100};
constexpr std::size_t kMostIndex = std::size_t{1} << 40;  ///< no count or offset is beyond

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

class ModelReader {
  public:
    explicit ModelReader(FaultLog& log) : log_(log) {}

    std::optional<GltfModel> read(std::string_view bytes) {
        const auto chunks = split_glb(bytes, log_);
        if (!chunks) return std::nullopt;
        const std::size_t before = log_.size();
        Json document;
        if (!parse(chunks->json, document)) return std::nullopt;
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
    void fault(FaultKind kind, std::string code, std::string detail, std::string pointer = {}) {
        log_.add(kind, {std::move(code), std::move(detail), std::move(pointer)});
    }
    void invalid(std::string detail, std::string pointer) {
        fault(FaultKind::Invalid, "GLTF_INVALID", std::move(detail), std::move(pointer));
    }

    bool parse(std::string_view text, Json& document) {
        const JsonSound seen = look_through_json(text, kDocument);
        if (!seen.is_sound) {
            if (seen.is_too_much)
                fault(FaultKind::TooLarge, "GLTF_DOCUMENT",
                      "The file's JSON is nested deeper than " + std::to_string(kDocument.depth) +
                          " or has more than " + std::to_string(kDocument.values) + " values.");
            else
                fault(FaultKind::Syntax, "GLTF_SYNTAX",
                      "The file's JSON cannot be read at byte " + std::to_string(seen.wrong_byte) +
                          ".");
            return false;
        }
        document = Json::parse(text.begin(), text.end());
        if (document.is_object()) return true;
        fault(FaultKind::Syntax, "GLTF_SYNTAX", "A glTF is a JSON object.");
        return false;
    }

    // What members hold. A member that is there and of another kind is a fault.

    const Json* member(const Json& object, const char* name) const {
        if (!object.is_object()) return nullptr;
        const auto found = object.find(name);
        return found == object.end() ? nullptr : &*found;
    }
    std::optional<std::size_t> whole(const Json& value, const std::string& pointer) {
        if (value.is_number_unsigned() && value.get<std::uint64_t>() <= kMostIndex)
            return value.get<std::size_t>();
        if (value.is_number_float()) {
            const double number = value.get<double>();
            if (number >= 0.0 && number <= 1e12 && number == std::floor(number))
                return static_cast<std::size_t>(number);
        }
        invalid("A whole number of 0 or more belongs here.", pointer);
        return std::nullopt;
    }
    std::optional<std::size_t> index(const Json& object, const char* name,
                                     const std::string& pointer) {
        const Json* value = member(object, name);
        return value == nullptr ? std::nullopt : whole(*value, pointer + "/" + name);
    }
    std::size_t number(const Json& object, const char* name, const std::string& pointer,
                       std::size_t otherwise) {
        return index(object, name, pointer).value_or(otherwise);
    }
    std::size_t needed(const Json& object, const char* name, const std::string& pointer) {
        if (member(object, name) == nullptr)
            invalid(std::string("There is no \"") + name + "\" here.", pointer);
        return number(object, name, pointer, 0);
    }
    std::string text(const Json& object, const char* name) const {
        const Json* value = member(object, name);
        return value != nullptr && value->is_string() ? value->get<std::string>() : std::string();
    }
    bool flag(const Json& object, const char* name) const {
        const Json* value = member(object, name);
        return value != nullptr && value->is_boolean() && value->get<bool>();
    }
    /// Calls `what` with each element of the list and its pointer; elements are objects.
    template <typename What>
    void each(const Json& object, const char* name, const std::string& pointer, What what) {
        const Json* list = member(object, name);
        if (list == nullptr) return;
        const std::string here = pointer + "/" + name;
        if (!list->is_array()) return invalid("A list belongs here.", here);
        for (std::size_t i = 0; i < list->size(); ++i) {
            const std::string place = here + "/" + std::to_string(i);
            if ((*list)[i].is_object()) {
                what((*list)[i], place);
            } else {
                invalid("An object belongs here.", place);
                what(Json::object(), place);
            }
        }
    }
    const Json* extension(const Json& object, const char* name) const {
        const Json* all = member(object, "extensions");
        const Json* one = all == nullptr ? nullptr : member(*all, name);
        return one != nullptr && one->is_object() ? one : nullptr;
    }
    template <std::size_t N>
    bool read_numbers(const Json& object, const char* name, const std::string& pointer,
                      std::array<double, N>& out) {
        const Json* list = member(object, name);
        if (list == nullptr) return false;
        const bool fits =
            list->is_array() && list->size() == N &&
            std::all_of(list->begin(), list->end(), [](const Json& n) { return n.is_number(); });
        if (!fits) {
            invalid("A list of " + std::to_string(N) + " numbers belongs here.",
                    pointer + "/" + name);
            return false;
        }
        for (std::size_t i = 0; i < N; ++i)
            out[i] = (*list)[i].get<double>();
        return true;
    }

    void read_asset(const Json& document) {
        const Json* asset = member(document, "asset");
        if (asset == nullptr || !asset->is_object())
            return invalid("There is no \"asset\": is this a glTF?", "");
        if (!text(*asset, "version").starts_with("2."))
            fault(FaultKind::Unsupported, "GLTF_VERSION", "Only glTF 2.0 is read.",
                  "/asset/version");
        model_.is_ours = text(*asset, "generator") == "Tinsmith";
    }

    void read_extensions(const Json& document) {
        const Json* list = member(document, "extensionsRequired");
        if (list == nullptr || !list->is_array()) return;
        for (std::size_t i = 0; i < list->size(); ++i) {
            const std::string name = (*list)[i].is_string() ? (*list)[i].get<std::string>() : "";
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

    void read_buffers(const Json& document, std::optional<std::string_view> bin) {
        // Views into `decoded` stay where they are: it is filled before they are taken.
        std::vector<std::pair<std::size_t, std::size_t>> own;
        each(document, "buffers", "", [&](const Json& buffer, const std::string& pointer) {
            const std::size_t length = needed(buffer, "byteLength", pointer);
            std::string_view& bytes = model_.buffers.emplace_back();
            const Json* uri = member(buffer, "uri");
            if (uri == nullptr || !uri->is_string()) {
                // Others without bytes are there for clients that cannot decompress.
                if (model_.buffers.size() > 1 || !bin) return;
                bytes = bin->substr(0, length);
                return hold(length, bytes.size(), pointer);
            }
            const auto& name = uri->get_ref<const std::string&>();
            const std::size_t comma = name.find(',');
            const bool is_data = name.starts_with("data:") && comma != name.npos &&
                                 std::string_view(name).substr(0, comma).ends_with(";base64");
            if (!is_data) {
                fault(FaultKind::Unsupported, "GLTF_URI",
                      "The file's bytes are elsewhere, at " + json::quoted(name) +
                          ": nothing is fetched. Pack it into one file (GLB) first.",
                      pointer + "/uri");
                return;
            }
            auto decoded = decode_base64(std::string_view(name).substr(comma + 1));
            if (!decoded) return invalid("This is no base64.", pointer + "/uri");
            hold(length, decoded->size(), pointer);
            own.emplace_back(model_.buffers.size() - 1, model_.decoded.size());
            model_.decoded.push_back(std::move(*decoded));
        });
        for (const auto& [buffer, which] : own)
            model_.buffers[buffer] = model_.decoded[which];
    }

    void read_views(const Json& document) {
        each(document, "bufferViews", "", [&](const Json& view, const std::string& pointer) {
            GltfView out;
            out.buffer = needed(view, "buffer", pointer);
            out.offset = number(view, "byteOffset", pointer, 0);
            out.length = needed(view, "byteLength", pointer);
            out.stride = number(view, "byteStride", pointer, 0);
            if (const Json* packed = extension(view, "EXT_meshopt_compression")) {
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

    void read_accessors(const Json& document) {
        each(document, "accessors", "", [&](const Json& accessor, const std::string& pointer) {
            GltfAccessor out;
            out.view = index(accessor, "bufferView", pointer);
            out.offset = number(accessor, "byteOffset", pointer, 0);
            out.count = needed(accessor, "count", pointer);
            out.component = needed(accessor, "componentType", pointer);
            out.type = text(accessor, "type");
            out.normalized = flag(accessor, "normalized");
            out.sparse = member(accessor, "sparse") != nullptr;
            model_.accessors.push_back(std::move(out));
        });
    }

    void read_meshes(const Json& document) {
        each(document, "meshes", "", [&](const Json& mesh, const std::string& pointer) {
            auto& primitives = model_.meshes.emplace_back();
            each(mesh, "primitives", pointer, [&](const Json& from, const std::string& place) {
                GltfPrimitive out;
                out.pointer = place;
                out.mode = number(from, "mode", place, 4);
                out.indices = index(from, "indices", place);
                if (const Json* attributes = member(from, "attributes"))
                    out.position = index(*attributes, "POSITION", place + "/attributes");
                if (const Json* draco = extension(from, "KHR_draco_mesh_compression")) {
                    const std::string there = place + "/extensions/KHR_draco_mesh_compression";
                    const Json* ids = member(*draco, "attributes");
                    out.draco = GltfDraco{
                        needed(*draco, "bufferView", there),
                        ids == nullptr ? 0 : needed(*ids, "POSITION", there + "/attributes")};
                }
                primitives.push_back(std::move(out));
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

    void read_nodes(const Json& document) {
        each(document, "nodes", "", [&](const Json& node, const std::string& pointer) {
            GltfNode out;
            out.mesh = index(node, "mesh", pointer);
            out.is_skinned = member(node, "skin") != nullptr;
            out.children = indices(node, "children", pointer);
            if (extension(node, "EXT_mesh_gpu_instancing") != nullptr)
                fault(FaultKind::Unsupported, "GLTF_EXTENSION",
                      "Instances by EXT_mesh_gpu_instancing are not read.", pointer);
            if (!read_numbers(node, "matrix", pointer, out.matrix)) {
                std::array<double, 3> translation{0, 0, 0}, scale{1, 1, 1};
                std::array<double, 4> rotation{0, 0, 0, 1};
                read_numbers(node, "translation", pointer, translation);
                read_numbers(node, "rotation", pointer, rotation);
                read_numbers(node, "scale", pointer, scale);
                out.matrix = matrix_of(translation, rotation, scale);
            }
            model_.nodes.push_back(std::move(out));
        });
    }

    std::vector<std::size_t> indices(const Json& object, const char* name,
                                     const std::string& pointer) {
        std::vector<std::size_t> out;
        const Json* list = member(object, name);
        if (list == nullptr || !list->is_array()) return out;
        for (std::size_t i = 0; i < list->size(); ++i) {
            if (const auto n = whole((*list)[i], pointer + "/" + name + "/" + std::to_string(i)))
                out.push_back(*n);
        }
        return out;
    }

    /// The scene that the file wants shown, or its first; without any, all nodes on top.
    void read_scene(const Json& document) {
        const std::size_t which = number(document, "scene", "", 0);
        std::size_t at = 0;
        bool found = false;
        each(document, "scenes", "", [&](const Json& scene, const std::string& pointer) {
            if (at++ != which) return;
            found = true;
            model_.roots = indices(scene, "nodes", pointer);
            if (!model_.is_ours) return;
            if (const Json* extras = member(scene, "extras")) {
                model_.is_z_up = text(*extras, "up") == "z";
                model_.crs = text(*extras, "crs");
                const Json* unit = member(*extras, "unit_to_metre");
                if (unit != nullptr && unit->is_number())
                    model_.unit_to_metre = unit->get<double>();
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

    FaultLog& log_;
    GltfModel model_;
};

}  // namespace

std::optional<GltfModel> read_gltf_model(std::string_view bytes, FaultLog& log) {
    return ModelReader(log).read(bytes);
}

}  // namespace tinsmith::api
