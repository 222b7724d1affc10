// SPDX-License-Identifier: Apache-2.0
#include "api/terrain_system.hpp"

#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace tinsmith::api {
namespace {

using core::Point3;

/// A triangle near Paris, in degrees unless another system is named.
Terrain terrain_in(std::string crs, std::string unit = {}) {
    Terrain terrain;
    terrain.crs = std::move(crs);
    terrain.unit_is_said = !unit.empty();
    if (terrain.unit_is_said) terrain.unit = std::move(unit);
    terrain.mesh.vertices = {{2.35, 48.85, 100}, {2.36, 48.85, 200}, {2.35, 48.86, 300}};
    terrain.mesh.triangles = {{0, 1, 2}};
    return terrain;
}

TerrainOptions options(std::string project, std::string crs = {}, std::string unit = {}) {
    TerrainOptions out;
    out.project = std::move(project);
    out.crs = std::move(crs);
    out.unit = std::move(unit);
    return out;
}

Terrain settled(Terrain terrain, const TerrainOptions& how) {
    auto out = in_its_system(std::move(terrain), how, {});
    if (out) return *std::move(out);
    ADD_FAILURE() << out.faults()[0].code << ": " << out.faults()[0].detail;
    return {};
}

/// "CODE pointer parameter" of the one fault.
std::string refused(Terrain terrain, const TerrainOptions& how) {
    const auto out = in_its_system(std::move(terrain), how, {});
    if (out) return "taken";
    EXPECT_EQ(out.faults().size(), 1U);
    const Fault& fault = out.faults()[0];
    EXPECT_GT(fault.detail.size(), 40U) << fault.detail;
    return fault.code + " " + fault.pointer + " " + fault.parameter;
}

TEST(TerrainSystem, AProjectedSystemBringsItsUnit) {
    EXPECT_EQ(settled(terrain_in("EPSG:32616"), {}).unit, "metre");
    EXPECT_EQ(settled(terrain_in("EPSG:2263"), {}).unit, "US survey foot");
    EXPECT_EQ(settled(terrain_in("EPSG:2222"), {}).unit, "foot");
    EXPECT_EQ(settled(terrain_in("", "foot"), {}).unit, "foot");
    EXPECT_EQ(settled(terrain_in(""), {}).unit, "metre");
    const Terrain named = settled(terrain_in(""), options("", "epsg:2263"));
    EXPECT_EQ(named.crs, "EPSG:2263");
    EXPECT_EQ(named.unit, "US survey foot");
    EXPECT_EQ(named.mesh.vertices[1], (Point3{2.36, 48.85, 200})) << "coordinates stay";
}

TEST(TerrainSystem, WhatContradictsIsRefusedWhereItStands) {
    EXPECT_EQ(refused(terrain_in("EPSG:2263", "metre"), {}), "CONTRADICTION /unit ");
    EXPECT_EQ(refused(terrain_in("EPSG:2263", "foot"), {}), "CONTRADICTION /unit ");
    EXPECT_EQ(refused(terrain_in("EPSG:2263"), options("", "", "m")), "CONTRADICTION  unit");
    EXPECT_EQ(refused(terrain_in("", "foot"), options("", "", "metre")), "CONTRADICTION  unit");
    EXPECT_EQ(refused(terrain_in("EPSG:2263"), options("", "EPSG:2264")), "CONTRADICTION  crs");
    EXPECT_EQ(settled(terrain_in("EPSG:2263", "US survey foot"), options("", "EPSG:2263")).crs,
              "EPSG:2263");
}

TEST(TerrainSystem, SystemsMustBeKnownAndHaveAPlan) {
    EXPECT_EQ(refused(terrain_in("EPSG:999999"), {}), "CRS_UNKNOWN /crs ");
    EXPECT_EQ(refused(terrain_in(""), options("", "EPSG:999999")), "CRS_UNKNOWN  crs");
    EXPECT_EQ(refused(terrain_in(""), options("", "here")), "CRS_UNKNOWN  crs");
    EXPECT_EQ(refused(terrain_in("EPSG:5703"), {}), "CRS_UNFIT /crs ");
    EXPECT_EQ(refused(terrain_in(""), options("", "", "cubit")), "UNIT_UNKNOWN  unit");
    // Clarke's foot on Trinidad.
    EXPECT_EQ(refused(terrain_in("EPSG:2314"), {}), "UNIT_UNKNOWN /crs ");
}

TEST(TerrainSystem, DegreesAreRefusedWithoutProject) {
    EXPECT_EQ(refused(terrain_in("EPSG:4326"), {}), "CRS_GEOGRAPHIC /crs ");
    EXPECT_EQ(refused(terrain_in(""), options("", "EPSG:4171")), "CRS_GEOGRAPHIC  crs");
    EXPECT_EQ(refused(terrain_in(""), options("auto")), "PROJECT_WITHOUT_CRS  project");
}

TEST(TerrainSystem, DegreesAreBroughtOverVertexByVertex) {
    const Terrain zone = settled(terrain_in("EPSG:4326"), options("auto"));
    EXPECT_EQ(zone.crs, "EPSG:32631");
    EXPECT_EQ(zone.unit, "metre");
    // By cs2cs of PROJ 9.1.1.
    EXPECT_NEAR(zone.mesh.vertices[0].x, 452314.89, 0.01);
    EXPECT_NEAR(zone.mesh.vertices[0].y, 5410984.89, 0.01);
    EXPECT_EQ(zone.mesh.vertices[2].z, 300.0);
    const Terrain lambert = settled(terrain_in(""), options("EPSG:2154", "EPSG:4326"));
    EXPECT_EQ(lambert.crs, "EPSG:2154");
    EXPECT_NEAR(lambert.mesh.vertices[0].x, 652301.56, 0.01);
}

TEST(TerrainSystem, APointWithoutAPlaceIsNamedAsItsFormatDoes) {
    Terrain terrain = terrain_in("EPSG:4326");
    terrain.mesh.triangles.clear();
    terrain.mesh.vertices[1].y = 95.0;
    terrain.points = PointsPlace{
        "/points", [](Fault& fault, std::size_t point, std::optional<std::size_t> earlier) {
            EXPECT_FALSE(earlier);
            fault.pointer = "/points/" + std::to_string(point);
        }};
    EXPECT_EQ(refused(terrain, options("EPSG:2154")), "COORDINATE_OUT_OF_RANGE /points/1 ");
}

TEST(TerrainSystem, LengthsInMetresBecomeOnesOfTheUnitTheyHad) {
    const auto brought = [](std::string crs, std::string before, const TerrainOptions& how) {
        Terrain terrain = terrain_in(std::move(crs), "metre");
        terrain.unit_before = std::move(before);
        bring_from_metres(terrain, how);
        return terrain.unit;
    };
    EXPECT_EQ(brought("", "foot", {}), "foot");
    EXPECT_EQ(brought("", "foot", options("", "", "metre")), "metre");
    EXPECT_EQ(brought("EPSG:2264", "US survey foot", {}), "US survey foot");
    EXPECT_EQ(brought("EPSG:32616", "foot", {}), "metre");
    EXPECT_EQ(brought("", "", {}), "metre");
}

TEST(TerrainSystem, ElevationsBecomeOnesOfTheNewUnit) {
    Terrain terrain = terrain_in("EPSG:4326");
    for (Point3& p : terrain.mesh.vertices)
        p = {p.x - 76.3, p.y - 8.2, p.z};  // New York
    const Terrain feet = settled(terrain, options("EPSG:2263"));
    EXPECT_EQ(feet.unit, "US survey foot");
    EXPECT_NEAR(feet.mesh.vertices[0].z, 100.0 * 3937.0 / 1200.0, 1e-10);
    const Terrain from_feet = settled(terrain, options("EPSG:32618", "", "foot"));
    EXPECT_EQ(from_feet.unit, "metre");
    EXPECT_NEAR(from_feet.mesh.vertices[0].z, 30.48, 1e-12);
}

TEST(TerrainSystem, ProjectIsForDegreesAndNamesAProjectedSystem) {
    EXPECT_EQ(settled(terrain_in("EPSG:2154"), options("auto")).crs, "EPSG:2154");
    EXPECT_EQ(settled(terrain_in("EPSG:2154"), options("EPSG:2154")).crs, "EPSG:2154");
    EXPECT_EQ(refused(terrain_in("EPSG:2154"), options("EPSG:32631")),
              "PROJECT_NOT_GEOGRAPHIC  project");
    EXPECT_EQ(refused(terrain_in("EPSG:4326"), options("EPSG:4171")), "PROJECT_UNFIT  project");
    EXPECT_EQ(refused(terrain_in("EPSG:4326"), options("EPSG:999999")), "CRS_UNKNOWN  project");
    EXPECT_EQ(refused(terrain_in("EPSG:4326"), options("metres")), "CRS_UNKNOWN  project");
}

TEST(TerrainSystem, EveryVertexWithoutAPlaceIsTold) {
    Terrain terrain = terrain_in("EPSG:4326");
    terrain.mesh.vertices[1] = {48.85, 2.36, 0};
    terrain.mesh.vertices[2] = {650000, 6860000, 0};
    const auto out = in_its_system(terrain, options("EPSG:2154"), {});
    ASSERT_FALSE(out);
    ASSERT_EQ(out.faults().size(), 2U);
    EXPECT_EQ(out.faults()[0].code, "CRS_OUT_OF_AREA");
    EXPECT_EQ(out.faults()[0].index, 1U);
    EXPECT_EQ(out.faults()[1].code, "COORDINATE_OUT_OF_RANGE");
    EXPECT_EQ(out.faults()[1].index, 2U);
    ReadLimits one;
    one.max_faults = 1;
    EXPECT_EQ(in_its_system(terrain, options("EPSG:2154"), one).faults().size(), 1U);
}

TEST(TerrainSystem, CanBeStopped) {
    ReadLimits limits;
    limits.progress = [](double) { return false; };
    const auto out = in_its_system(terrain_in("EPSG:4326"), options("auto"), limits);
    ASSERT_FALSE(out);
    EXPECT_EQ(out.kind(), FaultKind::Stopped);
}

}  // namespace
}  // namespace tinsmith::api
