// SPDX-License-Identifier: Apache-2.0
#include "api/formats/glb_chunks.hpp"

#include <cstdint>
#include <string>
#include <utility>

namespace tinsmith::api {

namespace {

constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinChunk = 0x004E4942;

std::uint32_t word(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (unsigned i = 0; i < 4; ++i)
        value |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
    return value;
}

}  // namespace

std::optional<GlbChunks> split_glb(std::string_view bytes, FaultLog& log) {
    if (!bytes.starts_with("glTF")) return GlbChunks{bytes, std::nullopt};
    const auto broken = [&](std::string detail) {
        log.add(FaultKind::Syntax, {"GLB_SYNTAX", std::move(detail), {}});
        return std::nullopt;
    };
    if (bytes.size() < 20) return broken("The file ends within its head of 20 bytes.");
    if (word(bytes, 4) != 2)
        return broken("It is of version " + std::to_string(word(bytes, 4)) +
                      "; only glTF 2.0 is read.");
    if (word(bytes, 8) > bytes.size())
        return broken("Its head promises " + std::to_string(word(bytes, 8)) +
                      " bytes, but there are " + std::to_string(bytes.size()) +
                      ": part of the file is missing.");
    bytes = bytes.substr(0, word(bytes, 8));
    GlbChunks chunks;
    for (std::size_t at = 12; at + 8 <= bytes.size();) {
        const std::size_t length = word(bytes, at);
        const std::uint32_t type = word(bytes, at + 4);
        if (length > bytes.size() - at - 8)
            return broken("The chunk at byte " + std::to_string(at) + " promises " +
                          std::to_string(length) + " bytes, more than follow.");
        const std::string_view chunk = bytes.substr(at + 8, length);
        if (at == 12 && type != kJsonChunk) return broken("The first chunk is not JSON.");
        if (type == kJsonChunk && at == 12) chunks.json = chunk;
        if (type == kBinChunk && !chunks.bin) chunks.bin = chunk;
        at += 8 + length;
    }
    if (chunks.json.empty()) return broken("There is no JSON in it.");
    return chunks;
}

}  // namespace tinsmith::api
