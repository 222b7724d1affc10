// SPDX-License-Identifier: Apache-2.0
#include "core/edit/volume.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "core/edit/box_tree.hpp"
#include "core/edit/cut_and_fill.hpp"
#include "core/edit/overlay.hpp"
#include "core/predicates/orientation.hpp"

namespace tinsmith::core {

namespace {

/// A mesh's triangle, with its elevations above a base that is near both surfaces.
struct Facet {
    Triangle2 plan;
    std::array<double, 3> z{};

    /// Elevation at a position in the triangle, relative to `origin`: a convex combination of the
    /// corners', so that needles amplify nothing.
    double elevation(Point2 p, Point2 origin) const {
        const auto at = [&](std::size_t i) {
            return Point2{plan[i].x - origin.x, plan[i].y - origin.y};
        };
        const Point2 a = at(0), b = at(1), c = at(2);
        const double wa = std::max(compensated_doubled_area(b, c, p), 0.0);
        const double wb = std::max(compensated_doubled_area(c, a, p), 0.0);
        const double wc = std::max(compensated_doubled_area(a, b, p), 0.0);
        return z[0] + (wb * (z[1] - z[0]) + wc * (z[2] - z[0])) / (wa + wb + wc);
    }
};

Triangle2 plan_of(const Tin& tin, TriangleId t) {
    const auto& v = tin.triangle(t).vertices;
    return {tin.plan(v[0]), tin.plan(v[1]), tin.plan(v[2])};
}

Facet facet_of(const Tin& tin, TriangleId t, double base) {
    const auto& v = tin.triangle(t).vertices;
    return {plan_of(tin, t),
            {tin.vertex(v[0]).z - base, tin.vertex(v[1]).z - base, tin.vertex(v[2]).z - base}};
}

Box box_of(const Triangle2& plan) {
    const auto [left, right] = std::minmax({plan[0].x, plan[1].x, plan[2].x});
    const auto [low, high] = std::minmax({plan[0].y, plan[1].y, plan[2].y});
    return {{left, low}, {right, high}};
}

double area_of(const Triangle2& plan) {
    return compensated_doubled_area(plan[0], plan[1], plan[2]) / 2.0;
}

Volume volume_of(const CutAndFill& sums, std::uint64_t pairs) {
    return {sums.cut(), sums.fill(), sums.area(), sums.cut_area(), sums.fill_area(), pairs};
}

void add_pair(const Facet& ours, const Facet& theirs, CutAndFill& sums) {
    if (ours.plan == theirs.plan) {
        return sums.add(area_of(ours.plan), {ours.z[0] - theirs.z[0], ours.z[1] - theirs.z[1],
                                             ours.z[2] - theirs.z[2]});
    }
    const ConvexPiece piece = common_part(ours.plan, theirs.plan);
    if (piece.size < 3) return;
    std::array<double, ConvexPiece::kMost> d{};
    for (std::size_t i = 0; i < piece.size; ++i) {
        const Point2 p = piece.corners[i];
        d[i] = ours.elevation(p, ours.plan[0]) - theirs.elevation(p, ours.plan[0]);
    }
    for (std::size_t i = 2; i < piece.size; ++i) {
        const double area = area_of({piece.corners[0], piece.corners[i - 1], piece.corners[i]});
        if (area > 0.0) sums.add(area, {d[0], d[i - 1], d[i]});
    }
}

}  // namespace

std::vector<TriangleId> all_triangles(const Tin& tin) {
    std::vector<TriangleId> all(tin.triangle_count());
    for (std::size_t i = 0; i < all.size(); ++i)
        all[i].value = static_cast<std::uint32_t>(i);
    return all;
}

Volume volume_against(const Tin& tin, std::span<const TriangleId> triangles, const Plane& plane) {
    CutAndFill sums;
    for (const TriangleId t : triangles) {
        std::array<double, 3> d{};
        for (std::size_t i = 0; i < 3; ++i) {
            const Point3 v = tin.vertex(tin.triangle(t).vertices[i]).point();
            d[i] = (v.z - plane.at.z) -
                   (plane.per_x * (v.x - plane.at.x) + plane.per_y * (v.y - plane.at.y));
        }
        sums.add(area_of(plan_of(tin, t)), d);
    }
    return volume_of(sums, triangles.size());
}

Result<Volume> volume_between(const Tin& tin, std::span<const TriangleId> triangles,
                              const Tin& other, const std::function<bool()>& cancelled,
                              const std::function<void(double)>& progress) {
    CutAndFill sums;
    if (triangles.empty()) return volume_of(sums, 0);
    std::uint64_t pairs = 0;
    Box reach = box_of(plan_of(tin, triangles.front()));
    for (const TriangleId t : triangles)
        reach.include(box_of(plan_of(tin, t)));
    std::vector<Box> boxes;
    std::vector<TriangleId> theirs;
    for (std::uint32_t t = 0; t < other.triangle_count(); ++t) {
        const Box box = box_of(plan_of(other, {t}));
        if (!box.meets(reach)) continue;
        boxes.push_back(box);
        theirs.push_back({t});
    }
    const BoxTree tree(std::move(boxes));
    std::vector<std::uint32_t> found;
    constexpr std::size_t kBetweenQuestions = 256;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        if (i % kBetweenQuestions == 0 && cancelled && cancelled())
            return Error{ErrorCode::Cancelled, "the comparison was stopped", {}};
        if (i % kBetweenQuestions == 0 && progress)
            progress(static_cast<double>(i) / static_cast<double>(triangles.size()));
        const Triangle2 plan = plan_of(tin, triangles[i]);
        const double base = tin.vertex(tin.triangle(triangles[i]).vertices[0]).z;
        const Facet ours = facet_of(tin, triangles[i], base);
        tree.near(box_of(plan), found);
        for (const std::uint32_t k : found) {
            if (!overlap(plan, plan_of(other, theirs[k]))) continue;
            ++pairs;
            add_pair(ours, facet_of(other, theirs[k], base), sums);
        }
    }
    return volume_of(sums, pairs);
}

}  // namespace tinsmith::core
