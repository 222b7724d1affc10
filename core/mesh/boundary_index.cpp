// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/boundary_index.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "core/types/ulp.hpp"

namespace tinsmith::core {

namespace {

/// A part with more entries is halved, where that helps.
constexpr std::size_t kCrowded = 16;
/// How often an edge may be filed on average, for parts that halving does not part cleanly.
constexpr std::size_t kMostFiled = 8;
/// So few cells that even a long segment over an empty box passes few.
constexpr double kMostColumns = 64.0;

/// Of so many rows, or columns, between low and high: the first and the last that have anything of
/// what is given, one more on either side for rounding.
std::pair<std::size_t, std::size_t> cells_of(std::size_t count, double low, double high,
                                             double from, double to) {
    const double last = static_cast<double>(count - 1);
    const double per_unit = high > low ? static_cast<double>(count) / (high - low) : 0.0;
    const auto cell = [&](double at) {
        return static_cast<std::size_t>(std::clamp((at - low) * per_unit, 0.0, last));
    };
    const std::size_t first = cell(from);
    return {first > 0 ? first - 1 : 0, std::min(cell(to) + 1, count - 1)};
}

}  // namespace

BoundaryIndex::BoundaryIndex(Point2 min, Point2 max, std::size_t edges)
    : box_{min.x, min.y, max.x, max.y} {
    const double largest =
        std::max({std::fabs(min.x), std::fabs(min.y), std::fabs(max.x), std::fabs(max.y)});
    rounding_ = 32.0 * ulp(largest);
    entries_.reserve(edges);
    changes_.reserve(edges);
    // Cells about as wide as they are high: an edge is filed in few.
    const double width = max.x - min.x, height = max.y - min.y;
    const double longer = std::max({width, height, rounding_});
    const double most = std::clamp(std::sqrt(static_cast<double>(edges) / 4.0), 1.0, kMostColumns);
    columns_ = static_cast<std::size_t>(std::max(1.0, width / longer * most));
    rows_ = static_cast<std::size_t>(std::max(1.0, height / longer * most));
    nodes_.resize(columns_ * rows_);
}

BoundaryIndex::Box BoundaryIndex::half_of(const Box& box, bool by_y, bool upper) {
    Box half = box;
    if (by_y)
        (upper ? half.low : half.high) = box.low + (box.high - box.low) / 2.0;
    else
        (upper ? half.left : half.right) = box.left + (box.right - box.left) / 2.0;
    return half;
}

/// Whether the segment comes within the margin, and what rounding may add, of the box. Never false
/// where it does: halves meet in an edge, so that two segments that meet share a part.
bool BoundaryIndex::touches(const Box& box, Point2 p, Point2 q, double margin) const {
    const double reach = margin + rounding_;
    if (std::max(p.x, q.x) < box.left - reach || std::min(p.x, q.x) > box.right + reach ||
        std::max(p.y, q.y) < box.low - reach || std::min(p.y, q.y) > box.high + reach)
        return false;
    // Apart where all corners are on one side of the line through the segment.
    const double dx = q.x - p.x, dy = q.y - p.y;
    const double half_x = (box.right - box.left) / 2.0, half_y = (box.high - box.low) / 2.0;
    const double one = dx * (box.low + half_y - p.y), other = dy * (box.left + half_x - p.x);
    constexpr double kError = 0x1p-49;  // of the products and the differences in them
    return std::fabs(one - other) <= std::fabs(dx) * (half_y + reach) +
                                         std::fabs(dy) * (half_x + reach) +
                                         kError * (std::fabs(one) + std::fabs(other));
}

/// Calls `visit` with each cell of the grid that the segment touches.
template <typename Visit>
void BoundaryIndex::for_each_cell(Point2 p, Point2 q, double margin, Visit visit) const {
    if (nodes_.empty()) return;
    const double reach = margin + rounding_;
    const double width = box_.right - box_.left, height = box_.high - box_.low;
    const double columns = static_cast<double>(columns_), rows = static_cast<double>(rows_);
    if (p.y > q.y) std::swap(p, q);
    const double run = q.y > p.y ? (q.x - p.x) / (q.y - p.y) : 0.0;
    // From very far away it does not tell where in the row the segment is.
    const bool is_told = std::fabs(p.x - box_.left) + std::fabs(p.y - box_.low) +
                             std::fabs(q.x - p.x) + std::fabs(q.y - p.y) <
                         0x1p20 * (width + height);
    const auto [first, last] = cells_of(rows_, box_.low, box_.high, p.y - reach, q.y + reach);
    for (std::size_t r = first; r <= last; ++r) {
        Box cell{box_.left, box_.low + height * (static_cast<double>(r) / rows), box_.right,
                 box_.low + height * (static_cast<double>(r + 1) / rows)};
        double x0 = p.x, x1 = q.x;
        if (is_told && q.y > p.y) {
            x0 = p.x + (std::clamp(cell.low - reach, p.y, q.y) - p.y) * run;
            x1 = p.x + (std::clamp(cell.high + reach, p.y, q.y) - p.y) * run;
        }
        const auto [left, right] = cells_of(columns_, box_.left, box_.right,
                                            std::min(x0, x1) - reach, std::max(x0, x1) + reach);
        for (std::size_t c = left; c <= right; ++c) {
            cell.left = box_.left + width * (static_cast<double>(c) / columns);
            cell.right = box_.left + width * (static_cast<double>(c + 1) / columns);
            if (touches(cell, p, q, margin))
                visit(Part{static_cast<std::uint32_t>(r * columns_ + c), cell});
        }
    }
}

/// Calls `visit` with each part that is not halved and that the segment touches. What lies outside
/// the whole box by more than rounding touches none.
template <typename Visit>
void BoundaryIndex::for_each_part(Point2 p, Point2 q, double margin, Visit visit) const {
    for_each_cell(p, q, margin, [&](const Part& cell) {
        if (nodes_[cell.node].halves == 0)
            visit(cell);
        else
            for_each_part_of(cell, p, q, margin, visit);
    });
}

template <typename Visit>
void BoundaryIndex::for_each_part_of(const Part& cell, Point2 p, Point2 q, double margin,
                                     Visit& visit) const {
    // One waits for each halving above: at most 47 of either kind until a side is all rounding.
    // As many as are waiting are written.
    std::array<Part, 128> waiting;  // NOLINT(cppcoreguidelines-pro-type-member-init)
    waiting[0] = cell;
    for (std::size_t count = 1; count > 0;) {
        const Part part = waiting[--count];
        const std::uint32_t halves = nodes_[part.node].halves;
        if (halves == 0) {
            visit(part);
            continue;
        }
        for (const bool upper : {true, false}) {
            const Box half = half_of(part.box, nodes_[part.node].by_y, upper);
            if (touches(half, p, q, margin)) waiting[count++] = {halves + (upper ? 1U : 0U), half};
        }
    }
}

void BoundaryIndex::append(const Entry& entry) {
    const auto id = static_cast<std::uint32_t>(entries_.size());
    entries_.push_back(entry);
    std::vector<Part> parts;
    for_each_part(entry.p, entry.q, 0.0, [&](const Part& part) {
        nodes_[part.node].entries.push_back(id);
        ++filed_;
        parts.push_back(part);
    });
    // Where halving did not help, it is tried again once there are twice as many.
    for (const Part& part : parts)
        if (std::has_single_bit(nodes_[part.node].entries.size())) halve_where_crowded(part);
}

/// Ends: a half is no larger than its whole, and no smaller than rounding.
void BoundaryIndex::halve_where_crowded(Part part) {
    std::vector<Part> waiting{part};
    while (!waiting.empty()) {
        part = waiting.back();
        waiting.pop_back();
        if (nodes_[part.node].entries.size() < kCrowded || !halve(part)) continue;
        const Node& node = nodes_[part.node];
        for (const bool upper : {true, false})
            waiting.push_back(
                {node.halves + (upper ? 1U : 0U), half_of(part.box, node.by_y, upper)});
    }
}

/// Halves the part across x or y, whichever files fewer edges twice. False, and nothing done, where
/// neither parts them.
bool BoundaryIndex::halve(const Part& part) {
    const double width = part.box.right - part.box.left;
    const double height = part.box.high - part.box.low;
    const std::size_t count = nodes_[part.node].entries.size();
    std::size_t fewest = 2 * count;
    bool best_by_y = false;
    for (const bool by_y : {height > width, height <= width}) {
        if ((by_y ? height : width) <= 8.0 * rounding_) continue;
        std::array<std::size_t, 2> in_half{};
        for (const bool upper : {false, true}) {
            const Box half = half_of(part.box, by_y, upper);
            for (const std::uint32_t e : nodes_[part.node].entries)
                if (touches(half, entries_[e].p, entries_[e].q, 0.0)) ++in_half[upper ? 1 : 0];
        }
        // Clean: few are in both. Otherwise it must help, and there must be room.
        const std::size_t sum = in_half[0] + in_half[1];
        const bool is_clean = sum <= count + count / 4;
        const bool helps = std::max(in_half[0], in_half[1]) <= count - count / 4 &&
                           filed_ + sum - count <= kMostFiled * entries_.size();
        if (sum >= fewest || !(is_clean || helps)) continue;
        fewest = sum;
        best_by_y = by_y;
    }
    if (fewest == 2 * count) return false;
    std::array<std::vector<std::uint32_t>, 2> parted;
    for (const bool upper : {false, true}) {
        const Box half = half_of(part.box, best_by_y, upper);
        for (const std::uint32_t e : nodes_[part.node].entries)
            if (touches(half, entries_[e].p, entries_[e].q, 0.0))
                parted[upper ? 1 : 0].push_back(e);
    }
    // What may fail, for lack of memory, comes before what is changed.
    const auto halves = static_cast<std::uint32_t>(nodes_.size());
    if (halved_.size() == halved_.capacity()) halved_.reserve(2 * halved_.size() + 16);
    nodes_.resize(nodes_.size() + 2);
    halved_.push_back(part.node);
    nodes_[part.node].halves = halves;
    nodes_[part.node].by_y = best_by_y;
    nodes_[halves].entries.swap(parted[0]);
    nodes_[halves + 1].entries.swap(parted[1]);
    filed_ += fewest - count;
    return true;
}

/// The node has its entries still.
void BoundaryIndex::take_back_halving() {
    Node& node = nodes_[halved_.back()];
    filed_ = filed_ + node.entries.size() - nodes_[node.halves].entries.size() -
             nodes_[node.halves + 1].entries.size();
    node.halves = 0;
    node.by_y = false;
    nodes_.resize(nodes_.size() - 2);
    halved_.pop_back();
}

void BoundaryIndex::add(VertexId v, Point2 p, Point2 q) {
    changes_.push_back({entries_.size(), halved_.size(), UINT32_MAX, {}});
    append({v, p, q});
}

/// The newest entry under v of an edge through p; all ones where there is none.
std::uint32_t BoundaryIndex::find(VertexId v, Point2 p) const {
    std::uint32_t newest = UINT32_MAX;
    for_each_part(p, p, 0.0, [&](const Part& part) {
        const auto& entries = nodes_[part.node].entries;
        const auto found = std::find_if(entries.rbegin(), entries.rend(),
                                        [&](std::uint32_t e) { return entries_[e].vertex == v; });
        if (found != entries.rend() && (newest == UINT32_MAX || *found > newest)) newest = *found;
    });
    return newest;
}

void BoundaryIndex::add_split(VertexId v, Point2 a, VertexId w, Point2 p, Point2 b) {
    const auto length = [](Point2 from, Point2 to) {
        return std::max(std::fabs(to.x - from.x), std::fabs(to.y - from.y));
    };
    const std::uint32_t known = find(v, p);
    if (known == UINT32_MAX) {  // rounding put p outside the parts of a-b
        add(v, a, p);
        add(w, p, b);
        return;
    }
    if (length(p, b) <= length(a, p)) {
        add(w, p, b);
        return;
    }
    changes_.push_back({entries_.size(), halved_.size(), known, v});
    entries_[known].vertex = w;
    append({v, a, p});
}

void BoundaryIndex::take_back(std::size_t count) {
    while (changes_.size() > count) {
        const Change change = changes_.back();
        changes_.pop_back();
        while (halved_.size() > change.halvings)
            take_back_halving();
        if (change.renamed != UINT32_MAX) entries_[change.renamed].vertex = change.before;
        if (entries_.size() == change.entries) continue;  // memory ran out before it was made
        const auto newest = static_cast<std::uint32_t>(change.entries);
        for_each_part(entries_[newest].p, entries_[newest].q, 0.0, [&](const Part& part) {
            std::vector<std::uint32_t>& entries = nodes_[part.node].entries;
            if (entries.empty() || entries.back() != newest) return;
            entries.pop_back();
            --filed_;
        });
        entries_.pop_back();
    }
}

std::size_t BoundaryIndex::memory_bytes() const {
    return entries_.size() * sizeof(Entry) + changes_.size() * sizeof(Change) +
           nodes_.size() * sizeof(Node) + halved_.size() * sizeof(std::uint32_t) +
           filed_ * sizeof(std::uint32_t);
}

std::vector<VertexId> BoundaryIndex::near(Point2 p, Point2 q, double margin) const {
    std::vector<VertexId> found;
    const double reach = margin + rounding_;
    const Box box{std::min(p.x, q.x) - reach, std::min(p.y, q.y) - reach,
                  std::max(p.x, q.x) + reach, std::max(p.y, q.y) + reach};
    for_each_part(p, q, margin, [&](const Part& part) {
        for (const std::uint32_t e : nodes_[part.node].entries) {
            const Entry& entry = entries_[e];
            if (std::max(entry.p.x, entry.q.x) >= box.left &&
                std::min(entry.p.x, entry.q.x) <= box.right &&
                std::max(entry.p.y, entry.q.y) >= box.low &&
                std::min(entry.p.y, entry.q.y) <= box.high)
                found.push_back(entry.vertex);
        }
    });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

}  // namespace tinsmith::core
