// SPDX-License-Identifier: Apache-2.0
#include "core/mesh/repair.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "core/predicates/orientation.hpp"
#include "core/types/ids.hpp"
#include "core/types/range.hpp"

namespace tinsmith::core {

namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Cell = std::array<std::int64_t, 3>;

constexpr std::uint32_t kNone = UINT32_MAX;

std::uint64_t edge_between(std::uint32_t a, std::uint32_t b) {
    const auto [low, high] = std::minmax(a, b);
    return std::uint64_t{low} << 32 | high;
}

struct CellHash {
    /// Where something lies in memory, which nobody knows who sends a mesh: cells chosen so that
    /// they fall together do so for one key only.
    std::uint64_t key;

    std::size_t operator()(const Cell& cell) const {
        std::uint64_t hash = key;
        for (const std::int64_t n : cell) {
            hash = (hash ^ static_cast<std::uint64_t>(n)) * 0x9e3779b97f4a7c15ULL;
            hash ^= hash >> 29;
        }
        return static_cast<std::size_t>(hash);
    }
};

/// Kept vertices by cells of four tolerances, so that most vertices look into one cell only, and a
/// cell holds few. It is looked up and never gone through: no order depends on the hash.
class Welder {
  public:
    Welder(const std::vector<Point3>& vertices, double weld)
        : vertices_(vertices), next_(vertices.size(), kNone), low_(vertices.front()) {
        Point3 high = low_;
        for (const Point3& p : vertices) {
            low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
        const double extent = std::max({high.x - low_.x, high.y - low_.y, high.z - low_.z});
        if (weld > extent * 0x1p-50) weld_ = weld;
        first_.reserve(vertices.size());
    }

    /// The vertex that this one becomes: itself, or one that was asked about before.
    std::uint32_t welded(std::uint32_t v) {
        if (weld_ == 0.0) {
            const auto [place, is_new] = first_.try_emplace(bits_of(vertices_[v]), v);
            return place->second;
        }
        const std::uint32_t found = nearest(v);
        if (found != kNone) return found;
        const auto [place, is_new] = first_.try_emplace(cell_of(vertices_[v], 0.0), v);
        if (!is_new) next_[v] = std::exchange(place->second, v);
        return v;
    }

  private:
    static Cell bits_of(const Point3& p) {
        const auto bits = [](double value) {
            return std::bit_cast<std::int64_t>(value + 0.0);  // both noughts are one
        };
        return {bits(p.x), bits(p.y), bits(p.z)};
    }
    Cell cell_of(const Point3& p, double aside) const {
        const auto along = [this, aside](double value, double low) {
            return static_cast<std::int64_t>(std::floor((value - low + aside) / (4.0 * weld_)));
        };
        return {along(p.x, low_.x), along(p.y, low_.y), along(p.z, low_.z)};
    }
    std::uint32_t nearest(std::uint32_t v) const {
        const Point3& p = vertices_[v];
        // A little more than the tolerance: which cells are looked into is not exact.
        const Cell low = cell_of(p, -1.01 * weld_), high = cell_of(p, 1.01 * weld_);
        std::uint32_t best = kNone;
        double least = HUGE_VAL;
        for (std::int64_t i = low[0]; i <= high[0]; ++i)
            for (std::int64_t j = low[1]; j <= high[1]; ++j)
                for (std::int64_t k = low[2]; k <= high[2]; ++k) {
                    const auto found = first_.find({i, j, k});
                    if (found == first_.end()) continue;
                    for (std::uint32_t w = found->second; w != kNone; w = next_[w]) {
                        const double dx = vertices_[w].x - p.x, dy = vertices_[w].y - p.y;
                        const double dz = vertices_[w].z - p.z;
                        const double plan = dx * dx + dy * dy;
                        if (plan > weld_ * weld_ || std::fabs(dz) > weld_) continue;
                        const double distance = plan + dz * dz;
                        if (distance > least || (distance == least && w > best)) continue;
                        least = distance;
                        best = w;
                    }
                }
        return best;
    }

    const std::vector<Point3>& vertices_;
    std::unordered_map<Cell, std::uint32_t, CellHash> first_{
        64, CellHash{reinterpret_cast<std::uintptr_t>(vertices_.data())}};
    std::vector<std::uint32_t> next_;  ///< in the same cell
    Point3 low_;
    double weld_ = 0.0;
};

class Mender {
  public:
    explicit Mender(MeshData& data) : data_(data) {}

    Repaired mend(double weld) {
        number(result_.vertices, data_.vertices.size());
        number(result_.triangles, data_.triangles.size());
        if (!is_mendable()) return std::move(result_);
        weld_vertices(weld);
        mend_triangles();
        drop_repeated();
        drop_gone_constraints();
        drop_unused();
        return std::move(result_);
    }

  private:
    static void number(std::vector<std::uint32_t>& names, std::size_t count) {
        names.resize(count);
        std::iota(names.begin(), names.end(), std::uint32_t{0});
    }
    static void note(Repair& repair, std::size_t index) {
        if (repair.count++ < Repair::kFirst) repair.indices.push_back(index);
    }
    void keep(Repair repair) {
        if (repair.count > 0) result_.repairs.push_back(std::move(repair));
    }

    bool is_mendable() const {
        const std::size_t count = data_.vertices.size();
        if (data_.triangles.empty() || data_.triangles.size() > kMaxTriangles ||
            count > kMaxVertices)
            return false;
        const auto is_bad = [](double value) {
            return !std::isfinite(value) || !in_coordinate_range(value);
        };
        for (const Point3& p : data_.vertices)
            if (is_bad(p.x) || is_bad(p.y) || is_bad(p.z)) return false;
        for (const Triangle& t : data_.triangles)
            if (std::max({t[0], t[1], t[2]}) >= count) return false;
        for (const auto& [from, to] : data_.constraints)
            if (std::max(from, to) >= count) return false;
        return true;
    }

    void weld_vertices(double weld) {
        Welder welder(data_.vertices, weld);
        Repair repair{RepairKind::VerticesWelded, 0, {}};
        std::vector<std::uint32_t> now(data_.vertices.size());
        for (std::uint32_t v = 0; v < now.size(); ++v) {
            now[v] = welder.welded(v);
            if (now[v] != v) note(repair, v);
        }
        is_welded_.assign(now.size(), false);
        for (std::uint32_t v = 0; v < now.size(); ++v)
            is_welded_[v] = now[v] != v;
        if (repair.count > 0) rename(now);
        keep(std::move(repair));
    }

    void rename(const std::vector<std::uint32_t>& now) {
        for (Triangle& triangle : data_.triangles)
            for (std::uint32_t& v : triangle)
                v = now[v];
        for (auto& constraint : data_.constraints)
            for (std::uint32_t& v : constraint)
                v = now[v];
        std::erase_if(data_.constraints, [](const auto& c) { return c[0] == c[1]; });
    }

    /// Leaves flat ones out and turns clockwise ones.
    void mend_triangles() {
        Repair flat{RepairKind::TrianglesFlat, 0, {}}, turned{RepairKind::TrianglesTurned, 0, {}};
        std::size_t kept = 0;
        for (std::uint32_t t = 0; t < data_.triangles.size(); ++t) {
            Triangle triangle = data_.triangles[t];
            const auto plan = [&](unsigned i) { return data_.vertices[triangle[i]].plan(); };
            const Orientation way = orientation(plan(0), plan(1), plan(2));
            if (way == Orientation::Collinear) {
                note(flat, t);
                for (unsigned i = 0; i < 3; ++i)
                    gone_.push_back(edge_between(triangle[i], triangle[(i + 1) % 3]));
                continue;
            }
            if (way == Orientation::Clockwise) {
                note(turned, t);
                std::swap(triangle[1], triangle[2]);
            }
            result_.triangles[kept] = t;
            data_.triangles[kept++] = triangle;
        }
        cut_triangles(kept);
        keep(std::move(flat));
        keep(std::move(turned));
    }

    void cut_triangles(std::size_t count) {
        data_.triangles.resize(count);
        result_.triangles.resize(count);
    }

    void drop_repeated() {
        std::vector<std::array<std::uint32_t, 4>> sorted(data_.triangles.size());
        for (std::uint32_t t = 0; t < sorted.size(); ++t) {
            Triangle corners = data_.triangles[t];
            std::sort(corners.begin(), corners.end());
            sorted[t] = {corners[0], corners[1], corners[2], t};
        }
        std::sort(sorted.begin(), sorted.end());
        std::vector<bool> again(sorted.size(), false);
        for (std::size_t i = 1; i < sorted.size(); ++i)
            if (std::equal(sorted[i].begin(), sorted[i].begin() + 3, sorted[i - 1].begin()))
                again[sorted[i][3]] = true;
        Repair repair{RepairKind::TrianglesRepeated, 0, {}};
        std::size_t kept = 0;
        for (std::uint32_t t = 0; t < again.size(); ++t) {
            if (again[t]) {
                note(repair, result_.triangles[t]);
                continue;
            }
            result_.triangles[kept] = result_.triangles[t];
            data_.triangles[kept++] = data_.triangles[t];
        }
        cut_triangles(kept);
        keep(std::move(repair));
    }

    /// A constraint along edges of flat triangles alone has no edge any more.
    void drop_gone_constraints() {
        if (gone_.empty() || data_.constraints.empty()) return;
        std::sort(gone_.begin(), gone_.end());
        std::vector<bool> stays(gone_.size(), false);
        const auto place = [this](std::uint32_t a, std::uint32_t b) {
            const std::uint64_t key = edge_between(a, b);
            const auto found = std::lower_bound(gone_.begin(), gone_.end(), key);
            const bool is_there = found != gone_.end() && *found == key;
            return is_there ? static_cast<std::size_t>(found - gone_.begin()) : gone_.size();
        };
        for (const Triangle& t : data_.triangles)
            for (unsigned i = 0; i < 3; ++i)
                if (const std::size_t at = place(t[i], t[(i + 1) % 3]); at < gone_.size())
                    stays[at] = true;
        std::erase_if(data_.constraints, [&](const auto& c) {
            const std::size_t at = place(c[0], c[1]);
            return at < gone_.size() && !stays[at];
        });
    }

    /// Vertices that became others are gone as well, and were told of before.
    void drop_unused() {
        std::vector<bool> used(data_.vertices.size(), false);
        for (const Triangle& triangle : data_.triangles)
            for (const std::uint32_t v : triangle)
                used[v] = true;
        Repair repair{RepairKind::VerticesUnused, 0, {}};
        std::vector<std::uint32_t> now(data_.vertices.size(), 0);
        std::uint32_t kept = 0;
        for (std::uint32_t v = 0; v < now.size(); ++v) {
            if (!used[v]) {
                if (!is_welded_[v]) note(repair, v);
                continue;
            }
            now[v] = kept;
            result_.vertices[kept] = v;
            data_.vertices[kept++] = data_.vertices[v];
        }
        // A constraint on what is gone is no edge of the mesh any more.
        std::erase_if(data_.constraints, [&](const auto& c) { return !used[c[0]] || !used[c[1]]; });
        if (kept < now.size()) rename(now);
        data_.vertices.resize(kept);
        result_.vertices.resize(kept);
        keep(std::move(repair));
    }

    MeshData& data_;
    Repaired result_;
    std::vector<bool> is_welded_;
    std::vector<std::uint64_t>
        gone_;  ///< the edges of flat triangles; other triangles may have them
};

}  // namespace

std::string_view repair_name(RepairKind kind) {
    switch (kind) {
        case RepairKind::VerticesWelded:
            return "VERTICES_WELDED";
        case RepairKind::TrianglesFlat:
            return "TRIANGLES_FLAT";
        case RepairKind::TrianglesTurned:
            return "TRIANGLES_TURNED";
        case RepairKind::TrianglesRepeated:
            return "TRIANGLES_REPEATED";
        case RepairKind::VerticesUnused:
            return "VERTICES_UNUSED";
    }
    return "UNKNOWN";
}

Repaired repair_mesh(MeshData& data, double weld) {
    return Mender(data).mend(weld);
}

}  // namespace tinsmith::core
