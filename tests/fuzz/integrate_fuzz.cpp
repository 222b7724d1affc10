// SPDX-License-Identifier: Apache-2.0
// Small meshes and requests made of bytes: positions on a fine lattice moved by a few ulps, where
// everything degenerate happens, with every option. Whatever the input: the mesh stays valid, the
// chains are near their paths and constrained, all numbers are finite, what is taken back or
// refused leaves the mesh bit for bit as it was, and doing it again gives the same bytes.
//
// The bytes, in order (what is missing is zero):
//   ground    bits 0-1: at 0, 5e6, map coordinates, 5e6 and fine; 2: needles; 3: cliffs; 4: moved
//   columns   1 + value % 4, as many rows
//   posts     where moved: a byte each, row by row
//   cells     a byte each: % 5 == 0 is missing, else the last bit turns the diagonal
//   requests  until the bytes end, see `make_request`
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <utility>
#include <vector>

#include "core/integrate/integrator.hpp"
#include "core/mesh/build.hpp"
#include "core/mesh/check.hpp"
#include "core/regions/region.hpp"
#include "core/types/range.hpp"
#include "core/types/ulp.hpp"

namespace {

using namespace tinsmith::core;

void require(bool holds, const char* otherwise) {
    if (holds) return;
    std::fprintf(stderr, "broken: %s\n", otherwise);
    std::abort();
}

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

/// How cells lie in the plane.
struct Ground {
    Point2 origin;
    double across = 1.0, along = 1.0;  ///< a cell's size
    double height = 1.0;               ///< elevations are from 0 to three times this

    Point2 at(double column, double row) const {
        return {origin.x + column * across, origin.y + row * along};
    }
};

Ground make_ground(std::uint8_t kind) {
    Ground ground;
    switch (kind & 3U) {
        case 1:
            ground.origin = {5e6, 5e6};
            break;
        case 2:
            ground = {{731728.3, 4004667.7}, 25.0, 25.0, 20.0};
            break;
        case 3:
            ground = {{5e6, 5e6}, 0x1p-10, 0x1p-10, 0x1p-10};
            break;
        default:
            if ((kind & 4U) != 0) ground.along = ground.height = 0x1p-30;
            break;
    }
    if ((kind & 8U) != 0) ground.height *= 500.0;
    return ground;
}

/// A grid of up to 4 x 4 cells, some of them missing.
MeshData make_mesh(Bytes& bytes, const Ground& ground, bool moved) {
    const std::uint32_t columns = 1 + bytes.next() % 4;
    MeshData mesh;
    for (std::uint32_t r = 0; r <= columns; ++r) {
        for (std::uint32_t c = 0; c <= columns; ++c) {
            const std::uint8_t move = moved ? bytes.next() : std::uint8_t{0};
            const Point2 p = ground.at(c + move % 16 / 48.0, r + move / 16 / 48.0);
            mesh.vertices.push_back({p.x, p.y, ground.height * ((c * 7 + r * 5 + move) % 4)});
        }
    }
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

/// Two bytes: a place, every sixteenth of a cell from half a cell before the mesh on; then bits
/// 0-2 that many ulps on (bit 3: back), bits 4-7 that many 1/768 of a cell on.
double make_coordinate(Bytes& bytes, double origin, double size) {
    const std::uint8_t place = bytes.next();
    const std::uint8_t nudge = bytes.next();
    double x = origin + (place % 81 / 16.0 - 0.5 + nudge / 16 / 768.0) * size;
    for (int i = 0; i < nudge % 8; ++i)
        x = neighbour(x, (nudge & 8U) != 0);
    return in_coordinate_range(x) ? x : origin;
}

/// A byte: bit 0 closed, bit 1 elevations of its own, the rest % 12 the points after the first;
/// then each point's coordinates, and a byte for its elevation where it has one.
Path make_path(Bytes& bytes, const Ground& ground) {
    const std::uint8_t head = bytes.next();
    Path path;
    path.closed = (head & 1U) != 0;
    for (int i = 0; i < 1 + head / 4 % 12; ++i) {
        const double x = make_coordinate(bytes, ground.origin.x, ground.across);
        path.points.push_back({x, make_coordinate(bytes, ground.origin.y, ground.along)});
        if ((head & 2U) == 0) continue;
        path.elevations.push_back(ground.height * (bytes.next() % 40 - 8) / 8.0);
    }
    return path;
}

struct Request {
    IntegrateOptions options;
    bool kept = false;
    std::vector<Shape> shapes;
};

/// Three bytes. The first: bits 0-1 the mode, 2 reject, 3 lock, 4 old elevations on crossings, 5
/// not kept, 6-7 shapes after the first (% 3). The second: bits 0-2 the snap, 3-4 the deviation,
/// 5-7 a limit, whose value follows. Then each shape: a byte for its paths after the first (% 3).
Request make_request(Bytes& bytes, const Ground& ground) {
    constexpr std::array<Improve, 4> kModes{Improve::None, Improve::Strict, Improve::Paper,
                                            Improve::Bounded};
    constexpr std::array<double, 8> kSnaps{0.0,     0x1p-45, 0x1p-30, 0x1p-20,
                                           0x1p-10, 0x1p-6,  0x1p-3,  0.5};
    constexpr std::array<double, 4> kDeviations{0.0, 0x1p-20, 0x1p-5, 1.0};
    Request request;
    const std::uint8_t head = bytes.next();
    IntegrateOptions& options = request.options;
    options.improve = kModes[head & 3U];
    options.outside = (head & 4U) != 0 ? Outside::Reject : Outside::Skip;
    options.lock = (head & 8U) != 0;
    options.on_crossing = (head & 16U) != 0 ? OnCrossing::Old : OnCrossing::New;
    request.kept = (head & 32U) == 0;
    const std::uint8_t sizes = bytes.next();
    options.snap = kSnaps[sizes & 7U] * ground.along;
    options.max_deviation = kDeviations[sizes >> 3U & 3U] * ground.height;
    if (sizes >> 5U == 6) options.max_crossings = bytes.next();
    if (sizes >> 5U == 7) options.max_new_triangles = bytes.next();
    for (int shapes = 1 + (head >> 6U) % 3; shapes > 0; --shapes) {
        Shape& shape = request.shapes.emplace_back();
        for (int paths = 1 + bytes.next() % 3; paths > 0; --paths)
            shape.paths.push_back(make_path(bytes, ground));
    }
    return request;
}

/// All that the structure holds, bit for bit.
struct Snapshot {
    explicit Snapshot(const Tin& tin) : next_facet(tin.next_facet()), error(tin.facet_error()) {
        for (std::uint32_t v = 0; v < tin.vertex_count(); ++v)
            vertices.push_back(tin.vertex({v}));
        for (std::uint32_t t = 0; t < tin.triangle_count(); ++t)
            triangles.push_back(tin.triangle({t}));
        splits = tin.constraint_splits().size();
    }

    bool same(const Snapshot& other) const {
        if (vertices.size() != other.vertices.size()) return false;
        for (std::size_t v = 0; v < vertices.size(); ++v) {
            const Tin::Vertex& l = vertices[v];
            const Tin::Vertex& r = other.vertices[v];
            // By bits: -0 is not 0.
            for (const auto& [x, y] : {std::pair{l.x, r.x}, {l.y, r.y}, {l.z, r.z}})
                if (std::bit_cast<std::uint64_t>(x) != std::bit_cast<std::uint64_t>(y))
                    return false;
            if (l.triangle != r.triangle) return false;
        }
        return triangles == other.triangles && splits == other.splits &&
               next_facet == other.next_facet && error == other.error;
    }

  private:
    std::vector<Tin::Vertex> vertices;
    std::vector<Tin::Triangle> triangles;
    std::uint32_t next_facet;
    double error;
    std::size_t splits = 0;
};

/// In more than double precision: what is checked is a few ulps.
bool is_within(Point2 p, Point2 a, Point2 b, double reach) {
    using Wide = long double;
    const Wide dx = Wide{b.x} - a.x, dy = Wide{b.y} - a.y;
    const Wide px = Wide{p.x} - a.x, py = Wide{p.y} - a.y;
    const Wide squared = dx * dx + dy * dy;
    Wide along = squared > 0 ? (px * dx + py * dy) / squared : Wide{0};
    along = along < 0 ? Wide{0} : along > 1 ? Wide{1} : along;
    const Wide off_x = px - along * dx, off_y = py - along * dy;
    return off_x * off_x + off_y * off_y <= Wide{reach} * reach * (1 + 1e-9L);
}

bool is_near_path(Point2 p, const Path& path, double reach) {
    const std::size_t count = path.points.size();
    if (count == 1) return is_within(p, path.points[0], path.points[0], reach);
    for (std::size_t i = 0; i + (path.closed ? 0 : 1) < count; ++i)
        if (is_within(p, path.points[i], path.points[(i + 1) % count], reach)) return true;
    return false;
}

double rounding_reach(const Tin& tin) {
    const Bounds& box = tin.bounds();
    double largest = 0.0;
    for (const double x : {box.min.x, box.min.y, box.max.x, box.max.y})
        largest = std::fmax(largest, std::fabs(x));
    return 4.0 * ulp(largest);
}

void check_report(const ShapeReport& report) {
    const AngleSummary& angles = report.smallest_angle_deg;
    for (const double x :
         {report.max_vertical_deviation, report.max_plan_deviation, report.max_elevation_change,
          angles.before, angles.after, angles.p1_before, angles.p1_after})
        require(std::isfinite(x) && x >= 0.0, "a number of the report");
    for (const OutsidePart& part : report.outside)
        for (const Point2 p : part.points)
            require(std::isfinite(p.x) && std::isfinite(p.y), "a point outside");
}

void check_result(const Tin& tin, const Request& request, const Report& report, double reach) {
    require(report.shapes.size() == request.shapes.size(), "a report for each shape");
    const MeshData data = tin.to_data();
    for (const Point3& v : data.vertices)
        require(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z), "not finite");
    std::set<std::pair<std::uint32_t, std::uint32_t>> constraints;
    for (const auto& [a, b] : data.constraints)
        constraints.insert(std::minmax(a, b));
    const ConstraintHistory history(tin);
    for (std::size_t s = 0; s < report.shapes.size(); ++s) {
        const ShapeReport& made = report.shapes[s];
        const Shape& shape = request.shapes[s];
        check_report(made);
        require(made.max_plan_deviation <= reach, "the plan deviation reported");
        for (const Chain& chain : made.chains) {
            for (const VertexId v : chain.vertices)
                require(is_near_path(tin.plan(v), shape.paths[chain.path], reach),
                        "a chain away from its path");
            const std::vector<VertexId> now = history.expand(chain.vertices);
            for (std::size_t i = 1; i < now.size(); ++i)
                require(constraints.count(std::minmax(now[i - 1].value, now[i].value)) == 1,
                        "a chain without its constrained edge");
        }
        const Region region =
            find_region(tin, history, {shape, made.chains, made.outside}, Winding::EvenOdd);
        require(std::isfinite(region.plan_area) && std::isfinite(region.surface_area), "an area");
    }
}

void run(Tin& tin, const Request& request) {
    const Snapshot before(tin);
    const double reach = std::fmax(request.options.snap, rounding_reach(tin));
    Undo undo;
    const auto report = integrate(tin, request.shapes, request.options, &undo);
    const auto violations = check_tin(tin, 1);
    require(violations.empty(), violations.empty() ? "" : violations[0].detail.c_str());
    if (!report) {
        require(report.errors()[0].code != ErrorCode::StepBudget, "STEP_BUDGET");
        require(before.same(Snapshot(tin)), "a refusal changed the mesh");
        return;
    }
    check_result(tin, request, *report, reach);
    const Snapshot after(tin);
    take_back(tin, undo);
    require(before.same(Snapshot(tin)), "taking back does not restore the mesh");
    require(check_tin(tin, 1).empty(), "invalid once taken back");
    if (!request.kept) return;
    // Walks from elsewhere give the same.
    IntegrateOptions elsewhere = request.options;
    elsewhere.walk_seed = 12345;
    require(integrate(tin, request.shapes, elsewhere).ok(), "refused the second time");
    require(after.same(Snapshot(tin)), "something else the second time");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(data, size);
    const std::uint8_t kind = bytes.next();
    const Ground ground = make_ground(kind);
    const MeshData mesh = make_mesh(bytes, ground, (kind & 16U) != 0);
    if (mesh.triangles.empty()) return 0;
    auto tin = build_tin(mesh);
    require(tin.ok(), "the mesh is refused");
    while (!bytes.empty())
        run(*tin, make_request(bytes, ground));
    return 0;
}
