// SPDX-License-Identifier: Apache-2.0
// A digest of everything that a fixed set of operations makes of their meshes. Two builds print the
// same line, or one of them computes differently: see compare.sh. Each operation is also taken back
// and done again, which must give the same bytes.
//
// Usage: operation_digest [--each] [WALK_SEED]
//   --each      a line for each operation as well: its number, its digest, what came of it
//   WALK_SEED   where walks begin (0); it must not show
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/integrate/integrator.hpp"
#include "core/integrate/lock.hpp"
#include "core/mesh/build.hpp"
#include "core/regions/region.hpp"
#include "core/types/algorithm.hpp"
#include "tests/digest/bundled.hpp"
#include "tests/digest/dice.hpp"
#include "tests/digest/fnv.hpp"
#include "tests/digest/ground.hpp"

namespace tinsmith::digest {

namespace {

using namespace core;

/// The mesh's plain buffers, and what the structure holds beside them.
std::uint64_t digest_of(const Tin& tin) {
    Fnv fnv;
    const MeshData data = tin.to_data();
    for (const Point3& v : data.vertices) {
        fnv.add(v.x);
        fnv.add(v.y);
        fnv.add(v.z);
    }
    for (const auto& t : data.triangles)
        for (const std::uint32_t v : t)
            fnv.add(std::uint64_t{v});
    for (const auto& [a, b] : data.constraints)
        fnv.add(std::uint64_t{a} << 32U | b);
    for (std::uint32_t v = 0; v < tin.vertex_count(); ++v)
        fnv.add(std::uint64_t{tin.vertex({v}).triangle.value});
    for (std::uint32_t t = 0; t < tin.triangle_count(); ++t) {
        const Tin::Triangle& triangle = tin.triangle({t});
        fnv.add(std::uint64_t{triangle.facet.value} << 32U | triangle.marks);
        for (const Side s : triangle.twins)
            fnv.add(std::uint64_t{s.code});
    }
    for (const ConstraintSplit& split : tin.constraint_splits()) {
        fnv.add(std::uint64_t{split.a.value} << 32U | split.b.value);
        fnv.add(std::uint64_t{split.p.value});
    }
    fnv.add(std::uint64_t{tin.next_facet()});
    fnv.add(tin.facet_error());
    return fnv.value();
}

void add_points(Fnv& fnv, const std::vector<Point2>& points) {
    fnv.add(std::uint64_t{points.size()});
    for (const Point2 p : points) {
        fnv.add(p.x);
        fnv.add(p.y);
    }
}

/// Everything but times and angles: those are shown through the C library's asin.
void add_report(Fnv& fnv, const ShapeReport& report) {
    for (const std::uint64_t count : {report.segments, report.crossings, report.vertices_added,
                                      report.triangles_added, report.edges_swapped})
        fnv.add(count);
    for (const double bound :
         {report.max_vertical_deviation, report.max_plan_deviation, report.max_elevation_change})
        fnv.add(bound);
    for (const OutsidePart& part : report.outside) {
        fnv.add(std::uint64_t{part.path});
        add_points(fnv, part.points);
    }
    for (const Chain& chain : report.chains) {
        fnv.add(std::uint64_t{chain.path});
        for (const VertexId v : chain.vertices)
            fnv.add(std::uint64_t{v.value});
    }
}

void add_errors(Fnv& fnv, const Errors& errors) {
    for (const Error& error : errors) {
        fnv.add(static_cast<std::uint64_t>(error.code));
        for (const auto& index : {error.place.vertex, error.place.triangle, error.place.shape,
                                  error.place.path, error.place.point})
            fnv.add(std::uint64_t{index.value_or(SIZE_MAX)});
        if (error.place.position) add_points(fnv, {*error.place.position});
    }
}

/// Runs the operations and keeps the digest of them all.
class Run {
  public:
    Run(std::uint32_t walk_seed, bool each) : walk_seed_(walk_seed), each_(each) {}

    std::uint64_t digest() const { return all_.value(); }
    std::size_t operations() const { return operations_; }
    std::size_t refused() const { return refused_; }
    bool good() const { return good_; }

    void integrate(Tin& tin, const std::vector<Shape>& shapes, IntegrateOptions options) {
        options.walk_seed = walk_seed_;
        const auto once = [&](Fnv& fnv, Undo& undo) -> std::string {
            const auto report = core::integrate(tin, shapes, options, &undo);
            if (!report) {
                add_errors(fnv, report.errors());
                return std::string(code_name(report.errors()[0].code));
            }
            const ConstraintHistory history(tin);
            for (std::size_t s = 0; s < shapes.size(); ++s) {
                const ShapeReport& made = report->shapes[s];
                add_report(fnv, made);
                const Region region = find_region(
                    tin, history, {shapes[s], made.chains, made.outside}, Winding::EvenOdd);
                for (const TriangleId t : region.triangles)
                    fnv.add(std::uint64_t{t.value});
                fnv.add(region.plan_area);
                fnv.add(region.surface_area);
            }
            return "";
        };
        twice(tin, once);
    }

    void lock(Tin& tin, const Path& line, double reach, bool locked) {
        const auto once = [&](Fnv& fnv, Undo& undo) -> std::string {
            const auto report = lock_along(tin, line, reach, locked, &undo);
            if (!report) {
                add_errors(fnv, report.errors());
                return std::string(code_name(report.errors()[0].code));
            }
            fnv.add(std::uint64_t{report->edges});
            fnv.add(std::uint64_t{report->changed});
            fnv.add(report->length);
            for (const auto& part : report->without_edge)
                add_points(fnv, part);
            return "";
        };
        twice(tin, once);
    }

  private:
    /// Does an operation, takes it back, does it again. `once` answers with the refusal, if any.
    template <typename Once>
    void twice(Tin& tin, const Once& once) {
        const std::uint64_t before = digest_of(tin);
        Fnv first, second;
        Undo undo;
        const std::string refusal = once(first, undo);
        first.add(digest_of(tin));
        if (refusal.empty()) {
            take_back(tin, undo);
            require(digest_of(tin) == before, "taking it back does not restore the mesh");
            undo = {};
            require(once(second, undo).empty(), "it is refused the second time");
            second.add(digest_of(tin));
            require(second.value() == first.value(), "it gives something else the second time");
        } else {
            require(digest_of(tin) == before, "a refusal changed the mesh");
            ++refused_;
        }
        if (each_)
            std::printf("%4zu %016llx %s\n", operations_,
                        static_cast<unsigned long long>(first.value()),
                        refusal.empty() ? "done" : refusal.c_str());
        all_.add(first.value());
        ++operations_;
    }

    void require(bool holds, const char* otherwise) {
        if (holds) return;
        good_ = false;
        std::fprintf(stderr, "operation %zu: %s\n", operations_, otherwise);
    }

    std::uint32_t walk_seed_;
    bool each_;
    Fnv all_;
    std::size_t operations_ = 0;
    std::size_t refused_ = 0;
    bool good_ = true;
};

IntegrateOptions make_options(Dice& dice, const Ground& ground) {
    constexpr Improve kModes[]{Improve::None, Improve::Strict, Improve::Paper, Improve::Bounded};
    IntegrateOptions options;
    options.improve = kModes[dice.below(4)];
    options.max_deviation = ground.height * (dice.one_in(2) ? 0x1p-3 : 0x1p-8);
    if (dice.one_in(2)) options.snap = ground.along * (dice.one_in(2) ? 0x1p-3 : 0x1p-10);
    if (dice.one_in(2)) options.on_crossing = OnCrossing::Old;
    if (dice.one_in(8)) options.outside = Outside::Reject;
    options.lock = dice.one_in(6);
    if (dice.one_in(24)) options.max_crossings = dice.below(12);
    if (dice.one_in(24)) options.max_new_triangles = dice.below(24);
    return options;
}

/// What no mesh can take.
void spoil(Dice& dice, Shape& shape) {
    constexpr double kNone[]{std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(), 1e16, 1e-70};
    Path& path = shape.paths[dice.below(static_cast<std::uint32_t>(shape.paths.size()))];
    path.points[dice.below(static_cast<std::uint32_t>(path.points.size()))].y =
        kNone[dice.below(4)];
}

void operate(Run& run, Dice& dice, const Ground& ground, Tin& tin) {
    for (int i = 0; i < 6; ++i) {
        if (dice.one_in(10)) {
            const Path line = make_post_line(dice, ground);
            const double reach = dice.one_in(2) ? 0.0 : ground.along * 0.25;
            run.lock(tin, line, reach, !dice.one_in(4));
            continue;
        }
        std::vector<Shape> shapes;
        for (std::uint32_t count = dice.one_in(4) ? 2 : 1; count > 0; --count) {
            shapes.push_back(make_shape(dice, ground));
            if (dice.one_in(3)) give_elevations(dice, ground, shapes.back());
        }
        if (dice.one_in(24)) spoil(dice, shapes.back());
        run.integrate(tin, shapes, make_options(dice, ground));
    }
}

void run_random(Run& run) {
    for (std::uint32_t seed = 0; seed < 84; ++seed) {
        Dice dice(seed);
        const Ground ground =
            make_ground(static_cast<Ground::Kind>(seed % Ground::kKinds), 1 + dice.below(8));
        const MeshData mesh = make_mesh(dice, ground);
        auto tin = build_tin(mesh);
        if (tin) operate(run, dice, ground, *tin);
    }
}

/// The bundled polygons on a made-up terrain where they lie, by each way of improving it.
bool run_bundled(Run& run) {
    const std::vector<Shape> shapes = read_bundled(TINSMITH_SOURCE_DIR "/tests/data");
    if (shapes.empty()) return false;
    for (const Improve improve :
         {Improve::None, Improve::Strict, Improve::Paper, Improve::Bounded}) {
        Dice dice(1000);
        Ground ground = make_ground(Ground::Kind::Map, 60);
        ground.across = ground.along = 512.0;
        auto tin = build_tin(make_mesh(dice, ground));
        if (!tin) return false;
        for (const Shape& shape : shapes) {
            IntegrateOptions options;
            options.improve = improve;
            options.max_deviation = 0.5;
            options.snap = dice.one_in(2) ? 0.0 : 0.25;
            run.integrate(*tin, {shape}, options);
        }
    }
    return true;
}

}  // namespace

}  // namespace tinsmith::digest

int main(int count, char** arguments) {
    bool each = false;
    std::uint32_t walk_seed = 0;
    for (int i = 1; i < count; ++i) {
        const char* const end = arguments[i] + std::strlen(arguments[i]);
        if (std::strcmp(arguments[i], "--each") == 0) {
            each = true;
        } else if (std::from_chars(arguments[i], end, walk_seed).ptr != end) {
            std::fprintf(stderr, "Usage: operation_digest [--each] [WALK_SEED]\n");
            return 2;
        }
    }
    tinsmith::digest::Run run(walk_seed, each);
    run_random(run);
    if (!run_bundled(run)) {
        std::fprintf(stderr, "the bundled polygons cannot be read\n");
        return 1;
    }
    std::printf("algorithm %u: %016llx %zu operations, %zu of them refused\n",
                static_cast<unsigned>(tinsmith::core::kAlgorithm),
                static_cast<unsigned long long>(run.digest()), run.operations(), run.refused());
    return run.good() ? 0 : 1;
}
