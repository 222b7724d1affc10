// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/insertion_order.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "core/mesh/hilbert_order.hpp"

namespace tinsmith::core {

namespace {

PlanAxis longer_axis(std::span<const Point3> points) {
    Point2 least = points[0].plan(), most = least;
    for (const Point3& p : points) {
        least = {std::min(least.x, p.x), std::min(least.y, p.y)};
        most = {std::max(most.x, p.x), std::max(most.y, p.y)};
    }
    return most.x - least.x >= most.y - least.y ? PlanAxis::East : PlanAxis::North;
}

double median_along(std::span<const Point3> points, PlanAxis axis) {
    const std::size_t count = std::min<std::size_t>(1001, points.size());
    std::vector<double> sample;
    sample.reserve(count);
    for (std::size_t k = 0; k < count; ++k)
        sample.push_back(along(axis, points[k * points.size() / count].plan()));
    const auto median = sample.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(sample.begin(), median, sample.end());
    return *median;
}

/// All indices, those of the nearer half first, each half by index. Where the second begins.
std::size_t part(std::span<const Point3> points, PlanAxis axis,
                 std::vector<std::uint32_t>& indices) {
    const double median = median_along(points, axis);
    // Each index goes to the end of either half, and stays at one: nobody can foresee at which.
    std::vector<std::uint32_t> farther(points.size());
    std::size_t near = 0, far = 0;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        const bool is_near = along(axis, points[i].plan()) < median;
        indices[near] = i;
        farther[far] = i;
        near += is_near ? 1U : 0U;
        far += is_near ? 0U : 1U;
    }
    std::copy_n(farther.begin(), far, indices.begin() + static_cast<std::ptrdiff_t>(near));
    return near;
}

/// Sorts the indices along the curve. Points of one position stand side by side, by index: of these
/// all but the first are moved to `repeated`. How many indices stay, in front.
std::size_t sort(std::span<const Point3> points, std::span<std::uint32_t> indices,
                 std::vector<Repeated>& repeated) {
    std::size_t kept = 0;
    for (const std::uint32_t i : hilbert_order(points, indices)) {
        if (kept > 0 && points[indices[kept - 1]].plan() == points[i].plan())
            repeated.push_back({i, indices[kept - 1]});
        else
            indices[kept++] = i;
    }
    return kept;
}

}  // namespace

InsertionOrder insertion_order(std::span<const Point3> points, bool in_parts,
                               const Executor& executor) {
    InsertionOrder order;
    order.points.resize(points.size());
    if (in_parts) {
        order.axis = longer_axis(points);
        order.middle = part(points, order.axis, order.points);
    } else {
        std::iota(order.points.begin(), order.points.end(), 0U);
    }
    const std::span<std::uint32_t> all(order.points);
    const std::array halves{all.first(order.middle), all.subspan(order.middle)};
    std::array<std::size_t, 2> kept{};
    std::array<std::vector<Repeated>, 2> repeated;
    const auto sort_half = [&](std::size_t i) { kept[i] = sort(points, halves[i], repeated[i]); };
    const std::array<Job, 2> jobs{[&] { sort_half(0); }, [&] { sort_half(1); }};
    executor(jobs);
    std::copy_n(halves[1].begin(), kept[1], all.begin() + static_cast<std::ptrdiff_t>(kept[0]));
    order.middle = kept[0];
    order.points.resize(kept[0] + kept[1]);
    order.repeated = std::move(repeated[0]);
    order.repeated.insert(order.repeated.end(), repeated[1].begin(), repeated[1].end());
    std::sort(order.repeated.begin(), order.repeated.end(),
              [](const Repeated& l, const Repeated& r) { return l.later < r.later; });
    return order;
}

void draw_lots(std::span<std::uint32_t> order) {
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
    for (const std::uint32_t i : order)
        ++start[round_of(i) + 1];
    for (unsigned round = 0; round < kRounds; ++round)
        start[round + 1] += start[round];
    std::vector<std::uint32_t> by_round(order.size());
    for (const std::uint32_t i : order)
        by_round[start[round_of(i)]++] = i;
    std::copy(by_round.begin(), by_round.end(), order.begin());
}

}  // namespace tinsmith::core
