// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/delaunay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/mesh/delaunay_join.hpp"
#include "core/mesh/growing_delaunay.hpp"
#include "core/mesh/insertion_order.hpp"
#include "core/predicates/orientation.hpp"
#include "core/types/ids.hpp"
#include "core/types/range.hpp"

namespace tinsmith::core {

namespace {

/// 2 n triangles, ghosts among them, are numbered as sides are.
constexpr std::size_t kMostPoints = kMaxTriangles / 2;
constexpr std::size_t kTellEvery = 16384;
constexpr std::size_t kMostSteps = 32;

/// The points of one triangulation, by their places in the order of insertion.
struct Part {
    std::size_t begin;
    std::size_t end;
    std::size_t size() const { return end - begin; }
};

class Triangulator {
  public:
    Triangulator(std::span<const Point3> points, const DelaunayOptions& options)
        : points_(points), options_(options) {}

    Result<MeshData> run() {
        check_coordinates();
        if (!errors_.empty()) return std::move(errors_);
        if (!tell(0.0)) return cancelled();
        const bool by_halves = !points_.empty() && points_.size() >= options_.least_to_part;
        order_ = insertion_order(points_, by_halves, options_.executor);
        name_differing();
        if (!errors_.empty()) return std::move(errors_);
        if (!tell(0.1)) return cancelled();
        const std::size_t count = order_.points.size(), middle = order_.middle;
        plan_.resize(count);
        triangles_ = std::make_unique_for_overwrite<GrowingDelaunay::Triangle[]>(2 * count);
        if (by_halves) {
            const Outcome halves = triangulate(std::array{Part{0, middle}, Part{middle, count}});
            if (halves == Outcome::Cancelled) return cancelled();
            if (halves == Outcome::Done && join_halves()) return result();
        }
        switch (triangulate(std::array{Part{0, count}})) {
            case Outcome::Cancelled:
                return cancelled();
            case Outcome::SpansNone:
                return Error{no_triangle()};
            case Outcome::Done:
                break;
        }
        return result();
    }

  private:
    enum class Outcome { Done, Cancelled, SpansNone };

    bool tell(double share) const { return !options_.progress || options_.progress(share); }
    static Error cancelled() { return {ErrorCode::Cancelled, "the caller stopped the work", {}}; }

    void fault(ErrorCode code, std::size_t point, const std::string& what) {
        ErrorPlace place;
        place.vertex = point;
        const Point3& p = points_[point];
        if (std::isfinite(p.x) && std::isfinite(p.y)) place.position = p.plan();
        errors_.push_back({code, "point " + std::to_string(point) + " " + what, place});
    }

    void check_coordinates();
    void name_differing();
    bool begin_with_a_triangle(Part part);
    Error no_triangle() const;
    Outcome triangulate(std::span<const Part> parts);
    bool join_halves();
    void leave_out_repeated(std::vector<Point3>& vertices);
    Result<MeshData> result();

    std::span<const Point3> points_;
    const DelaunayOptions& options_;
    InsertionOrder order_;
    /// Positions side by side in the order in which they come: neighbours share cache lines.
    std::vector<Point2> plan_;
    std::unique_ptr<GrowingDelaunay::Triangle[]> triangles_;
    Errors errors_;
};

void Triangulator::check_coordinates() {
    if (points_.size() > kMostPoints) {
        errors_.push_back({ErrorCode::MeshTooLarge,
                           "more points than ids can count triangles for: at most " +
                               std::to_string(kMostPoints) + " are taken",
                           {}});
        return;
    }
    for (std::size_t i = 0; i < points_.size() && errors_.size() < kMaxFaults; ++i) {
        const Point3& p = points_[i];
        if (in_coordinate_range(p.x) && in_coordinate_range(p.y) && in_coordinate_range(p.z))
            continue;
        if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z))
            fault(ErrorCode::CoordinateOutOfRange, i,
                  "has a coordinate out of range: zero and magnitudes from 1e-60 to 1e15 are "
                  "accepted");
        else
            fault(ErrorCode::CoordinateNotFinite, i, "has a coordinate that is not finite");
    }
}

void Triangulator::name_differing() {
    std::vector<Repeated> differ;
    for (const Repeated& one : order_.repeated)
        if (points_[one.first].z != points_[one.later].z) differ.push_back(one);
    if (differ.size() > kMaxFaults) differ.resize(kMaxFaults);
    for (const Repeated& one : differ) {
        fault(ErrorCode::ElevationTwice, one.later,
              "is at the position of point " + std::to_string(one.first) +
                  " with another elevation; keep one of them");
        errors_.back().place.earlier = one.first;
    }
}

/// Brings a point off the line of the first two to the third place.
bool Triangulator::begin_with_a_triangle(Part part) {
    const auto plan = [this](std::size_t k) { return points_[order_.points[k]].plan(); };
    std::size_t third = part.begin + 2;
    while (third < part.end && orientation(plan(part.begin), plan(part.begin + 1), plan(third)) ==
                                   Orientation::Collinear)
        ++third;
    if (third >= part.end) return false;
    const auto at = order_.points.begin() + static_cast<std::ptrdiff_t>(part.begin) + 2;
    std::rotate(at, order_.points.begin() + static_cast<std::ptrdiff_t>(third),
                order_.points.begin() + static_cast<std::ptrdiff_t>(third) + 1);
    return true;
}

Error Triangulator::no_triangle() const {
    if (order_.points.size() < 3)
        return {ErrorCode::TooFewPoints,
                "there are " + std::to_string(order_.points.size()) +
                    " distinct positions; a triangle needs three",
                {}};
    return {ErrorCode::PointsCollinear,
            "all points are on one line in plan; no triangle has an area",
            {}};
}

/// Each part by itself; the triangles of one begin where those of the other end.
Triangulator::Outcome Triangulator::triangulate(std::span<const Part> parts) {
    std::vector<Job> jobs;
    std::array<bool, 2> spans{};
    for (std::size_t i = 0; i < parts.size(); ++i)
        jobs.emplace_back([&, i] {
            const Part part = parts[i];
            draw_lots(std::span(order_.points).subspan(part.begin, part.size()));
            spans[i] = begin_with_a_triangle(part);
            for (std::size_t k = part.begin; k < part.end; ++k)
                plan_[k] = points_[order_.points[k]].plan();
        });
    options_.executor(jobs);
    std::vector<GrowingDelaunay> made;
    std::size_t longest = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (!spans[i]) return Outcome::SpansNone;
        made.emplace_back(plan_, triangles_.get(),
                          GrowingDelaunay::Share{parts[i].begin,
                                                 parts[i].begin == 0 ? 0 : 2 * parts[i].begin - 2});
        longest = std::max(longest, parts[i].size());
    }
    const std::size_t step = std::max(kTellEvery, longest / kMostSteps);
    for (std::size_t done = 3; done < longest; done += step) {
        jobs.clear();
        for (std::size_t i = 0; i < parts.size(); ++i)
            jobs.emplace_back([&, i] {
                const std::size_t end = std::min(parts[i].size(), done + step);
                for (std::size_t k = done; k < end; ++k)
                    made[i].insert(static_cast<std::uint32_t>(parts[i].begin + k));
            });
        options_.executor(jobs);
        if (!tell(0.1 + 0.8 * static_cast<double>(done) / static_cast<double>(longest)))
            return Outcome::Cancelled;
    }
    return tell(0.9) ? Outcome::Done : Outcome::Cancelled;
}

bool Triangulator::join_halves() {
    const std::size_t count = plan_.size();
    const std::span triangles(triangles_.get(), 2 * count - 2);
    return join({plan_, triangles, 2 * order_.middle - 2, order_.axis}, 2 * count);
}

/// The vertices, and by these the order.
void Triangulator::leave_out_repeated(std::vector<Point3>& vertices) {
    vertices.reserve(order_.points.size());
    std::vector<std::uint32_t> slot(points_.size());
    auto repeated = order_.repeated.begin();
    for (std::size_t i = 0; i < points_.size(); ++i) {
        slot[i] = static_cast<std::uint32_t>(vertices.size());
        if (repeated != order_.repeated.end() && repeated->later == i)
            ++repeated;
        else
            vertices.push_back(points_[i]);
    }
    for (std::uint32_t& i : order_.points)
        i = slot[i];
}

Result<MeshData> Triangulator::result() {
    MeshData mesh;
    if (order_.repeated.empty()) {
        mesh.vertices.assign(points_.begin(), points_.end());
    } else {
        leave_out_repeated(mesh.vertices);
    }
    // In parts as well: how many triangles of each are no ghosts, and then these.
    const std::size_t slots = 2 * plan_.size() - 2;
    std::array<std::size_t, 3> start{};
    const auto each_half = [&](const auto& visit) {
        const std::array<Job, 2> jobs{[&] { visit(0); }, [&] { visit(1); }};
        options_.executor(jobs);
    };
    const auto half = [&](std::size_t i) {
        const std::size_t begin = i * (slots / 2);
        return std::span(triangles_.get() + begin, i == 0 ? slots / 2 : slots - begin);
    };
    each_half([&](std::size_t i) {
        for (const GrowingDelaunay::Triangle& t : half(i))
            start[i + 1] += t.is_ghost() ? 0U : 1U;
    });
    start[2] += start[1];
    mesh.triangles.resize(start[2]);
    each_half([&](std::size_t i) {
        auto out = mesh.triangles.begin() + static_cast<std::ptrdiff_t>(start[i]);
        for (const GrowingDelaunay::Triangle& t : half(i))
            if (!t.is_ghost())
                *out++ = {order_.points[t.vertices[0]], order_.points[t.vertices[1]],
                          order_.points[t.vertices[2]]};
    });
    return mesh;
}

}  // namespace

Result<MeshData> delaunay(std::span<const Point3> points, const DelaunayOptions& options) {
    return Triangulator(points, options).run();
}

}  // namespace tinsmith::core
