// SPDX-License-Identifier: Apache-2.0
#include "core/edit/region_edit.hpp"

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "core/edit/moving_vertices.hpp"
#include "core/edit/neumaier_sum.hpp"
#include "core/edit/ring.hpp"
#include "core/edit/smoothing.hpp"
#include "core/edit/vertex_moves.hpp"
#include "core/mesh/surgery.hpp"
#include "core/predicates/orientation.hpp"

namespace tinsmith::core {

namespace {

/// Of an edit with a ring: the share of the work that integrating it is, about.
constexpr double kShareOfRing = 0.7;

Error nothing_inside() {
    return {ErrorCode::NothingInside,
            "nothing of the polygon's inside lies on the mesh; nothing was changed",
            {}};
}

Error stopped() {
    return {ErrorCode::Cancelled, "the edit was cancelled; nothing was changed", {}};
}

/// One edit of one mesh, whole or not at all: what is not kept is taken back.
class Work {
  public:
    Work(Tin& tin, const Outline& outline, Winding winding, const EditLimits& limits)
        : tin_(tin), outline_(outline), winding_(winding), limits_(limits) {
        if (limits_.clock_ms) start_ = limits_.clock_ms();
    }
    Work(const Work&) = delete;
    Work& operator=(const Work&) = delete;
    ~Work() { take_back(tin_, std::move(done_)); }

    Result<EditReport> run(const RegionEdit& edit) {
        std::optional<Errors> errors =
            std::visit([this](const auto& kind) { return apply(kind); }, edit);
        if (errors) return std::move(*errors);
        if (limits_.clock_ms) {
            const StageTimes& ring = report_.time_ms;
            report_.apply_ms =
                limits_.clock_ms() - start_ - (ring.locate + ring.integrate + ring.improve);
        }
        return report_;
    }

    /// The records of what was done, which is kept from now on.
    Undo keep() { return std::exchange(done_, {}); }

  private:
    std::optional<Errors> apply(const ElevationEdit& edit) {
        if (!edit.strip) {
            const Region region = own_region();
            return raise(edit, {region.triangles, region.triangles, false});
        }
        const Strip& strip = *edit.strip;
        ShapeReport ring;
        if (auto errors = integrate(strip, ring)) return errors;
        tell(kShareOfRing);
        const Region own = own_region();
        if (is_cancelled()) return Errors{stopped()};
        const Region within =
            find_region(tin_, ConstraintHistory(tin_), {strip.ring, ring.chains, ring.outside},
                        Winding::EvenOdd);
        std::vector<TriangleId> both;
        if (strip.kind == Strip::Kind::Rim) {
            // The ring is inside the border but for rounding: what of it is not stays as it is.
            std::ranges::set_intersection(own.triangles, within.triangles,
                                          std::back_inserter(both));
            return raise(edit,
                         {own.triangles, both, true, outline_.chains, &strip.ring, strip.width});
        }
        std::ranges::set_union(own.triangles, within.triangles, std::back_inserter(both));
        return raise(edit, {both, own.triangles, true, ring.chains, &strip.border, strip.width});
    }

    std::optional<Errors> apply(const SmoothEdit& edit) {
        const Region region = own_region();
        if (region.triangles.empty()) return Errors{nothing_inside()};
        if (is_cancelled()) return Errors{stopped()};
        const auto moving = moving_vertices(
            tin_, {region.triangles, region.triangles, !edit.moves_border, outline_.chains});
        const auto moves = smoothed(tin_, moving, edit.passes, limits_.cancelled, limits_.progress);
        if (!moves) return Errors{stopped()};
        return move(*moves);
    }

    std::optional<Errors> apply(const TrimEdit& edit) {
        const Region region = own_region();
        if (region.triangles.empty()) return Errors{nothing_inside()};
        std::vector<TriangleId> gone = region.triangles;
        if (edit.keeps_inside) {
            gone.clear();
            auto next = region.triangles.begin();
            for (std::uint32_t t = 0; t < tin_.triangle_count(); ++t) {
                if (next != region.triangles.end() && next->value == t)
                    ++next;
                else
                    gone.push_back({t});
            }
        }
        if (gone.size() == tin_.triangle_count()) {
            return Errors{Error{ErrorCode::NothingLeft,
                                "the polygon holds the whole mesh: removing it would leave no "
                                "triangle; nothing was changed",
                                {}}};
        }
        return remove(gone);
    }

    bool is_cancelled() const { return limits_.cancelled && limits_.cancelled(); }

    void tell(double share) const {
        if (limits_.progress) limits_.progress(share);
    }

    Region own_region() const {
        return find_region(tin_, ConstraintHistory(tin_), outline_, winding_);
    }

    /// With the best triangles; but where that would swap edges beyond the border of a rim, which
    /// lines integrated without improvement leave to be swapped, with none.
    std::optional<Errors> integrate(const Strip& strip, ShapeReport& found) {
        const Region before = strip.kind == Strip::Kind::Rim ? own_region() : Region{};
        if (auto errors = integrate(strip.ring, Improve::Strict, found)) return errors;
        if (strip.kind == Strip::Kind::Taper || !has_changed_beyond(before)) return std::nullopt;
        take_back(tin_, done_);
        done_.clear();
        return integrate(strip.ring, Improve::None, found);
    }

    bool has_changed_beyond(const Region& region) const {
        const auto& inside = region.triangles;
        for (const UndoRecord& record : done_) {
            for (const auto& [t, old] : record.triangles) {
                if (old.vertices != tin_.triangle(t).vertices &&
                    !std::binary_search(inside.begin(), inside.end(), t))
                    return true;
            }
        }
        return false;
    }

    std::optional<Errors> integrate(const Shape& ring, Improve improve, ShapeReport& found) {
        IntegrateOptions options;
        options.improve = improve;
        options.max_crossings = limits_.max_crossings;
        options.max_new_triangles = limits_.max_new_triangles;
        options.ids = limits_.ids;
        options.cancelled = limits_.cancelled;
        options.clock_ms = limits_.clock_ms;
        if (limits_.progress)
            options.progress = [this](double share) { tell(kShareOfRing * share); };
        auto report = integrate_ring(tin_, ring, options, &done_);
        if (!report) return std::move(report.errors());
        report_.time_ms.locate += report->time_ms.locate;
        report_.time_ms.integrate += report->time_ms.integrate;
        report_.time_ms.improve += report->time_ms.improve;
        found = std::move(report->shapes.front());
        report_.vertices_added = found.vertices_added;
        report_.triangles_added = found.triangles_added;
        return std::nullopt;
    }

    std::optional<Errors> raise(const ElevationEdit& edit, const Extent& extent) {
        if (extent.outer.empty()) return Errors{nothing_inside()};
        if (is_cancelled()) return Errors{stopped()};
        std::vector<VertexMove> moves;
        for (const Moving& each : moving_vertices(tin_, extent)) {
            const Point3 old = tin_.vertex(each.vertex).point();
            const double target = target_of(edit, old);
            const double z = each.share == 1.0 ? target : old.z + (target - old.z) * each.share;
            moves.push_back({each.vertex, z});
        }
        return move(moves);
    }

    static double target_of(const ElevationEdit& edit, Point3 old) {
        if (const auto* plane = std::get_if<Plane>(&edit.change))
            return plane->elevation(old.plan());
        return old.z + std::get<ElevationEdit::Offset>(edit.change).by;
    }

    std::optional<Errors> move(std::span<const VertexMove> moves) {
        if (is_cancelled()) return Errors{stopped()};
        done_.reserve(done_.size() + 1);  // to keep a record must not fail
        Surgery surgery(tin_);
        if (auto error = move_vertices(surgery, moves, limits_.ids, report_)) return Errors{*error};
        done_.push_back(surgery.commit());
        return std::nullopt;
    }

    std::optional<Errors> remove(std::span<const TriangleId> gone) {
        if (is_cancelled()) return Errors{stopped()};
        if (gone.empty()) return std::nullopt;
        NeumaierSum area;
        for (const TriangleId t : gone) {
            const auto& [a, b, c] = tin_.triangle(t).vertices;
            area.add(compensated_doubled_area(tin_.plan(a), tin_.plan(b), tin_.plan(c)) / 2.0);
        }
        done_.reserve(done_.size() + 1);
        Surgery surgery(tin_);
        const Surgery::Removed removed = surgery.remove(gone);
        report_.triangles_removed = gone.size();
        report_.vertices_removed = removed.vertices;
        report_.vertices_added = removed.copies;
        report_.area_affected = area.value();
        done_.push_back(surgery.commit());
        return std::nullopt;
    }

    Tin& tin_;
    const Outline& outline_;
    const Winding winding_;
    const EditLimits& limits_;
    EditReport report_;
    Undo done_;
    double start_ = 0.0;
};

}  // namespace

Result<EditReport> edit_region(Tin& tin, const Outline& outline, Winding winding,
                               const RegionEdit& edit, const EditLimits& limits, Undo* undo) {
    Work work(tin, outline, winding, limits);
    auto report = work.run(edit);
    if (!report) return report;
    Undo done = work.keep();
    if (undo != nullptr) *undo = std::move(done);
    return report;
}

}  // namespace tinsmith::core
