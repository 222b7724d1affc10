// SPDX-License-Identifier: Apache-2.0
// The guarantees on the bundled terrain with each bundled polygon, by the independent verifier.
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "api/formats/geojson.hpp"
#include "api/formats/geotiff.hpp"
#include "api/formats/grid_mesh.hpp"
#include "core/integrate/integrator.hpp"
#include "core/mesh/build.hpp"
#include "tests/support/guarantees.hpp"

namespace tinsmith {
namespace {

std::string read_data(const std::string& name) {
    std::ifstream in(std::string(TINSMITH_SOURCE_DIR) + "/tests/data/" + name, std::ios::binary);
    EXPECT_TRUE(in) << name;
    return {std::istreambuf_iterator<char>(in), {}};
}

const core::MeshData& terrain() {
    static const core::MeshData mesh = [] {
        auto read = api::meshed(api::read_geotiff(read_data("jacksboro.tif"), {}), {});
        return read ? std::move(read->mesh) : core::MeshData{};
    }();
    return mesh;
}

struct Case {
    std::string file;
    core::Improve improve;
    bool leaves;                       ///< part of it is outside the mesh
    std::uint64_t input_vertices = 0;  ///< distinct, 0 where the shape leaves the mesh
};

std::string case_name(const testing::TestParamInfo<Case>& info) {
    return info.param.file + (info.param.improve == core::Improve::None ? "_none" : "_strict");
}

class BundledTerrain : public testing::TestWithParam<Case> {};

TEST_P(BundledTerrain, GuaranteesHold) {
    const auto request = api::read_geojson(read_data(GetParam().file + ".geojson"), {});
    ASSERT_TRUE(request);
    std::vector<core::Shape> shapes;
    for (const auto& requested : request->shapes)
        shapes.push_back(requested.shape);
    auto tin = core::build_tin(terrain());
    ASSERT_TRUE(tin);
    verify::Verifier verifier(terrain());

    core::IntegrateOptions options;
    options.improve = GetParam().improve;
    const auto report = core::integrate(*tin, shapes, options);
    ASSERT_TRUE(report) << report.errors()[0].detail;

    const auto broken = test::check_guarantees(verifier, {shapes, options, *report, *tin});
    for (std::size_t i = 0; i < broken.size() && i < 10; ++i)
        ADD_FAILURE() << broken[i];
    const core::ShapeReport& shape = report->shapes.at(0);
    EXPECT_EQ(shape.outside.empty(), !GetParam().leaves);
    if (!GetParam().leaves) {
        EXPECT_EQ(shape.vertices_added, GetParam().input_vertices + shape.crossings);
    }
    std::cout << GetParam().file << ": " << shape.segments << " segments, " << shape.crossings
              << " crossings, " << shape.vertices_added << " vertices added, "
              << shape.edges_swapped << " edges swapped, vertical deviation at most "
              << shape.max_vertical_deviation << " m, plan deviation " << shape.max_plan_deviation
              << " m\n";

    // The second time there is nothing left to do.
    const auto again = core::integrate(*tin, shapes, options);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->shapes.at(0).vertices_added, 0U);
    EXPECT_EQ(again->shapes.at(0).triangles_added, 0U);
}

INSTANTIATE_TEST_SUITE_P(Polygons, BundledTerrain,
                         testing::Values(Case{"lake", core::Improve::Strict, false, 90},
                                         Case{"lake", core::Improve::None, false, 90},
                                         Case{"road", core::Improve::Strict, false, 60},
                                         Case{"road", core::Improve::None, false, 60},
                                         Case{"parcel", core::Improve::Strict, false, 17},
                                         Case{"parcel", core::Improve::None, false, 17},
                                         Case{"contour_450", core::Improve::Strict, false, 450},
                                         Case{"contour_450", core::Improve::None, false, 450},
                                         Case{"contour_3500", core::Improve::Strict, false, 3501},
                                         Case{"contour_3500", core::Improve::None, false, 3501},
                                         Case{"leaving", core::Improve::Strict, true},
                                         Case{"leaving", core::Improve::None, true}),
                         case_name);

}  // namespace
}  // namespace tinsmith
