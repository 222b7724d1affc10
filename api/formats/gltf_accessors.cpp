// SPDX-License-Identifier: Apache-2.0
#include "api/formats/gltf_accessors.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <utility>

#include "api/formats/meshopt_decoder.hpp"

namespace tinsmith::api {

namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

constexpr std::size_t kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
                      kUnsignedInt = 5125, kFloat = 5126;

std::size_t size_of(std::size_t component) {
    switch (component) {
        case kByte:
        case kUnsignedByte:
            return 1;
        case kShort:
        case kUnsignedShort:
            return 2;
        case kUnsignedInt:
        case kFloat:
            return 4;
        default:
            return 0;
    }
}

template <typename T>
T at(const char* from) {
    T value{};
    std::memcpy(&value, from, sizeof value);
    return value;
}

/// An integer as it is, or as a fraction of its largest where it is normalized.
template <typename T>
double integer(const char* from, bool normalized) {
    const double value = at<T>(from);
    if (!normalized) return value;
    return std::max(-1.0, value / double{std::numeric_limits<T>::max()});
}

double coordinate(const char* from, std::size_t component, bool normalized) {
    switch (component) {
        case kByte:
            return integer<std::int8_t>(from, normalized);
        case kUnsignedByte:
            return integer<std::uint8_t>(from, normalized);
        case kShort:
            return integer<std::int16_t>(from, normalized);
        case kUnsignedShort:
            return integer<std::uint16_t>(from, normalized);
        default:
            return double{at<float>(from)};
    }
}

std::string pointer_to(std::string_view list, std::size_t i) {
    return "/" + std::string(list) + "/" + std::to_string(i);
}

}  // namespace

void GltfAccessors::fault(std::string detail, const std::string& pointer) {
    log_.add(FaultKind::Invalid, {"GLTF_INVALID", std::move(detail), pointer});
}

std::optional<std::string_view> GltfAccessors::span(std::size_t buffer, std::size_t offset,
                                                    std::size_t length,
                                                    const std::string& pointer) {
    if (buffer >= model_.buffers.size()) {
        fault("There is no buffer " + std::to_string(buffer) + ".", pointer);
        return std::nullopt;
    }
    const std::string_view bytes = model_.buffers[buffer];
    if (offset > bytes.size() || length > bytes.size() - offset) {
        fault("It ends at byte " + std::to_string(offset + length) + " of a buffer that has " +
                  std::to_string(bytes.size()) + ".",
              pointer);
        return std::nullopt;
    }
    return bytes.substr(offset, length);
}

std::optional<std::string_view> GltfAccessors::view_bytes(std::size_t view,
                                                          const std::string& pointer) {
    if (view >= model_.views.size()) {
        fault("There is no bufferView " + std::to_string(view) + ".", pointer);
        return std::nullopt;
    }
    const GltfView& from = model_.views[view];
    const std::string here = pointer_to("bufferViews", view);
    if (!from.meshopt) return span(from.buffer, from.offset, from.length, here);
    const auto known = unpacked_.find(view);
    if (known != unpacked_.end()) return known->second;
    const auto packed =
        span(from.meshopt->buffer, from.meshopt->offset, from.meshopt->length, here);
    if (!packed) return std::nullopt;
    const std::size_t stride = std::max<std::size_t>(from.meshopt->stride, 1);
    auto unpacked = decode_meshopt(*from.meshopt, *packed, room_ / stride);
    if (auto* no = std::get_if<Fault>(&unpacked)) {
        no->pointer = here;
        log_.add(FaultKind::Invalid, std::move(*no));
        return std::nullopt;
    }
    room_ -= std::min(room_, std::get<std::string>(unpacked).size());
    return unpacked_.emplace(view, std::get<std::string>(std::move(unpacked))).first->second;
}

std::optional<GltfAccessors::Elements> GltfAccessors::elements(std::size_t accessor,
                                                               std::size_t components,
                                                               std::size_t most) {
    const std::string here = pointer_to("accessors", accessor);
    const auto no = [&](std::string detail) {
        fault(std::move(detail), here);
        return std::nullopt;
    };
    if (accessor >= model_.accessors.size()) return no("There is no such accessor.");
    const GltfAccessor& from = model_.accessors[accessor];
    if (from.type != (components == 1 ? "SCALAR" : "VEC3"))
        return no("It is not of type " + std::string(components == 1 ? "SCALAR." : "VEC3."));
    if (from.sparse) {
        log_.add(FaultKind::Unsupported,
                 {"GLTF_SPARSE", "Sparse accessors are not read; write it without.", here});
        return std::nullopt;
    }
    if (!from.view) return no("It has no bufferView, so that all its numbers are 0.");
    if (from.count > most) {
        log_.add(FaultKind::TooLarge,
                 {"TOO_MANY_VERTICES",
                  "It has " + std::to_string(from.count) + " elements; no more than " +
                      std::to_string(most) + " are taken.",
                  here});
        return std::nullopt;
    }
    const std::size_t size = size_of(from.component) * components;
    if (size == 0) return no("Its componentType is not known.");
    const auto bytes = view_bytes(*from.view, here);
    if (!bytes) return std::nullopt;
    const GltfView& view = model_.views[*from.view];
    const std::size_t given = view.meshopt ? view.meshopt->stride : view.stride;
    const std::size_t stride = given == 0 ? size : given;
    if (stride < size || stride > 256) return no("Its view's byteStride does not fit it.");
    // No product overflows: counts are held against `most` and strides are below 256.
    const std::size_t needed = from.count == 0 ? 0 : (from.count - 1) * stride + size;
    if (from.offset > bytes->size() || needed > bytes->size() - from.offset)
        return no("It ends at byte " + std::to_string(from.offset + needed) +
                  " of a bufferView that has " + std::to_string(bytes->size()) + ".");
    return Elements{bytes->substr(from.offset), from.count, stride, from.component};
}

std::optional<std::vector<core::Point3>> GltfAccessors::positions(std::size_t accessor) {
    const auto from =
        elements(accessor, 3, std::max(limits_.max_vertices, 3 * limits_.max_triangles));
    if (!from) return std::nullopt;
    if (from->component == kUnsignedInt) {
        fault("Positions are floats, or integers of one or two bytes.",
              pointer_to("accessors", accessor));
        return std::nullopt;
    }
    const bool normalized = model_.accessors[accessor].normalized;
    const std::size_t size = size_of(from->component);
    std::vector<core::Point3> out;
    out.reserve(from->count);
    for (std::size_t i = 0; i < from->count; ++i) {
        const char* p = from->bytes.data() + i * from->stride;
        out.push_back({coordinate(p, from->component, normalized),
                       coordinate(p + size, from->component, normalized),
                       coordinate(p + 2 * size, from->component, normalized)});
    }
    return out;
}

std::optional<std::vector<std::uint32_t>> GltfAccessors::indices(std::size_t accessor) {
    const auto from = elements(accessor, 1, 3 * limits_.max_triangles + 2);
    if (!from) return std::nullopt;
    std::vector<std::uint32_t> out;
    out.reserve(from->count);
    for (std::size_t i = 0; i < from->count; ++i) {
        const char* p = from->bytes.data() + i * from->stride;
        switch (from->component) {
            case kUnsignedByte:
                out.push_back(at<std::uint8_t>(p));
                break;
            case kUnsignedShort:
                out.push_back(at<std::uint16_t>(p));
                break;
            case kUnsignedInt:
                out.push_back(at<std::uint32_t>(p));
                break;
            default:
                fault("Indices are unsigned integers.", pointer_to("accessors", accessor));
                return std::nullopt;
        }
    }
    return out;
}

}  // namespace tinsmith::api
