// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace tinsmith::test {

/// What a viewer does with deltas: buffers of its own, patched by what comes over the wire. It
/// reads the formats by their description alone and shares no line with the service.
class DeltaClient {
  public:
    std::uint64_t version() const { return version_; }
    const std::vector<std::array<double, 3>>& vertices() const { return vertices_; }
    const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return triangles_; }

    /// Empty: done. Else what is wrong with the delta; the buffers are then of no more use.
    std::string patch(const std::string& bytes) {
        if (bytes.size() < 48 || bytes.compare(0, 4, "TNDL") != 0) return "no delta";
        if (number<std::uint16_t>(bytes, 4) != 1) return "another format";
        const bool whole = (number<std::uint16_t>(bytes, 6) & 1) != 0;
        const Head head{number<std::uint64_t>(bytes, 8),
                        number<std::uint64_t>(bytes, 16),
                        whole,
                        {number<std::uint32_t>(bytes, 24), number<std::uint32_t>(bytes, 28)},
                        {number<std::uint32_t>(bytes, 32), number<std::uint32_t>(bytes, 36)}};
        if (std::string fault = begin(head); !fault.empty()) return fault;
        const std::size_t runs[2] = {number<std::uint32_t>(bytes, 40),
                                     number<std::uint32_t>(bytes, 44)};
        std::size_t run = 48;
        std::size_t item = 48 + 8 * (runs[0] + runs[1]);
        for (std::size_t what = 0; what < 2; ++what) {
            for (std::size_t r = 0; r < runs[what]; ++r, run += 8) {
                const auto first = number<std::uint32_t>(bytes, run);
                const auto count = number<std::uint32_t>(bytes, run + 4);
                for (std::uint32_t slot = first; slot < first + count; ++slot) {
                    const std::size_t size = what == 0 ? 24 : 12;
                    if (item + size > bytes.size()) return "too short";
                    if (slot >= head.now[what]) return "a slot beyond the count";
                    void* to = what == 0 ? static_cast<void*>(vertices_[slot].data())
                                         : static_cast<void*>(triangles_[slot].data());
                    std::memcpy(to, bytes.data() + item, size);  // a little-endian machine's way
                    item += size;
                }
            }
        }
        return item == bytes.size() ? "" : "too long";
    }

    std::string patch_json(const std::string& text) {
        const auto json = nlohmann::json::parse(text);
        const auto& v = json["vertex_count"];
        const auto& t = json["triangle_count"];
        const Head head{
            json["from"], json["to"], json["whole"], {v["old"], t["old"]}, {v["new"], t["new"]}};
        if (std::string fault = begin(head); !fault.empty()) return fault;
        for (const auto& run : json["vertices"]) {
            std::size_t slot = run["first"];
            for (const auto& position : run["positions"])
                vertices_.at(slot++) = position;
        }
        for (const auto& run : json["triangles"]) {
            std::size_t slot = run["first"];
            for (const auto& corners : run["corners"])
                triangles_.at(slot++) = corners;
        }
        return "";
    }

  private:
    struct Head {
        std::uint64_t from;
        std::uint64_t to;
        bool whole;
        std::array<std::uint32_t, 2> before;
        std::array<std::uint32_t, 2> now;
    };

    template <typename T>
    static T number(const std::string& bytes, std::size_t offset) {
        T value;
        std::memcpy(&value, bytes.data() + offset, sizeof value);
        return value;
    }

    std::string begin(const Head& head) {
        if (head.from != version_) return "from another version";
        if (head.whole) {
            vertices_.clear();
            triangles_.clear();
        } else if (head.before[0] != vertices_.size() || head.before[1] != triangles_.size()) {
            return "from other counts";
        }
        // What no delta names shows up as not-a-number or as no vertex.
        vertices_.resize(head.now[0], {std::nan(""), 0.0, 0.0});
        triangles_.resize(head.now[1], {UINT32_MAX, 0, 0});
        version_ = head.to;
        return "";
    }

    std::uint64_t version_ = 0;
    std::vector<std::array<double, 3>> vertices_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
};

}  // namespace tinsmith::test
