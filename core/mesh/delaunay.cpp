// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/delaunay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/mesh/growing_delaunay.hpp"
#include "core/mesh/hilbert_order.hpp"
#include "core/predicates/orientation.hpp"
#include "core/types/ids.hpp"
#include "core/types/range.hpp"

namespace tinsmith::core {

namespace {

/// 2 n triangles, ghosts among them, are numbered as sides are.
constexpr std::size_t kMostPoints = kMaxTriangles / 2;
constexpr std::size_t kTellEvery = 16384;

class Triangulator {
  public:
    Triangulator(std::span<const Point3> points, const std::function<bool(double)>& progress)
        : points_(points), progress_(progress) {}

    Result<MeshData> run() {
        check_coordinates();
        if (!errors_.empty()) return std::move(errors_);
        if (!tell(0.0)) return cancelled();
        order_ = hilbert_order(points_);
        leave_out_repeated();
        if (!errors_.empty()) return std::move(errors_);
        if (!tell(0.1)) return cancelled();
        draw_lots();
        if (!begin_with_a_triangle()) return std::move(errors_);
        return triangulate();
    }

  private:
    bool tell(double share) const { return !progress_ || progress_(share); }
    static Error cancelled() { return {ErrorCode::Cancelled, "the caller stopped the work", {}}; }

    void fault(ErrorCode code, std::size_t point, const std::string& what) {
        ErrorPlace place;
        place.vertex = point;
        const Point3& p = points_[point];
        if (std::isfinite(p.x) && std::isfinite(p.y)) place.position = p.plan();
        errors_.push_back({code, "point " + std::to_string(point) + " " + what, place});
    }

    void check_coordinates();
    void leave_out_repeated();
    void draw_lots();
    bool begin_with_a_triangle();
    Result<MeshData> triangulate();
    MeshData result(const GrowingDelaunay& made);

    std::span<const Point3> points_;
    const std::function<bool(double)>& progress_;
    std::vector<std::uint32_t> order_;  ///< of insertion: indices of points
    std::vector<bool> left_out_;        ///< by point; empty: none is
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

/// Points of one position stand side by side, the first of them by index first.
void Triangulator::leave_out_repeated() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> differ;  // later point, first point
    std::size_t kept = 0;
    for (const std::uint32_t i : order_) {
        if (kept == 0 || points_[order_[kept - 1]].plan() != points_[i].plan()) {
            order_[kept++] = i;
            continue;
        }
        const std::uint32_t first = order_[kept - 1];
        if (points_[first].z != points_[i].z) differ.emplace_back(i, first);
        if (left_out_.empty()) left_out_.assign(points_.size(), false);
        left_out_[i] = true;
    }
    order_.resize(kept);
    std::sort(differ.begin(), differ.end());
    if (differ.size() > kMaxFaults) differ.resize(kMaxFaults);
    for (const auto& [later, first] : differ) {
        fault(ErrorCode::ElevationTwice, later,
              "is at the position of point " + std::to_string(first) +
                  " with another elevation; keep one of them");
        errors_.back().place.earlier = first;
    }
}

/// Rounds of growing numbers of points, each spread over all of the plan and in the curve's order:
/// then no order of the input makes insertions dear (Amenta, Choi, Rote 2003). Lots are drawn by
/// the points' indices.
void Triangulator::draw_lots() {
    constexpr unsigned kRounds = 8;
    const auto round_of = [](std::uint32_t i) {
        const std::uint64_t lot = (std::uint64_t{i} + 1) * 0x9e3779b97f4a7c15ULL;
        const std::uint64_t mixed = (lot ^ lot >> 29) * 0xbf58476d1ce4e5b9ULL >> 32;
        unsigned round = kRounds - 1;
        for (std::uint64_t bits = mixed; round > 0 && (bits & 15U) == 0; bits >>= 4)
            --round;
        return round;
    };
    std::array<std::size_t, kRounds + 1> start{};
    for (const std::uint32_t i : order_)
        ++start[round_of(i) + 1];
    for (unsigned round = 0; round < kRounds; ++round)
        start[round + 1] += start[round];
    std::vector<std::uint32_t> by_round(order_.size());
    for (const std::uint32_t i : order_)
        by_round[start[round_of(i)]++] = i;
    order_ = std::move(by_round);
}

/// Brings a point off the line of the first two to the third place.
bool Triangulator::begin_with_a_triangle() {
    const auto plan = [this](std::size_t k) { return points_[order_[k]].plan(); };
    if (order_.size() < 3) {
        errors_.push_back({ErrorCode::TooFewPoints,
                           "there are " + std::to_string(order_.size()) +
                               " distinct positions; a triangle needs three",
                           {}});
        return false;
    }
    std::size_t third = 2;
    while (third < order_.size() &&
           orientation(plan(0), plan(1), plan(third)) == Orientation::Collinear)
        ++third;
    if (third == order_.size()) {
        errors_.push_back({ErrorCode::PointsCollinear,
                           "all points are on one line in plan; no triangle has an area",
                           {}});
        return false;
    }
    std::rotate(order_.begin() + 2, order_.begin() + static_cast<std::ptrdiff_t>(third),
                order_.begin() + static_cast<std::ptrdiff_t>(third) + 1);
    return true;
}

Result<MeshData> Triangulator::triangulate() {
    // Side by side in the order in which they come: neighbours share cache lines.
    std::vector<Point2> plan(order_.size());
    for (std::size_t k = 0; k < plan.size(); ++k)
        plan[k] = points_[order_[k]].plan();
    GrowingDelaunay made(plan);
    for (std::size_t k = 3; k < plan.size(); ++k) {
        made.insert(static_cast<std::uint32_t>(k));
        if (k % kTellEvery == 0 &&
            !tell(0.1 + 0.8 * static_cast<double>(k) / static_cast<double>(plan.size())))
            return cancelled();
    }
    if (!tell(0.9)) return cancelled();
    return result(made);
}

MeshData Triangulator::result(const GrowingDelaunay& made) {
    MeshData mesh;
    mesh.vertices.reserve(order_.size());
    if (left_out_.empty()) {
        mesh.vertices.assign(points_.begin(), points_.end());
    } else {
        std::vector<std::uint32_t> slot(points_.size());
        for (std::size_t i = 0; i < points_.size(); ++i) {
            slot[i] = static_cast<std::uint32_t>(mesh.vertices.size());
            if (!left_out_[i]) mesh.vertices.push_back(points_[i]);
        }
        for (std::uint32_t& i : order_)
            i = slot[i];
    }
    std::size_t ghosts = 0;
    for (const GrowingDelaunay::Triangle& t : made.triangles())
        ghosts += t.is_ghost() ? 1U : 0U;
    mesh.triangles.reserve(made.triangles().size() - ghosts);
    for (const GrowingDelaunay::Triangle& t : made.triangles())
        if (!t.is_ghost())
            mesh.triangles.push_back(
                {order_[t.vertices[0]], order_[t.vertices[1]], order_[t.vertices[2]]});
    return mesh;
}

}  // namespace

Result<MeshData> delaunay(std::span<const Point3> points,
                          const std::function<bool(double)>& progress) {
    return Triangulator(points, progress).run();
}

}  // namespace tinsmith::core
