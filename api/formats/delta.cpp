// SPDX-License-Identifier: Apache-2.0
#include "api/formats/delta.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "api/formats/json_writer.hpp"

namespace tinsmith::api {

namespace {

constexpr std::string_view kMagic = "TNDL";
constexpr std::uint16_t kFormatVersion = 1;
constexpr std::uint16_t kWholeFlag = 1;
constexpr std::size_t kHeadBytes = 48;
constexpr std::size_t kRunBytes = 8;
constexpr std::size_t kVertexBytes = 24;
constexpr std::size_t kTriangleBytes = 12;

template <typename Number>
void append_little(std::string& out, Number value) {
    for (std::size_t i = 0; i < sizeof value; ++i)
        out.push_back(static_cast<char>(static_cast<unsigned char>(value >> (8 * i))));
}

template <typename Number>
Number little_at(std::string_view bytes, std::size_t offset) {
    Number value = 0;
    for (std::size_t i = 0; i < sizeof value; ++i)
        value |= static_cast<Number>(
            static_cast<Number>(static_cast<unsigned char>(bytes[offset + i])) << (8 * i));
    return value;
}

void append_runs(std::string& out, const std::vector<SlotRun>& runs) {
    for (const SlotRun& run : runs) {
        append_little(out, run.first);
        append_little(out, run.count);
    }
}

/// Runs of the JSON encoding, each with its items written by `append`.
template <typename Item, typename Append>
void append_json_runs(std::string& out, const std::vector<SlotRun>& runs,
                      const std::vector<Item>& items, std::string_view name, Append append) {
    std::size_t next = 0;
    for (std::size_t r = 0; r < runs.size(); ++r) {
        out.append(r > 0 ? ",{\"first\":" : "{\"first\":");
        json::append_number(out, runs[r].first);
        out.append(",\"").append(name).append("\":[");
        for (std::uint32_t i = 0; i < runs[r].count; ++i) {
            if (i > 0) out.push_back(',');
            append(out, items[next++]);
        }
        out += "]}";
    }
}

void append_counts(std::string& out, std::string_view name, std::uint32_t before,
                   std::uint32_t after) {
    out.append(",\"").append(name).append("\":{\"old\":");
    json::append_number(out, before);
    out += ",\"new\":";
    json::append_number(out, after);
    out.push_back('}');
}

Parsed<MeshDelta> broken(std::string detail) {
    return {FaultKind::Syntax, Fault{"BAD_DELTA", std::move(detail), ""}};
}

/// The slots that the runs name, or nothing where they are not as they should be. `kept`: slots
/// below need not be named; all others up to `count` must.
std::optional<std::size_t> slots_of(const std::vector<SlotRun>& runs, std::uint32_t kept,
                                    std::uint32_t count) {
    std::uint64_t end = 0;
    std::size_t slots = 0;
    std::size_t new_slots = 0;
    for (const SlotRun& run : runs) {
        const bool is_first = &run == &runs.front();
        if (run.count == 0 || (is_first ? run.first < end : run.first <= end)) return std::nullopt;
        end = std::uint64_t{run.first} + run.count;
        if (end > count) return std::nullopt;
        slots += run.count;
        if (end > kept) new_slots += end - std::max(run.first, kept);
    }
    if (count > kept && new_slots != count - kept) return std::nullopt;
    return slots;
}

std::vector<SlotRun> runs_at(std::string_view bytes, std::size_t& offset, std::size_t count) {
    std::vector<SlotRun> runs;
    runs.reserve(count);
    for (std::size_t i = 0; i < count; ++i, offset += kRunBytes)
        runs.push_back(
            {little_at<std::uint32_t>(bytes, offset), little_at<std::uint32_t>(bytes, offset + 4)});
    return runs;
}

bool read_vertices(std::string_view bytes, std::size_t& offset, std::size_t count,
                   MeshDelta& delta) {
    const auto coordinate = [&bytes, &offset] {
        offset += 8;
        return std::bit_cast<double>(little_at<std::uint64_t>(bytes, offset - 8));
    };
    delta.vertices.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double x = coordinate();
        const double y = coordinate();
        const double z = coordinate();
        if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) return false;
        delta.vertices.push_back({x, y, z});
    }
    return true;
}

bool read_triangles(std::string_view bytes, std::size_t& offset, std::size_t count,
                    MeshDelta& delta) {
    delta.triangles.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        std::array<std::uint32_t, 3> corners{};
        for (std::uint32_t& corner : corners) {
            corner = little_at<std::uint32_t>(bytes, offset);
            offset += 4;
            if (corner >= delta.new_vertices) return false;
        }
        delta.triangles.push_back(corners);
    }
    return true;
}

}  // namespace

std::size_t delta_bytes(const DeltaSize& size) {
    return kHeadBytes + (size.vertex_runs + size.triangle_runs) * kRunBytes +
           size.vertices * kVertexBytes + size.triangles * kTriangleBytes;
}

std::string write_delta(const MeshDelta& delta) {
    std::string out;
    out.reserve(delta_bytes({delta.vertex_runs.size(), delta.vertices.size(),
                             delta.triangle_runs.size(), delta.triangles.size()}));
    out += kMagic;
    append_little(out, kFormatVersion);
    append_little(out, delta.whole ? kWholeFlag : std::uint16_t{0});
    append_little(out, delta.from);
    append_little(out, delta.to);
    for (const std::uint32_t count :
         {delta.old_vertices, delta.old_triangles, delta.new_vertices, delta.new_triangles})
        append_little(out, count);
    append_little(out, static_cast<std::uint32_t>(delta.vertex_runs.size()));
    append_little(out, static_cast<std::uint32_t>(delta.triangle_runs.size()));
    append_runs(out, delta.vertex_runs);
    append_runs(out, delta.triangle_runs);
    for (const core::Point3& p : delta.vertices) {
        for (const double coordinate : {p.x, p.y, p.z})
            append_little(out, std::bit_cast<std::uint64_t>(coordinate));
    }
    for (const auto& corners : delta.triangles) {
        for (const std::uint32_t corner : corners)
            append_little(out, corner);
    }
    return out;
}

std::string write_delta_json(const MeshDelta& delta) {
    std::string out;
    out.reserve(256 + (delta.vertex_runs.size() + delta.triangle_runs.size()) * 40 +
                delta.vertices.size() * 48 + delta.triangles.size() * 24);
    out += "{\"from\":";
    json::append_number(out, delta.from);
    out += ",\"to\":";
    json::append_number(out, delta.to);
    out.append(",\"whole\":").append(delta.whole ? "true" : "false");
    append_counts(out, "vertex_count", delta.old_vertices, delta.new_vertices);
    append_counts(out, "triangle_count", delta.old_triangles, delta.new_triangles);
    out += ",\"vertices\":[";
    append_json_runs(
        out, delta.vertex_runs, delta.vertices, "positions",
        [](std::string& text, const core::Point3& p) { json::append_position(text, p); });
    out += "],\"triangles\":[";
    append_json_runs(out, delta.triangle_runs, delta.triangles, "corners",
                     [](std::string& text, const std::array<std::uint32_t, 3>& corners) {
                         text.push_back('[');
                         for (std::size_t i = 0; i < 3; ++i) {
                             if (i > 0) text.push_back(',');
                             json::append_number(text, corners[i]);
                         }
                         text.push_back(']');
                     });
    out += "]}\n";
    return out;
}

Parsed<MeshDelta> read_delta(std::string_view bytes, const ReadLimits& limits) {
    if (bytes.size() < kHeadBytes) return broken("The delta ends within its head.");
    if (!bytes.starts_with(kMagic)) return broken("The delta does not begin with TNDL.");
    if (little_at<std::uint16_t>(bytes, 4) != kFormatVersion) {
        return broken("The delta has another format version than 1.");
    }
    const auto flags = little_at<std::uint16_t>(bytes, 6);
    if (flags > kWholeFlag) return broken("The delta has flags that nobody knows.");
    MeshDelta delta;
    delta.whole = flags == kWholeFlag;
    delta.from = little_at<std::uint64_t>(bytes, 8);
    delta.to = little_at<std::uint64_t>(bytes, 16);
    delta.old_vertices = little_at<std::uint32_t>(bytes, 24);
    delta.old_triangles = little_at<std::uint32_t>(bytes, 28);
    delta.new_vertices = little_at<std::uint32_t>(bytes, 32);
    delta.new_triangles = little_at<std::uint32_t>(bytes, 36);
    if (delta.from > delta.to) return broken("The delta leads to an earlier version.");
    if (delta.new_vertices > limits.max_vertices || delta.new_triangles > limits.max_triangles) {
        return {FaultKind::TooLarge, Fault{"MESH_TOO_LARGE", "The mesh is beyond the limits.", ""}};
    }
    const std::size_t vertex_runs = little_at<std::uint32_t>(bytes, 40);
    const std::size_t triangle_runs = little_at<std::uint32_t>(bytes, 44);
    if ((bytes.size() - kHeadBytes) / kRunBytes < vertex_runs + triangle_runs) {
        return broken("The delta ends within its runs.");
    }
    std::size_t offset = kHeadBytes;
    delta.vertex_runs = runs_at(bytes, offset, vertex_runs);
    delta.triangle_runs = runs_at(bytes, offset, triangle_runs);
    const auto vertices =
        slots_of(delta.vertex_runs, delta.whole ? 0 : delta.old_vertices, delta.new_vertices);
    const auto triangles =
        slots_of(delta.triangle_runs, delta.whole ? 0 : delta.old_triangles, delta.new_triangles);
    if (!vertices || !triangles) {
        return broken("The delta's runs are out of order, out of range or leave slots out.");
    }
    if (bytes.size() != delta_bytes({vertex_runs, *vertices, triangle_runs, *triangles})) {
        return broken("The delta has another length than its runs say.");
    }
    if (!read_vertices(bytes, offset, *vertices, delta)) {
        return broken("The delta has a coordinate that is not finite.");
    }
    if (!read_triangles(bytes, offset, *triangles, delta)) {
        return broken("The delta has a triangle with a corner that is not there.");
    }
    return delta;
}

}  // namespace tinsmith::api
