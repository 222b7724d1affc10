// SPDX-License-Identifier: Apache-2.0
#include "api/formats/draco_decoder.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <draco/compression/decode.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/mesh/mesh.h>

namespace tinsmith::api {

namespace {

/// What may be promised, and what was wrong with what is.
struct Allowance {
    std::size_t triangles = 0;
    std::size_t points = 0;
    std::size_t attribute_bytes = 0;
    bool passed = false;  ///< one of them was passed
};

/// Reads the counts that come first without moving on. Draco has checked nothing of them yet.
bool counts_fit(const draco::DecoderBuffer& buffer, bool points_first, Allowance& allowance) {
    draco::DecoderBuffer look = buffer;
    std::uint32_t first = 0, second = 0;
    if (!draco::DecodeVarint(&first, &look) || !draco::DecodeVarint(&second, &look)) return false;
    const std::uint32_t points = points_first ? first : second;
    const std::uint32_t triangles = points_first ? second : first;
    // EdgeBreaker's points are split later on; at most each corner has its own.
    allowance.passed = points > allowance.points || triangles > allowance.triangles;
    return !allowance.passed;
}

/// What all attributes will take, now that their kinds are known and their values are not.
bool attributes_fit(const draco::PointCloud& cloud, Allowance& allowance) {
    std::size_t each = 0;
    for (int i = 0; i < cloud.num_attributes(); ++i) {
        const auto* attribute = cloud.attribute(i);
        // Once as it is packed, once as it is told, and the map to it.
        each +=
            2 * static_cast<std::size_t>(attribute->num_components()) *
                std::max<std::size_t>(
                    4, static_cast<std::size_t>(draco::DataTypeLength(attribute->data_type()))) +
            4;
    }
    allowance.passed =
        cloud.num_points() > 0 && each > allowance.attribute_bytes / cloud.num_points();
    return !allowance.passed;
}

class EdgeBreaker : public draco::MeshEdgebreakerDecoder {
  public:
    explicit EdgeBreaker(Allowance& allowance) : allowance_(allowance) {}

  protected:
    bool DecodeConnectivity() override {
        return counts_fit(*buffer(), true, allowance_) &&
               MeshEdgebreakerDecoder::DecodeConnectivity();
    }
    bool DecodeAllAttributes() override {
        return attributes_fit(*point_cloud(), allowance_) &&
               MeshEdgebreakerDecoder::DecodeAllAttributes();
    }

  private:
    Allowance& allowance_;
};

class Sequential : public draco::MeshSequentialDecoder {
  public:
    explicit Sequential(Allowance& allowance) : allowance_(allowance) {}

  protected:
    bool DecodeConnectivity() override {
        return counts_fit(*buffer(), false, allowance_) &&
               MeshSequentialDecoder::DecodeConnectivity();
    }
    bool DecodeAllAttributes() override {
        return attributes_fit(*point_cloud(), allowance_) &&
               MeshSequentialDecoder::DecodeAllAttributes();
    }

  private:
    Allowance& allowance_;
};

std::variant<DracoMesh, DracoRefusal> taken_from(const draco::Mesh& from, std::size_t position_id) {
    const auto* attribute =
        position_id > std::numeric_limits<std::uint32_t>::max()
            ? nullptr
            : from.GetAttributeByUniqueId(static_cast<std::uint32_t>(position_id));
    if (attribute == nullptr || attribute->num_components() != 3)
        return DracoRefusal{"It has no attribute of three components with the id " +
                            std::to_string(position_id) + "."};
    DracoMesh mesh;
    mesh.positions.reserve(from.num_points());
    for (std::uint32_t i = 0; i < from.num_points(); ++i) {
        std::array<double, 3> p{};
        const auto value = attribute->mapped_index(draco::PointIndex(i));
        if (value.value() >= attribute->size() ||
            !attribute->ConvertValue<double, 3>(value, p.data()))
            return DracoRefusal{"A position is missing from it."};
        mesh.positions.push_back({p[0], p[1], p[2]});
    }
    mesh.triangles.reserve(from.num_faces());
    for (std::uint32_t i = 0; i < from.num_faces(); ++i) {
        const auto& face = from.face(draco::FaceIndex(i));
        const std::array<std::uint32_t, 3> corners{face[0].value(), face[1].value(),
                                                   face[2].value()};
        if (std::max({corners[0], corners[1], corners[2]}) >= mesh.positions.size())
            return DracoRefusal{"A triangle names a point that is not there."};
        mesh.triangles.push_back(corners);
    }
    return mesh;
}

draco::Status decode(draco::MeshDecoder&& decoder, draco::DecoderBuffer& buffer,
                     draco::Mesh& mesh) {
    const draco::DecoderOptions options;
    return decoder.Decode(options, &buffer, &mesh);
}

}  // namespace

std::variant<DracoMesh, DracoRefusal> decode_draco(std::string_view bytes, std::size_t position_id,
                                                   std::size_t max_vertices,
                                                   std::size_t max_triangles) {
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::DecoderBuffer look = buffer;
    draco::DracoHeader header{};
    if (!draco::PointCloudDecoder::DecodeHeader(&look, &header).ok() ||
        header.encoder_type != draco::TRIANGULAR_MESH)
        return DracoRefusal{"It does not begin as a mesh in Draco does."};
    if (header.encoder_method != draco::MESH_EDGEBREAKER_ENCODING &&
        header.encoder_method != draco::MESH_SEQUENTIAL_ENCODING)
        return DracoRefusal{"It is packed by a method that is not known."};
    if (header.version_major != 2 || header.version_minor != 2)
        return DracoRefusal{"It is of bitstream " + std::to_string(header.version_major) + "." +
                            std::to_string(header.version_minor) + "; glTF has 2.2."};
    const std::size_t promised = bytes.size() * kMostDracoPerByte;
    Allowance allowance;
    allowance.triangles = std::min(max_triangles, promised);
    allowance.points = std::min(max_vertices, promised);
    constexpr std::size_t kBytesForEach = 512, kMostBytes = std::size_t{1} << 29;
    allowance.attribute_bytes = std::min(allowance.points * kBytesForEach, kMostBytes);
    draco::Mesh mesh;
    const draco::Status status = header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING
                                     ? decode(EdgeBreaker(allowance), buffer, mesh)
                                     : decode(Sequential(allowance), buffer, mesh);
    if (allowance.passed)
        return DracoRefusal{"It promises more than " + std::to_string(allowance.points) +
                                " points, " + std::to_string(allowance.triangles) +
                                " triangles or " + std::to_string(allowance.attribute_bytes) +
                                " bytes of attributes, which its bytes cannot hold or this "
                                "server does not allow.",
                            true};
    if (!status.ok()) return DracoRefusal{"Draco cannot decode it: " + status.error_msg_string()};
    return taken_from(mesh, position_id);
}

}  // namespace tinsmith::api
