// SPDX-License-Identifier: Apache-2.0
// How triangles leave a mesh: see `Surgery::remove`.
#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>

#include "core/mesh/components.hpp"
#include "core/mesh/surgery.hpp"
#include "core/mesh/walk.hpp"

namespace tinsmith::core {

/// One removal. Triangles and vertices change as it goes, and are in the record; all else is made
/// aside and takes its place at the end, where nothing can fail any more.
class Removal {
  public:
    Removal(Surgery& surgery, std::span<const TriangleId> gone)
        : surgery_(surgery),
          tin_(surgery.tin_),
          gone_(gone),
          is_gone_(tin_.triangle_count(), false),
          kept_(std::make_shared<RemovalRecord>()) {
        for (const TriangleId t : gone)
            is_gone_[t.index()] = true;
    }

    Surgery::Removed run() {
        name_all();
        part_fans();
        unlink();
        copy_vertices();
        close_gaps();
        index();
        settle();
        return {gone_vertices_.size(), further_.size()};
    }

  private:
    /// The triangles around a vertex that stay next to each other, by the sides that start at it.
    using Fan = std::vector<Side>;

    void name_all();
    void part_fans();
    void part_fan(VertexId v);
    Fan fan_around(VertexId v, bool& is_closed) const;
    void unlink();
    void copy_vertices();
    void close_gaps();
    void move(TriangleId from, TriangleId to);
    void move(VertexId from, VertexId to);
    void index();
    void renew_bounds();
    void renew_hints();
    void settle();

    Surgery& surgery_;
    Tin& tin_;
    std::span<const TriangleId> gone_;
    std::vector<bool> is_gone_;
    std::shared_ptr<RemovalRecord> kept_;
    std::vector<VertexId> names_;  ///< as they will be
    std::vector<ConstraintSplit> named_;
    std::vector<GoneEnd> gone_ends_;
    std::vector<VertexId> gone_vertices_;  ///< in order of slot
    std::vector<std::pair<VertexId, Fan>> further_;
    std::vector<TriangleId> moved_;  ///< where the triangles of the last slots are
    std::size_t built_vertex_count_ = 0;
    std::vector<std::pair<std::size_t, TriangleId>> hints_;  ///< new ones, by cell
    std::vector<TriangleId> components_;
    BoundaryIndex boundary_;
};

/// What was told by slot so far is told by name.
void Removal::name_all() {
    kept_->was_renumbered = tin_.is_renumbered();
    if (tin_.is_renumbered()) {
        names_ = tin_.names_;
    } else {
        names_.resize(tin_.vertex_count());
        for (std::uint32_t v = 0; v < names_.size(); ++v)
            names_[v] = {v};
    }
    kept_->named_splits = tin_.named_splits_;
    kept_->splits.assign(
        tin_.constraint_splits_.begin() + static_cast<std::ptrdiff_t>(tin_.named_splits_),
        tin_.constraint_splits_.end());
    for (const auto& [a, b, p] : kept_->splits)
        named_.push_back({tin_.name(a), tin_.name(b), tin_.name(p)});
    for (const TriangleId t : gone_) {
        for (unsigned i = 0; i < 3; ++i) {
            const Side side(t, i), twin = tin_.twin(side);
            const bool stays = twin.valid() && !is_gone_[twin.triangle().index()];
            if (stays || !tin_.is_constrained(side)) continue;
            for (const VertexId end : {tin_.origin(side), tin_.destination(side)})
                gone_ends_.push_back({tin_.name(end), tin_.plan(end)});
        }
    }
    std::ranges::sort(gone_ends_, {}, &GoneEnd::name);
    const auto is_same = [](const GoneEnd& l, const GoneEnd& r) { return l.name == r.name; };
    gone_ends_.erase(std::unique(gone_ends_.begin(), gone_ends_.end(), is_same), gone_ends_.end());
}

void Removal::part_fans() {
    std::vector<VertexId> touched;
    for (const TriangleId t : gone_)
        for (const VertexId v : tin_.triangle(t).vertices)
            touched.push_back(v);
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    for (const VertexId v : touched)
        part_fan(v);
}

/// Counter-clockwise, from the boundary on where there is one.
Removal::Fan Removal::fan_around(VertexId v, bool& is_closed) const {
    const Side first = side_from(tin_, v);
    Side start = first;
    while (tin_.twin(start).valid() && tin_.twin(start).next() != first)
        start = tin_.twin(start).next();
    is_closed = tin_.twin(start).valid();
    Fan fan;
    Side s = start;
    do {
        fan.push_back(s);
        s = tin_.twin(s.previous());
    } while (s.valid() && s != start);
    return fan;
}

void Removal::part_fan(VertexId v) {
    const auto stays = [this](Side s) { return !is_gone_[s.triangle().index()]; };
    bool is_closed = false;
    Fan fan = fan_around(v, is_closed);
    // No part goes on where the list begins again.
    if (is_closed)
        std::rotate(fan.begin(), std::find_if_not(fan.begin(), fan.end(), stays), fan.end());
    bool is_first = true;
    for (auto begin = std::find_if(fan.begin(), fan.end(), stays); begin != fan.end();) {
        const auto end = std::find_if_not(begin, fan.end(), stays);
        if (!is_first) {
            further_.emplace_back(v, Fan(begin, end));
        } else if (tin_.vertex(v).triangle != begin->triangle()) {
            surgery_.edit(v).triangle = begin->triangle();
        }
        is_first = false;
        begin = std::find_if(end, fan.end(), stays);
    }
    if (is_first) gone_vertices_.push_back(v);
}

void Removal::unlink() {
    for (const TriangleId t : gone_) {
        for (const Side twin : tin_.triangle(t).twins) {
            if (!twin.valid() || is_gone_[twin.triangle().index()]) continue;
            Tin::Triangle& beside = surgery_.edit(twin.triangle());
            beside.twins[twin.index()] = {};
            beside.marks &= ~(1U << (Surgery::kInsideShift + twin.index()));
        }
    }
}

void Removal::copy_vertices() {
    for (const auto& [v, fan] : further_) {
        const VertexId copy{static_cast<std::uint32_t>(tin_.vertices_.size())};
        Tin::Vertex same = tin_.vertex(v);
        same.triangle = fan.front().triangle();
        tin_.vertices_.push_back(same);
        names_.push_back(names_[v.index()]);
        for (const Side s : fan)
            surgery_.edit(s.triangle()).vertices[s.index()] = copy;
    }
}

/// Calls `move(from, to)` for each gap, lowest first, with what is then the last of `count` slots.
template <typename Id, typename Move>
void fill_gaps(std::span<const Id> gaps, std::size_t count, Move move) {
    std::size_t left = gaps.size();
    for (std::size_t i = 0; i < left; ++i) {
        for (; left > i && gaps[left - 1].index() == count - 1; --left)
            --count;
        if (i < left) move(Id{static_cast<std::uint32_t>(--count)}, gaps[i]);
    }
}

void Removal::close_gaps() {
    const std::size_t triangles = tin_.triangle_count() - gone_.size();
    moved_.assign(gone_.size(), {});
    fill_gaps(gone_, tin_.triangle_count(),
              [this](TriangleId from, TriangleId to) { move(from, to); });
    for (std::size_t t = triangles; t < tin_.triangle_count(); ++t)
        surgery_.edit(TriangleId{static_cast<std::uint32_t>(t)});
    tin_.triangles_.resize(triangles);

    const std::size_t vertices = tin_.vertex_count() - gone_vertices_.size();
    built_vertex_count_ = std::min(tin_.built_vertex_count_, vertices);
    fill_gaps(std::span<const VertexId>(gone_vertices_), tin_.vertex_count(),
              [this](VertexId from, VertexId to) { move(from, to); });
    for (std::size_t v = vertices; v < tin_.vertex_count(); ++v)
        surgery_.edit(VertexId{static_cast<std::uint32_t>(v)});
    tin_.vertices_.resize(vertices);
    names_.resize(vertices);
}

void Removal::move(TriangleId from, TriangleId to) {
    surgery_.edit(to) = surgery_.edit(from);
    const Tin::Triangle& triangle = tin_.triangle(to);
    for (unsigned i = 0; i < 3; ++i) {
        const Side twin = triangle.twins[i];
        if (twin.valid()) surgery_.edit(twin.triangle()).twins[twin.index()] = {to, i};
        const VertexId v = triangle.vertices[i];
        if (tin_.vertex(v).triangle == from) surgery_.edit(v).triangle = to;
    }
    moved_[from.index() - (tin_.triangle_count() - gone_.size())] = to;
}

void Removal::move(VertexId from, VertexId to) {
    if (from.index() >= tin_.built_vertex_count_)
        built_vertex_count_ = std::min(built_vertex_count_, to.index());
    bool is_closed = false;
    const Fan fan = fan_around(from, is_closed);
    surgery_.edit(to) = surgery_.edit(from);
    names_[to.index()] = names_[from.index()];
    for (const Side s : fan)
        surgery_.edit(s.triangle()).vertices[s.index()] = to;
}

/// All that is found anew. Requires: slots are what they will be.
void Removal::index() {
    renew_bounds();
    renew_hints();
    components_ = find_components(tin_);
    boundary_ = tin_.index_boundary();
}

void Removal::renew_bounds() {
    tin_.bounds_ = {tin_.vertices_[0].point(), tin_.vertices_[0].point()};
    Point3 &low = tin_.bounds_.min, &high = tin_.bounds_.max;
    for (const Tin::Vertex& v : tin_.vertices_) {
        low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
        high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    }
}

/// Cells whose triangle is gone take the hint before them, as cells that never had one do.
void Removal::renew_hints() {
    const std::size_t triangles = tin_.triangle_count();
    const auto now = [&](TriangleId t) {
        if (t.index() >= triangles) return moved_[t.index() - triangles];
        return is_gone_[t.index()] ? TriangleId{} : t;
    };
    TriangleId before{0};
    for (std::size_t cell = 0; cell < tin_.hints_.size(); ++cell) {
        const TriangleId hint = now(tin_.hints_[cell]);
        if (hint.valid()) before = hint;
        if (before != tin_.hints_[cell]) hints_.emplace_back(cell, before);
    }
}

/// Nothing can fail once the first of the mesh's parts is exchanged.
void Removal::settle() {
    RemovalRecord& kept = *kept_;
    kept.gone_ends = tin_.gone_ends_.size();
    kept.built_vertex_count = tin_.built_vertex_count_;
    if (kept.was_renumbered) {
        for (std::uint32_t v = 0; v < tin_.names_.size(); ++v)
            if (v >= names_.size() || names_[v] != tin_.names_[v])
                kept.names.emplace_back(VertexId{v}, tin_.names_[v]);
    }
    for (const auto& [cell, hint] : hints_)
        kept.hints.emplace_back(cell, tin_.hints_[cell]);
    tin_.gone_ends_.reserve(tin_.gone_ends_.size() + gone_ends_.size());

    if (!kept.was_renumbered)
        tin_.next_name_ = static_cast<std::uint32_t>(surgery_.record_.vertex_count);
    tin_.names_.swap(names_);
    std::copy(named_.begin(), named_.end(),
              tin_.constraint_splits_.begin() + static_cast<std::ptrdiff_t>(tin_.named_splits_));
    tin_.named_splits_ = tin_.constraint_splits_.size();
    tin_.gone_ends_.insert(tin_.gone_ends_.end(), gone_ends_.begin(), gone_ends_.end());
    tin_.built_vertex_count_ = built_vertex_count_;
    for (const auto& [cell, hint] : hints_)
        tin_.hints_[cell] = hint;
    kept.components = std::exchange(tin_.components_, std::move(components_));
    kept.boundary = std::exchange(tin_.boundary_, std::move(boundary_));
    surgery_.record_.removal = std::move(kept_);
}

Surgery::Removed Surgery::remove(std::span<const TriangleId> triangles) {
    if (triangles.empty()) return {};
    return Removal(*this, triangles).run();
}

}  // namespace tinsmith::core
