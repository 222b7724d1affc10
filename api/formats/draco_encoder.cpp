// SPDX-License-Identifier: Apache-2.0
#include "api/formats/draco_encoder.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

namespace tinsmith::api {
namespace {

draco::PointAttribute* add_vectors(draco::Mesh& mesh, draco::GeometryAttribute::Type type,
                                   std::size_t count) {
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, 3, draco::DT_FLOAT32, false, 3 * sizeof(float), 0);
    // Identity mapping: vertex i has value i, so that equal positions stay two vertices and a
    // collapsed triangle is kept, as its neighbours need it.
    const int id = mesh.AddAttribute(attribute, true, static_cast<std::uint32_t>(count));
    return mesh.attribute(id);
}

void set_positions(draco::PointAttribute& attribute, const DracoPiece& piece, float step) {
    auto* out = reinterpret_cast<float*>(attribute.buffer()->data());
    for (const GridPoint& point : piece.positions) {
        for (const std::int32_t n : point)
            *out++ = static_cast<float>(n) * step;
    }
}

void set_normals(draco::PointAttribute& attribute, const DracoPiece& piece) {
    auto* out = reinterpret_cast<float*>(attribute.buffer()->data());
    for (const std::array<float, 3>& normal : piece.normals)
        out = std::copy(normal.begin(), normal.end(), out);
}

/// Whole numbers pass through Draco bit for bit.
int add_feature(draco::Mesh& mesh, std::uint16_t feature, std::size_t count) {
    draco::GeometryAttribute attribute;
    attribute.Init(draco::GeometryAttribute::GENERIC, nullptr, 1, draco::DT_UINT16, false,
                   sizeof(feature), 0);
    draco::PointAttribute* made =
        mesh.attribute(mesh.AddAttribute(attribute, true, static_cast<std::uint32_t>(count)));
    auto* out = reinterpret_cast<std::uint16_t*>(made->buffer()->data());
    std::fill(out, out + count, feature);
    return static_cast<int>(made->unique_id());
}

void set_triangles(draco::Mesh& mesh, const DracoPiece& piece) {
    mesh.SetNumFaces(piece.triangles.size());
    for (std::uint32_t i = 0; i < piece.triangles.size(); ++i) {
        const auto& [a, b, c] = piece.triangles[i];
        draco::Mesh::Face face;
        face[0] = draco::PointIndex(a);
        face[1] = draco::PointIndex(b);
        face[2] = draco::PointIndex(c);
        mesh.SetFace(draco::FaceIndex(i), face);
    }
}

/// n * 2^exponent in hexadecimal, as strtof reads it: exact, and the same in every locale.
std::string exact_text(std::int32_t n, int exponent) {
    std::array<char, 16> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), std::abs(n), 16);
    return (n < 0 ? "-0x" : "0x") + std::string(digits.data(), end.ptr) + "p" +
           std::to_string(exponent);
}

/// The explicit quantization whose every product and sum is exact in float32: the origin is a
/// corner of the grid, and range / (2^bits - 1) is the step itself.
struct Quantization {
    GridPoint origin{};
    unsigned bits = 1;
};

Quantization quantization_for(const DracoPiece& piece) {
    Box<std::int32_t> box;
    for (const GridPoint& point : piece.positions)
        box.add(point);
    std::int32_t extent = 1;
    for (std::size_t axis = 0; axis < 3; ++axis)
        extent = std::max(extent, box.high[axis] - box.low[axis]);
    return {box.low, static_cast<unsigned>(std::bit_width(static_cast<std::uint32_t>(extent)))};
}

/// What SetAttributeExplicitQuantization does, but exactly: that one passes the floats through
/// std::to_string, which keeps six decimals, and an origin of 1.0078125 becomes 1.007812.
void quantize_positions(draco::Encoder& encoder, const Quantization& quantization, int exponent) {
    std::string origin;
    for (const std::int32_t n : quantization.origin)
        origin += exact_text(n, exponent) + " ";
    const std::int32_t range = (std::int32_t{1} << quantization.bits) - 1;
    draco::Options exact;
    exact.SetInt("quantization_bits", static_cast<int>(quantization.bits));
    exact.SetString("quantization_origin", origin);
    exact.SetString("quantization_range", exact_text(range, exponent));
    encoder.options().SetAttributeOptions(draco::GeometryAttribute::POSITION, exact);
}

/// Vertices and triangles as EdgeBreaker has encoded them, by the head of its bytes. Draco can
/// count them itself, after the encoding and by walking through the mesh once more: a twentieth of
/// the time. What is read here is right while all attributes share one connectivity, as they do at
/// this speed.
///
///     "DRACO" | major minor | type method | flags, 16 bits | traversal | vertices | triangles
///                                                                        7 bits a byte, low first
class EncodedCounts {
  public:
    explicit EncodedCounts(std::string_view bytes) : bytes_(bytes) {
        vertices = next();
        triangles = next();
    }

    std::size_t vertices = 0;
    std::size_t triangles = 0;

  private:
    std::size_t next() {
        std::size_t value = 0;
        for (unsigned shift = 0; at_ < bytes_.size() && shift < 35; shift += 7) {
            const auto byte = static_cast<unsigned char>(bytes_[at_++]);
            value |= static_cast<std::size_t>(byte & 0x7FU) << shift;
            if ((byte & 0x80U) == 0) break;
        }
        return value;
    }

    std::string_view bytes_;
    std::size_t at_ = 12;
};

}  // namespace

std::variant<DracoBytes, EncodeError> encode_draco(const DracoPiece& piece) {
    const float step = std::ldexp(1.0F, piece.exponent);
    const Quantization quantization = quantization_for(piece);
    if (quantization.bits > kDracoBits)
        return EncodeError{EncodeFault::Codec, "the piece is too wide for exact Draco positions"};

    draco::Mesh mesh;
    mesh.set_num_points(static_cast<std::uint32_t>(piece.positions.size()));
    draco::PointAttribute* positions =
        add_vectors(mesh, draco::GeometryAttribute::POSITION, piece.positions.size());
    set_positions(*positions, piece, step);
    DracoBytes result;
    result.position_id = static_cast<int>(positions->unique_id());
    if (!piece.normals.empty()) {
        draco::PointAttribute* normals =
            add_vectors(mesh, draco::GeometryAttribute::NORMAL, piece.normals.size());
        set_normals(*normals, piece);
        result.normal_id = static_cast<int>(normals->unique_id());
    }
    for (const std::uint16_t feature : piece.features)
        result.feature_ids.push_back(add_feature(mesh, feature, piece.positions.size()));
    set_triangles(mesh, piece);

    draco::Encoder encoder;
    encoder.SetSpeedOptions(kDracoSpeed, kDracoSpeed);
    encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    quantize_positions(encoder, quantization, piece.exponent);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, kDracoNormalBits);
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder.EncodeMeshToBuffer(mesh, &buffer);
    if (!status.ok()) return EncodeError{EncodeFault::Codec, "Draco: " + status.error_msg_string()};
    result.bytes.assign(buffer.data(), buffer.size());
    result.position_bits = quantization.bits;
    const EncodedCounts counts(result.bytes);
    result.points = counts.vertices;
    result.triangles = counts.triangles;
    return result;
}

}  // namespace tinsmith::api
