// SPDX-License-Identifier: Apache-2.0
// The guarantees on random meshes and shapes of every kind, the whole mesh checked after each
// operation. A failure names its seed; TINSMITH_SEED=n runs that one alone, TINSMITH_OPERATIONS=n
// sets how many are tried, TINSMITH_FIRST_SEED=n where the seeds begin.
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <string>

#include <gtest/gtest.h>

#include "core/integrate/integrator.hpp"
#include "core/mesh/build.hpp"
#include "tests/support/guarantees.hpp"
#include "tests/support/random_input.hpp"

namespace tinsmith {
namespace {

using namespace core;
using test::MeshKind;
using test::Random;
using test::ShapeKind;

std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
    const char* text = std::getenv(variable);
    return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

bool same_bytes(const MeshData& a, const MeshData& b) {
    const auto same = [](const auto& l, const auto& r) {
        return l.size() == r.size() &&
               (l.empty() || std::memcmp(l.data(), r.data(), l.size() * sizeof l[0]) == 0);
    };
    return same(a.vertices, b.vertices) && same(a.triangles, b.triangles) &&
           same(a.constraints, b.constraints);
}

bool is_extreme(MeshKind kind) {
    return kind == MeshKind::FarAway || kind == MeshKind::Needles;
}

/// One mesh, a few operations on it. Returns what broke.
std::vector<std::string> try_seed(std::uint64_t seed, std::uint64_t& operations,
                                  std::uint64_t& refused, std::uint64_t& unrepresentable) {
    Random random(seed);
    const auto kind = static_cast<MeshKind>(random() % test::kMeshKinds);
    const int columns = 1 + static_cast<int>(random() % 9);
    const MeshData data = test::random_mesh(random, kind, columns);
    if (data.triangles.empty()) return {};
    Result<Tin> built = build_tin(data);
    if (!built) return {"the mesh was refused: " + built.errors()[0].detail};
    Tin tin = std::move(*built);
    const int rounds = 1 + static_cast<int>(random() % 3);
    for (int round = 0; round < rounds; ++round) {
        const MeshData before = tin.to_data();
        const test::SurfaceOracle oracle(before);
        std::vector<Shape> shapes;
        const std::uint64_t count = 1 + random() % 2;
        for (std::uint64_t s = 0; s < count; ++s)
            shapes.push_back(test::random_shape(
                random, static_cast<ShapeKind>(random() % test::kShapeKinds), before));
        IntegrateOptions options;
        options.improve = random() % 3 == 0 ? Improve::None : Improve::Strict;
        const Result<Report> report = integrate(tin, shapes, options);
        ++operations;
        if (!report) {
            ++refused;
            const ErrorCode code = report.errors()[0].code;
            if (!same_bytes(before, tin.to_data())) return {"a refused request changed the mesh"};
            // At a detail of some ulps there may be no mesh of doubles to be had.
            if (code == ErrorCode::NotRepresentable && is_extreme(kind))
                ++unrepresentable;
            else if (code != ErrorCode::OutsideMesh)
                return {std::string(code_name(code)) + ": " + report.errors()[0].detail};
            continue;
        }
        // Facets outlive requests, so only the first one meets the mesh's edges and nothing else.
        const test::Operation operation{oracle, tin, shapes, *report};
        auto broken = test::check_valid(tin);
        for (auto& more : test::check_shape_kept(operation, 200, seed))
            broken.push_back(more);
        for (auto& more : test::check_integrated(operation))
            broken.push_back(more);
        if (round == 0)
            for (auto& more : test::check_economical(operation, is_extreme(kind) ? 1 : 0))
                broken.push_back(more);
        if (!broken.empty()) {
            broken.push_back("round " + std::to_string(round) + ", mesh kind " +
                             std::to_string(static_cast<int>(kind)));
            return broken;
        }
    }
    return {};
}

TEST(IntegrateProperty, GuaranteesHoldOnRandomMeshesAndShapes) {
    const std::uint64_t wanted = number_from("TINSMITH_OPERATIONS", 4000);
    const std::uint64_t only = number_from("TINSMITH_SEED", 0);
    std::uint64_t operations = 0, refused = 0, unrepresentable = 0, failures = 0;
    const std::uint64_t first = number_from("TINSMITH_FIRST_SEED", 1);
    for (std::uint64_t seed = only != 0 ? only : first; operations < wanted; ++seed) {
        const auto broken = try_seed(seed, operations, refused, unrepresentable);
        if (!broken.empty()) {
            ++failures;
            std::string text;
            for (std::size_t i = 0; i < broken.size() && i < 6; ++i)
                text += "\n  " + broken[i];
            if (broken.size() > 6) text += "\n  " + broken.back();
            ADD_FAILURE() << "TINSMITH_SEED=" << seed << text;
        }
        if (only != 0 || failures >= 20) break;
    }
    EXPECT_LE(unrepresentable, 1 + operations / 500);
    std::cout << operations << " operations, " << refused << " refused, " << unrepresentable
              << " of those because no mesh of doubles would do\n";
}

}  // namespace
}  // namespace tinsmith
