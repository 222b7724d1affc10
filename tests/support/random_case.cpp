// SPDX-License-Identifier: Apache-2.0
#include "tests/support/random_case.hpp"

#include <array>
#include <cmath>

namespace tinsmith::test {

using core::Improve;

namespace {

/// What requests ask for, each line as often as it is listed.
constexpr std::array kImproves{Improve::None,   Improve::None,  Improve::Strict, Improve::Strict,
                               Improve::Strict, Improve::Paper, Improve::Bounded};
/// One request in so many has it; 0: none has.
constexpr int kSnapsOneIn = 4;
constexpr int kOwnElevationsOneIn = 5;
constexpr int kLocksOneIn = 10;
constexpr int kRejectsOneIn = 20;

/// From far below rounding of most meshes to a third of a cell.
double random_snap(Random& random, const core::MeshData& mesh) {
    const auto& [a, b, c] = mesh.triangles[random() % mesh.triangles.size()];
    const auto &p = mesh.vertices[a], &q = mesh.vertices[b];
    const double side = std::sqrt((p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y));
    return side * std::pow(10.0, uniform(random, -6.0, -0.5));
}

/// From far below the relief of the mesh to all of it.
double random_deviation(Random& random, const core::MeshData& mesh) {
    const auto& [a, b, c] = mesh.triangles[random() % mesh.triangles.size()];
    const double relief = std::fabs(mesh.vertices[a].z - mesh.vertices[b].z);
    return relief * std::pow(10.0, uniform(random, -6.0, 0.0));
}

bool one_in(Random& random, int count) {
    return count > 0 && pick(random, count) == 0;
}

}  // namespace

std::uint64_t unrepresentable_per_million(MeshKind kind) {
    switch (kind) {
        case MeshKind::Needles:
        case MeshKind::Strips:
        case MeshKind::Map:
        case MeshKind::FarAway:
        case MeshKind::Steep:
            return 200;
        default:
            return 100;
    }
}

RandomCase::RandomCase(std::uint64_t seed) : random_(seed) {
    kind_ = static_cast<MeshKind>(pick(random_, kMeshKinds));
    const int columns = 1 + pick(random_, 9);
    mesh_ = random_mesh(random_, kind_, columns);
    if (!mesh_.triangles.empty()) left_ = 1 + pick(random_, 3);
}

Request RandomCase::next(const core::MeshData& now) {
    --left_;
    Request request;
    const bool own = one_in(random_, kOwnElevationsOneIn);
    const int count = 1 + pick(random_, 2);
    for (int s = 0; s < count; ++s) {
        const auto kind = static_cast<ShapeKind>(pick(random_, kShapeKinds));
        request.shapes.push_back(random_shape(random_, kind, now));
        if (own && pick(random_, 4) != 0) give_elevations(random_, request.shapes.back(), now);
    }
    core::IntegrateOptions& options = request.options;
    options.improve = kImproves[random_() % kImproves.size()];
    if (options.improve == Improve::Bounded) options.max_deviation = random_deviation(random_, now);
    if (one_in(random_, kSnapsOneIn)) options.snap = random_snap(random_, now);
    options.lock = one_in(random_, kLocksOneIn);
    if (one_in(random_, kRejectsOneIn)) options.outside = core::Outside::Reject;
    if (own && pick(random_, 3) == 0) options.on_crossing = core::OnCrossing::Old;
    return request;
}

}  // namespace tinsmith::test
