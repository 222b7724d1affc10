// SPDX-License-Identifier: Apache-2.0
// What is refused and how, that a refusal changes nothing, and that results repeat.
#include "core/integrate/integrator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/mesh/walk.hpp"
#include "tests/unit/core/fixtures.hpp"

namespace tinsmith {
namespace {

using namespace core;
using test::built;
using test::grid;
using test::line;
using test::ring;

/// Integrates what is to be refused; the mesh must be as it was, slots and all.
Errors refused(Tin& tin, const std::vector<Shape>& shapes, const IntegrateOptions& options = {}) {
    const Tin before = tin;
    const auto near = tin.boundary().near(tin.bounds().min.plan(), tin.bounds().max.plan());
    const Result<Report> report = integrate(tin, shapes, options);
    EXPECT_FALSE(report);
    EXPECT_TRUE(test::same_slots(tin, before)) << "a refusal changed the mesh";
    EXPECT_EQ(tin.boundary().near(tin.bounds().min.plan(), tin.bounds().max.plan()), near);
    EXPECT_TRUE(test::check_valid(tin).empty());
    return report ? Errors{{ErrorCode::StepBudget, "was not refused", {}}} : report.errors();
}

Errors refused(const std::vector<Shape>& shapes, const IntegrateOptions& options = {}) {
    Tin tin = built(grid(6, 6, test::Diagonals::Alternate));
    return refused(tin, shapes, options);
}

bool says(const Error& error, const std::string& words) {
    return error.detail.find(words) != std::string::npos;
}

TEST(Integrate, RefusesWhatIsWhollyOutsideAndTellsBothExtents) {
    const Errors errors = refused({ring({{10, 20}, {12, 20}, {11, 23}}), line({{-3, 8}, {-1, 9}})});
    ASSERT_EQ(errors[0].code, ErrorCode::OutsideMesh);
    EXPECT_TRUE(says(errors[0], "x -3.000 to 12.000, y 8.000 to 23.000")) << errors[0].detail;
    EXPECT_TRUE(says(errors[0], "x 0.000 to 6.000, y 0.000 to 6.000")) << errors[0].detail;
    EXPECT_FALSE(says(errors[0], "degrees"));
    EXPECT_EQ(errors[0].place.position, (Point2{10, 20}));
}

TEST(Integrate, SaysDegreesWhenTheRequestLooksLikeThem) {
    Tin tin = built(grid(3, 3, test::Diagonals::Rising, 30.0, {3e5, 4.7e6}));
    const Errors errors = refused(tin, {ring({{23.3, 42.6}, {23.4, 42.6}, {23.4, 42.7}})});
    ASSERT_EQ(errors[0].code, ErrorCode::OutsideMesh);
    EXPECT_TRUE(says(errors[0], "degrees")) << errors[0].detail;
    Tin same = built(grid(3, 3, test::Diagonals::Rising, 30.0, {3e5, 4.7e6}));
    EXPECT_FALSE(says(refused(same, {line({{3e5, 200}, {3e5, 300}})})[0], "degrees"));
}

TEST(Integrate, RefusesARingInAHoleOfTheMesh) {
    Tin tin = built(test::ring_of_cells());
    EXPECT_EQ(refused(tin, {ring({{1.2, 1.2}, {1.8, 1.2}, {1.5, 1.8}})})[0].code,
              ErrorCode::OutsideMesh);
}

TEST(Integrate, RefusesARequestWithoutAPosition) {
    EXPECT_EQ(refused({})[0].code, ErrorCode::ShapeEmpty);
    EXPECT_EQ(refused({Shape{}})[0].code, ErrorCode::ShapeEmpty);
    EXPECT_EQ(refused({line({})})[0].code, ErrorCode::ShapeEmpty);
}

TEST(Integrate, TakesAnEmptyShapeBesideOthers) {
    Tin tin = built(grid(4, 4));
    const auto outcome =
        test::integrate_checked(tin, {Shape{}, line({{0.5, 0.25}, {1.5, 0.25}}), line({})});
    EXPECT_EQ(outcome.broken, "");
    ASSERT_EQ(outcome.report.shapes.size(), 3u);
    EXPECT_EQ(outcome.shape(0).vertices_added, 0u);
    EXPECT_EQ(outcome.shape(2).segments, 0u);
}

TEST(Integrate, NamesEveryCoordinateThatCannotBe) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Shape holes = ring({{1, 1}, {2, 1}, {2, 2}});
    holes.paths.push_back({{{1.2, 1.2}, {nan, 1.3}, {1.3, 1e300}}, true});
    const Errors errors = refused({line({{0.5, 0.5}, {1.5, HUGE_VAL}}), holes});
    ASSERT_EQ(errors.size(), 3u);
    EXPECT_EQ(errors[0].code, ErrorCode::CoordinateNotFinite);
    EXPECT_EQ(errors[0].place.shape, 0u);
    EXPECT_EQ(errors[0].place.point, 1u);
    EXPECT_EQ(errors[1].code, ErrorCode::CoordinateNotFinite);
    EXPECT_EQ(errors[1].place.path, 1u);
    EXPECT_EQ(errors[2].code, ErrorCode::CoordinateOutOfRange);
    EXPECT_EQ(errors[2].place.shape, 1u);
    EXPECT_EQ(errors[2].place.point, 2u);
}

TEST(Integrate, RejectNamesEveryPartThatIsOutside) {
    IntegrateOptions options;
    options.outside = Outside::Reject;
    Shape two = line({{1.3, 1.2}, {-1, 1.6}, {1.2, 2.3}});
    two.paths.push_back({{{3.3, 3.2}, {3.4, 9}}, false});
    const Errors errors = refused({line({{0.5, 0.7}, {2.2, 0.3}}), two}, options);
    ASSERT_EQ(errors.size(), 2u);
    for (const Error& error : errors) {
        EXPECT_EQ(error.code, ErrorCode::LeavesMesh);
        EXPECT_EQ(error.place.shape, 1u);
    }
    EXPECT_EQ(errors[0].place.path, 0u);
    EXPECT_EQ(errors[0].place.position->x, 0.0);
    EXPECT_EQ(errors[1].place.path, 1u);
    EXPECT_EQ(errors[1].place.position->y, 6.0);
    EXPECT_TRUE(says(errors[1], "9.000")) << errors[1].detail;
}

TEST(Integrate, RejectTakesWhatTouchesTheOutlineFromInside) {
    IntegrateOptions options;
    options.outside = Outside::Reject;
    Tin tin = built(grid(6, 6));
    EXPECT_EQ(test::integrate_checked(
                  tin, {ring({{0, 0}, {6, 0}, {6, 6}, {0, 6}}), ring({{1, 1}, {0, 2.5}, {1, 3}})},
                  options)
                  .broken,
              "");
}

TEST(Integrate, IsAtomicWhenALaterShapeIsRefused) {
    IntegrateOptions options;
    options.outside = Outside::Reject;
    refused({ring({{0.5, 0.6}, {5.1, 0.7}, {3.3, 5.2}}), line({{0.3, 5.5}, {5.7, 0.3}}),
             line({{3, 3}, {9, 9}})},
            options);
}

TEST(Integrate, StopsAtItsBudgetOfCrossings) {
    const std::vector<Shape> shapes{line({{0.1, 0.3}, {5.7, 0.6}}), line({{0.2, 5.9}, {5.8, 5.1}})};
    Tin tin = built(grid(6, 6, test::Diagonals::Alternate));
    const auto free = integrate(tin, shapes, {});
    ASSERT_TRUE(free);
    IntegrateOptions options;
    options.max_crossings = free->shapes[0].crossings + free->shapes[1].crossings;
    Tin enough = built(grid(6, 6, test::Diagonals::Alternate));
    EXPECT_TRUE(integrate(enough, shapes, options));
    for (std::uint64_t budget = 0; budget < 4; ++budget) {
        options.max_crossings = budget;
        EXPECT_EQ(refused(shapes, options)[0].code, ErrorCode::CrossingBudget) << budget;
    }
}

TEST(Integrate, StopsAtItsBudgetOfTriangles) {
    const std::vector<Shape> shapes{ring({{0.6, 0.7}, {5.1, 0.9}, {5.3, 5.4}, {0.2, 4.8}})};
    for (std::uint64_t budget : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{17}}) {
        IntegrateOptions options;
        options.max_new_triangles = budget;
        EXPECT_EQ(refused(shapes, options)[0].code, ErrorCode::TriangleBudget) << budget;
    }
    IntegrateOptions options;
    options.max_new_triangles = 1000;
    Tin tin = built(grid(6, 6));
    EXPECT_TRUE(integrate(tin, shapes, options));
}

TEST(Integrate, TakesWhatItsBudgetsJustAllowAndNothingMore) {
    const std::vector<Shape> shapes{line({{0.55, 0.25}, {2.5, 0.25}, {2.6, 1.7}})};
    Tin tin = built(grid(6, 6, test::Diagonals::Alternate));
    const auto free = integrate(tin, shapes, {});
    ASSERT_TRUE(free);
    const ShapeReport& need = free->shapes[0];
    for (std::uint64_t budget = 0; budget < need.triangles_added + 3; ++budget) {
        IntegrateOptions options;
        options.max_new_triangles = budget;
        Tin tried = built(grid(6, 6, test::Diagonals::Alternate));
        EXPECT_EQ(integrate(tried, shapes, options).ok(), budget >= need.triangles_added)
            << budget << " triangles, needed " << need.triangles_added;
    }
    for (std::uint64_t budget = 0; budget < need.crossings + 3; ++budget) {
        IntegrateOptions options;
        options.max_crossings = budget;
        Tin tried = built(grid(6, 6, test::Diagonals::Alternate));
        EXPECT_EQ(integrate(tried, shapes, options).ok(), budget >= need.crossings)
            << budget << " crossings, needed " << need.crossings;
    }
}

TEST(Integrate, HoldsTheWholeRequestToItsBudgets) {
    // Twenty lines of 11 crossings each: a budget of 50 is for the request, not for each shape.
    std::vector<Shape> shapes;
    for (int i = 0; i < 20; ++i)
        shapes.push_back(line({{0.1, 0.11 + 0.28 * i}, {5.9, 0.12 + 0.28 * i}}));
    IntegrateOptions options;
    options.max_crossings = 50;
    EXPECT_EQ(refused(shapes, options)[0].code, ErrorCode::CrossingBudget);
    IntegrateOptions triangles;
    triangles.max_new_triangles = 100;
    EXPECT_EQ(refused(shapes, triangles)[0].code, ErrorCode::TriangleBudget);
}

TEST(Integrate, CountsPointsAloneAgainstItsBudgetOfTriangles) {
    Shape points;
    for (int i = 0; i < 200; ++i)
        points.paths.push_back({{{0.1 + 0.025 * i, 0.3 + 0.01 * i}}, false});
    IntegrateOptions options;
    options.max_new_triangles = 10;
    EXPECT_EQ(refused({points}, options)[0].code, ErrorCode::TriangleBudget);
}

TEST(Integrate, StopsWhenCancelledAtAnyTime) {
    std::vector<Shape> shapes;
    for (int i = 0; i < 50; ++i)
        shapes.push_back(ring({{0.6, 0.7 + 0.1 * i}, {5.1, 0.9}, {5.3, 5.4}, {0.2, 4.8}}));
    int asked = 0;
    IntegrateOptions never;
    never.cancelled = [&asked] { return ++asked < 0; };
    Tin tin = built(grid(6, 6));
    EXPECT_TRUE(integrate(tin, shapes, never));
    ASSERT_GE(asked, 50) << "at least once for each shape";
    for (const int after : {0, 1, asked / 2, asked - 1}) {
        int answered = 0;
        IntegrateOptions options;
        options.cancelled = [&answered, after] { return answered++ >= after; };
        const Errors errors = refused(shapes, options);
        EXPECT_EQ(errors[0].code, ErrorCode::Cancelled) << after;
    }
}

TEST(Integrate, StopsWhenCancelledAmongSwapsAcrossFacets) {
    Tin whole = built(grid(20, 20));
    IntegrateOptions options;
    options.improve = Improve::Paper;
    int asked = 0;
    options.cancelled = [&] { return ++asked < 0; };
    const Shape shape = test::ring({{0.3, 0.2}, {19.6, 1.4}, {18.2, 19.5}, {1.7, 18.1}});
    ASSERT_TRUE(integrate(whole, {&shape, 1}, options).ok());
    // The last question is asked when all is marched.
    const int last = asked;
    Tin tin = built(grid(20, 20));
    const MeshData before = tin.to_data();
    asked = 0;
    options.cancelled = [&] { return ++asked == last; };
    const auto report = integrate(tin, {&shape, 1}, options);
    ASSERT_FALSE(report.ok());
    EXPECT_EQ(report.errors()[0].code, ErrorCode::Cancelled);
    EXPECT_TRUE(test::same_bytes(before, tin.to_data()));
}

TEST(Integrate, AsksWhetherItIsCancelledAlsoWhenThereAreOnlyPoints) {
    Shape points;
    for (int i = 0; i < 2000; ++i)
        points.paths.push_back({{{0.1 + 0.0025 * i, 0.3 + 0.001 * i}}, false});
    IntegrateOptions options;
    options.cancelled = [] { return true; };
    EXPECT_EQ(refused({points}, options)[0].code, ErrorCode::Cancelled);
}

TEST(Integrate, TellsWhichSegmentItStoppedAt) {
    Shape shape = line({{0.2, 0.4}, {0.7, 0.3}});
    shape.paths.push_back({{{0.3, 5.6}, {0.3, 5.6}, {0.4, 5.7}, {5.7, 5.2}}, false});
    IntegrateOptions options;
    options.max_crossings = 3;
    const Errors errors = refused({shape}, options);
    EXPECT_EQ(errors[0].place.shape, 0u);
    EXPECT_EQ(errors[0].place.path, 1u);
    EXPECT_EQ(errors[0].place.point, 2u);
    EXPECT_TRUE(errors[0].place.position.has_value());
}

TEST(Integrate, GivesTheSameBytesForTheSameOperations) {
    const auto run = [](Tin& tin) {
        for (int i = 0; i < 6; ++i) {
            Shape shape = ring({});
            for (int k = 0; k < 25; ++k)
                shape.paths[0].points.push_back({3 + (1 + 0.3 * i) * std::cos(k * 0.2513274 + i),
                                                 3 + (1 + 0.3 * i) * std::sin(k * 0.2513274 + i)});
            ASSERT_TRUE(integrate(tin, std::vector{shape, line({{0, 0.5 * i}, {6, 5.7}})}, {}));
        }
    };
    Tin first = built(grid(6, 6)), second = built(grid(6, 6));
    run(first);
    Tin copy = second;  // a copy is as good as the original
    run(copy);
    EXPECT_TRUE(test::same_slots(first, copy));
    // A refusal in between leaves no trace.
    IntegrateOptions tight;
    tight.max_crossings = 2;
    refused(second, {ring({{0.6, 0.7}, {5.1, 0.9}, {5.3, 5.4}})}, tight);
    run(second);
    EXPECT_TRUE(test::same_slots(first, second));
}

}  // namespace
}  // namespace tinsmith
