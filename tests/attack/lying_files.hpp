// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tinsmith::e2e {

/// A body that promises far more than it has, or that grows by far when it is read.
struct LyingFile {
    std::string name;
    std::string type;  ///< as Content-Type says it
    std::string bytes;
    int status = 0;         ///< that refuses it
    std::string code = {};  ///< of what is told of it; empty: any
};

/// Small ones of very many parts, or of parts that are very long.
std::vector<LyingFile> crowded_gltf();

/// Small files, each a lie of another kind.
std::vector<LyingFile> lying_gltf();
/// One triangle 64 million times, in under a megabyte.
LyingFile mesh_in_many_places();
std::vector<LyingFile> lying_tiffs();
std::vector<LyingFile> lying_texts();  ///< XML, OBJ, ESRI grids, CSV, JSON

/// The text so many times.
std::string repeated(const std::string& text, std::size_t count);

/// Numbers as glTF, TIFF and Draco have them: the lowest byte first.
template <typename Number>
void append_number(std::string& out, Number number) {
    for (std::size_t i = 0; i < sizeof number; ++i)
        out.push_back(static_cast<char>(static_cast<std::uint64_t>(number) >> (8 * i) & 0xFF));
}

}  // namespace tinsmith::e2e
