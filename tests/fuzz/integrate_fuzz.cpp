// SPDX-License-Identifier: Apache-2.0
// Small meshes and shapes made of bytes: positions on a fine lattice moved by a few ulps, where
// everything degenerate happens. Whatever the input, the mesh stays valid, and a refusal leaves it
// as it was.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "core/integrate/integrator.hpp"
#include "core/mesh/build.hpp"
#include "core/mesh/check.hpp"
#include "core/types/range.hpp"
#include "core/types/ulp.hpp"

namespace {

using namespace tinsmith::core;

class Bytes {
  public:
    Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
    bool empty() const { return at_ >= size_; }
    std::uint8_t next() { return at_ < size_ ? data_[at_++] : std::uint8_t{0}; }

  private:
    const std::uint8_t* data_;
    std::size_t size_;
    std::size_t at_ = 0;
};

/// A grid of up to 4 x 4 cells, some of them missing, far from the origin or near.
MeshData make_mesh(Bytes& bytes, double offset) {
    const std::uint32_t columns = 1 + bytes.next() % 4;
    MeshData mesh;
    for (std::uint32_t r = 0; r <= columns; ++r)
        for (std::uint32_t c = 0; c <= columns; ++c)
            mesh.vertices.push_back(
                {offset + c, offset + r, static_cast<double>((c * 7 + r * 5) % 4)});
    std::vector<bool> used(mesh.vertices.size(), false);
    for (std::uint32_t r = 0; r < columns; ++r) {
        for (std::uint32_t c = 0; c < columns; ++c) {
            const std::uint8_t cell = bytes.next();
            if (cell % 5 == 0 && columns > 1) continue;
            const std::uint32_t a = r * (columns + 1) + c, b = a + 1;
            const std::uint32_t d = a + columns + 1, e = d + 1;
            if (cell % 2 == 0) {
                mesh.triangles.push_back({a, b, e});
                mesh.triangles.push_back({a, e, d});
            } else {
                mesh.triangles.push_back({a, b, d});
                mesh.triangles.push_back({b, e, d});
            }
            for (const std::uint32_t v : {a, b, d, e})
                used[v] = true;
        }
    }
    std::vector<std::uint32_t> slot(used.size(), 0);
    MeshData compact;
    for (std::uint32_t v = 0; v < used.size(); ++v) {
        if (!used[v]) continue;
        slot[v] = static_cast<std::uint32_t>(compact.vertices.size());
        compact.vertices.push_back(mesh.vertices[v]);
    }
    for (const auto& t : mesh.triangles)
        compact.triangles.push_back({slot[t[0]], slot[t[1]], slot[t[2]]});
    return compact;
}

double make_coordinate(Bytes& bytes, double offset) {
    const std::uint8_t place = bytes.next();
    const std::uint8_t nudge = bytes.next();
    double x = offset + place % 81 / 16.0 - 0.5;
    for (int i = 0; i < nudge % 8; ++i)
        x = neighbour(x, (nudge & 8U) != 0);
    return in_coordinate_range(x) ? x : offset;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(data, size);
    const double offset = bytes.next() % 3 == 0 ? 5e6 : 0.0;
    const MeshData mesh = make_mesh(bytes, offset);
    if (mesh.triangles.empty()) return 0;
    auto built = build_tin(mesh);
    if (!built) std::abort();
    Tin tin = std::move(*built);
    while (!bytes.empty()) {
        const std::uint8_t head = bytes.next();
        Path path;
        path.closed = (head & 1U) != 0;
        for (int i = 0; i < 1 + head / 2 % 12; ++i) {
            const double x = make_coordinate(bytes, offset);
            path.points.push_back({x, make_coordinate(bytes, offset)});
        }
        IntegrateOptions options;
        options.improve = (head & 64U) != 0 ? Improve::None : Improve::Strict;
        options.outside = (head & 128U) != 0 ? Outside::Reject : Outside::Skip;
        const MeshData before = tin.to_data();
        const Shape shape{{path}};
        const auto report = integrate(tin, {&shape, 1}, options);
        if (!check_tin(tin, 1).empty()) std::abort();
        if (report) continue;
        if (report.errors()[0].code == ErrorCode::StepBudget) std::abort();
        const MeshData after = tin.to_data();
        if (after.vertices != before.vertices || after.triangles != before.triangles ||
            after.constraints != before.constraints)
            std::abort();
    }
    return 0;
}
