// SPDX-License-Identifier: Apache-2.0
#include "tests/support/random_case.hpp"

namespace tinsmith::test {

RandomCase::RandomCase(std::uint64_t seed) : random_(seed) {
    kind_ = static_cast<MeshKind>(random_() % kMeshKinds);
    const int columns = 1 + static_cast<int>(random_() % 9);
    mesh_ = random_mesh(random_, kind_, columns);
    if (!mesh_.triangles.empty()) left_ = 1 + static_cast<int>(random_() % 3);
}

Leniency RandomCase::leniency() const {
    const bool extreme = kind_ == MeshKind::FarAway || kind_ == MeshKind::Needles;
    return extreme ? Leniency{true, 1} : Leniency{};
}

Request RandomCase::next(const core::MeshData& now) {
    --left_;
    Request request;
    const std::uint64_t count = 1 + random_() % 2;
    for (std::uint64_t s = 0; s < count; ++s)
        request.shapes.push_back(
            random_shape(random_, static_cast<ShapeKind>(random_() % kShapeKinds), now));
    request.options.improve = random_() % 3 == 0 ? core::Improve::None : core::Improve::Strict;
    return request;
}

}  // namespace tinsmith::test
