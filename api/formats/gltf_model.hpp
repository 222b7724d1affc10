// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/fault.hpp"
#include "api/formats/fault_log.hpp"
#include "api/formats/read_limits.hpp"

namespace tinsmith::api {

/// EXT_meshopt_compression of a view: where the compressed bytes are and what becomes of them.
struct GltfMeshopt {
    std::size_t buffer = 0;
    std::size_t offset = 0;
    std::size_t length = 0;
    std::size_t stride = 0;
    std::size_t count = 0;
    std::string mode;
    std::string filter;
};

struct GltfView {
    std::size_t buffer = 0;
    std::size_t offset = 0;
    std::size_t length = 0;
    std::size_t stride = 0;  ///< 0: without gaps
    std::optional<GltfMeshopt> meshopt;
};

struct GltfAccessor {
    std::optional<std::size_t> view;
    std::size_t offset = 0;
    std::size_t count = 0;
    std::size_t component = 0;  ///< 5126: float
    std::string type;
    bool normalized = false;
    bool sparse = false;
};

/// KHR_draco_mesh_compression of a primitive.
struct GltfDraco {
    std::size_t view = 0;
    std::size_t position_id = 0;
};

struct GltfPrimitive {
    std::size_t mode = 4;
    std::optional<std::size_t> position;
    std::optional<std::size_t> indices;
    std::optional<GltfDraco> draco;
    std::uint32_t mesh = 0;  ///< where it is in the file
    std::uint32_t number = 0;

    /// Into the file's JSON.
    std::string pointer() const {
        return "/meshes/" + std::to_string(mesh) + "/primitives/" + std::to_string(number);
    }
};

/// Column by column, as glTF has it.
using GltfMatrix = std::array<double, 16>;

struct GltfNode {
    std::optional<std::size_t> mesh;
    std::vector<std::size_t> children;
    std::optional<std::uint32_t> matrix;  ///< into GltfModel::matrices; nothing: it stays in place
    bool is_skinned = false;
};

/// What a glTF says of its geometry. Indices may still point anywhere; spans are still unchecked.
struct GltfModel {
    std::vector<std::string_view> buffers;  ///< of the file, or of `decoded`; empty: a fallback
    std::vector<std::string> decoded;       ///< what stood in data: URIs
    std::vector<GltfView> views;
    std::vector<GltfAccessor> accessors;
    std::vector<std::vector<GltfPrimitive>> meshes;
    std::vector<GltfNode> nodes;
    std::deque<GltfMatrix> matrices;
    std::vector<std::size_t> roots;  ///< of the scene that is shown
    bool is_ours = false;            ///< lines are constraints, and extras may be believed
    bool is_z_up = false;
    std::string crs;             ///< as the extras say; not normalised
    double unit_to_metre = 1.0;  ///< as the extras say, unchecked
};

/// Takes a glTF apart, binary or JSON with data: URIs. Knows nothing of other files: a URI that
/// names one is refused by name. Faults are added to the log, with pointers into the file's JSON.
/// Views into `bytes` are kept. Nothing of the document is built: memory is what the model takes,
/// of kMostGltfParts at most.
std::optional<GltfModel> read_gltf_model(std::string_view bytes, FaultLog& log);

}  // namespace tinsmith::api
