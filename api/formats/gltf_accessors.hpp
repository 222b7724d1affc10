// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/formats/gltf_model.hpp"
#include "core/types/point.hpp"

namespace tinsmith::api {

/// Gets numbers out of a model's buffers. Each span is held against the bytes there are, before
/// memory is taken for it; what does not fit is a fault in the log.
class GltfAccessors {
  public:
    GltfAccessors(const GltfModel& model, const ReadLimits& limits, FaultLog& log)
        : model_(model),
          limits_(limits),
          log_(log),
          room_(64 * (limits.max_vertices + limits.max_triangles)) {}

    /// Positions, floats or integers of KHR_mesh_quantization. At most `limits.max_vertices`, or
    /// three for each triangle.
    std::optional<std::vector<core::Point3>> positions(std::size_t accessor);
    /// Indices of any of the three widths; not held against anything.
    std::optional<std::vector<std::uint32_t>> indices(std::size_t accessor);
    /// A view's own bytes, for those who know what is in them.
    std::optional<std::string_view> view_bytes(std::size_t view, const std::string& pointer);

  private:
    struct Elements {
        std::string_view bytes;
        std::size_t count = 0;
        std::size_t stride = 0;
        std::size_t component = 0;
    };
    std::optional<Elements> elements(std::size_t accessor, std::size_t components,
                                     std::size_t most);
    std::optional<std::string_view> span(std::size_t buffer, std::size_t offset, std::size_t length,
                                         const std::string& pointer);
    void fault(std::string detail, const std::string& pointer);

    const GltfModel& model_;
    const ReadLimits& limits_;
    FaultLog& log_;
    std::size_t room_;                             ///< bytes that may still be unpacked
    std::map<std::size_t, std::string> unpacked_;  ///< of views packed by meshoptimizer
};

}  // namespace tinsmith::api
