// SPDX-License-Identifier: Apache-2.0
#include "core/integrate/integrator.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/integrate/improve_across.hpp"
#include "core/integrate/measure.hpp"
#include "core/integrate/promise.hpp"
#include "core/integrate/reach.hpp"
#include "core/integrate/shape_checks.hpp"
#include "core/integrate/shape_integration.hpp"
#include "core/integrate/way.hpp"

namespace tinsmith::core {

namespace {

Drift drift_on(const Tin& tin) {
    return Drift(tin.vertex_count(), kUsualDrift * reach_of_rounding(tin));
}

/// One request on one mesh, whole or not at all: what is not kept is taken back.
class Request {
  public:
    Request(Tin& tin, std::span<const Shape> shapes, const IntegrateOptions& options)
        : tin_(tin),
          shapes_(shapes),
          options_(options),
          limits_(limits_of(options)),
          drift_(drift_on(tin)),
          watch_(options.clock_ms),
          progress_(options.progress, shapes, improves_across() ? kShareOfMarch : 1.0) {
        limits_.progress = &progress_;
    }
    Request(const Request&) = delete;
    Request& operator=(const Request&) = delete;
    ~Request() { take_back(tin_, std::move(done_)); }

    Result<Report> run() {
        done_.reserve(2 * shapes_.size());  // once: to keep a record must not fail
        if (std::optional<Error> error = integrate_shapes()) return *error;
        if (!met_mesh_ && !encloses_mesh(tin_, shapes_)) return outside_error(tin_, shapes_);
        const bool leaves = std::any_of(report_.shapes.begin(), report_.shapes.end(),
                                        [](const ShapeReport& r) { return !r.outside.empty(); });
        if (leaves && options_.outside == Outside::Reject) return leaving_errors(report_);
        watch_.lap(report_.time_ms.integrate);
        if (improves_across())
            if (std::optional<Error> error = improve_across_facets()) return *error;
        name_chains();
        return std::move(report_);
    }

    /// The records of what was done, which is kept from now on.
    Undo keep() { return std::exchange(done_, {}); }

  private:
    /// Slots serve until the end; what is kept goes by name.
    void name_chains() {
        if (!tin_.is_renumbered()) return;
        for (ShapeReport& report : report_.shapes)
            for (Chain& chain : report.chains)
                for (VertexId& v : chain.vertices)
                    v = tin_.name(v);
    }

    static MarchLimits limits_of(const IntegrateOptions& options) {
        return {options.max_crossings, options.max_new_triangles, &options.cancelled, nullptr};
    }

    bool improves_across() const {
        return options_.improve == Improve::Paper || options_.improve == Improve::Bounded;
    }

    /// All of them, each path the way it finds; another way where rounding led one astray. The
    /// first error is the request's where no way helps.
    std::optional<Error> integrate_shapes() {
        Ways ways;
        std::optional<Error> first;
        while (true) {
            std::optional<Error> error = integrate_shapes(ways);
            if (!error && is_delicate_) error = broken_promise();
            if (!error || !may_go_another_way(error->code)) return error;
            const ErrorPlace& place = error->place;
            if (!first) first = error;
            if (!ways.change(place.shape.value_or(0), place.path.value_or(0))) return first;
            start_again();
        }
    }

    static bool may_go_another_way(ErrorCode code) {
        return code == ErrorCode::NotRepresentable || code == ErrorCode::StepBudget;
    }

    std::optional<Error> integrate_shapes(const Ways& ways) {
        for (std::size_t s = 0; s < shapes_.size(); ++s)
            if (std::optional<Error> error = integrate_shape(s, ways)) return error;
        return std::nullopt;
    }

    /// The core's own look at what it did, for the requests in which rounding decided something.
    std::optional<Error> broken_promise() const {
        const Replaced replaced(tin_, done_);
        const auto broken = find_broken_promise(
            {tin_, replaced, shapes_, report_.shapes, options_, reach_of_rounding(tin_)});
        if (!broken) return std::nullopt;
        ErrorPlace place;
        place.shape = broken->shape;
        place.path = broken->path;
        place.point = broken->point;
        place.position = broken->position;
        return Error{ErrorCode::NotRepresentable,
                     "no mesh of doubles was found that holds this segment as promised; move it a "
                     "little",
                     place};
    }

    void start_again() {
        take_back(tin_, done_);
        done_.clear();
        limits_ = limits_of(options_);
        limits_.progress = &progress_;
        progress_.begin();
        drift_ = drift_on(tin_);
        report_.shapes.clear();
        changed_.clear();
        set_vertices_.clear();
        met_mesh_ = false;
        is_delicate_ = true;  // the other ways are for the rare places: look at all they do
    }

    std::optional<Error> integrate_shape(std::size_t s, const Ways& ways) {
        Surgery surgery(tin_);
        ShapeIntegration integration(surgery, options_, limits_, drift_, watch_, report_.time_ms,
                                     progress_);
        if (!integration.run(shapes_[s], s, ways)) {
            Error error = integration.error();
            error.place.shape = s;
            return error;
        }
        const MarchTally& tally = integration.tally();
        met_mesh_ = met_mesh_ || tally.met_mesh;
        is_delicate_ = is_delicate_ || integration.is_delicate();
        // The budgets are the request's: each shape leaves the rest of them to the next.
        limits_.max_crossings -= tally.crossings + tally.self_crossings;
        limits_.max_new_triangles -= tin_.triangle_count() - surgery.record().triangle_count;
        report_.shapes.push_back(integration.report());
        changed_.push_back(std::move(integration.changed()));
        const std::vector<VertexId>& set = integration.set_vertices();
        set_vertices_.insert(set_vertices_.end(), set.begin(), set.end());
        done_.push_back(surgery.commit());
        watch_.lap(report_.time_ms.integrate);
        return std::nullopt;
    }

    /// Once all shapes are in, so that they cross no edge but those of the mesh before the request.
    std::optional<Error> improve_across_facets() {
        CrossFacetImprover improver = options_.improve == Improve::Bounded
                                          ? CrossFacetImprover(options_.max_deviation)
                                          : CrossFacetImprover();
        std::sort(set_vertices_.begin(), set_vertices_.end());
        improver.hold_to(std::move(set_vertices_));
        improver.limit_facets(options_.ids.facets);
        for (std::size_t s = 0; s < shapes_.size(); ++s) {
            Surgery surgery(tin_);
            if (std::optional<Error> error = improve_across_facets(improver, surgery, s))
                return error;
            done_.push_back(surgery.commit());
        }
        // A later shape's swaps may have reached an earlier one's triangles.
        for (std::size_t s = 0; s < shapes_.size(); ++s) {
            const bool is_last = s + 1 == shapes_.size();
            const std::size_t end = is_last ? tin_.triangle_count() : done_[s + 1].triangle_count;
            report_.shapes[s].smallest_angle_deg =
                measure_operation(tin_, {done_[s], end, &done_[shapes_.size() + s]})
                    .smallest_angle_deg;
        }
        watch_.lap(report_.time_ms.improve);
        return std::nullopt;
    }

    /// One shape's, some vertices at a time.
    std::optional<Error> improve_across_facets(CrossFacetImprover& improver, Surgery& surgery,
                                               std::size_t s) {
        constexpr std::size_t kAskEvery = 256;
        ShapeReport& report = report_.shapes[s];
        double deviation = 0.0;
        const std::span<const VertexId> vertices = changed_[s];
        for (std::size_t i = 0; i < vertices.size(); i += kAskEvery) {
            if (options_.cancelled && options_.cancelled())
                return Error{
                    ErrorCode::Cancelled, "the request was cancelled; nothing was changed", {}};
            if (options_.progress) {
                const double of_shape =
                    static_cast<double>(i) / static_cast<double>(vertices.size());
                const double done =
                    (static_cast<double>(s) + of_shape) / static_cast<double>(shapes_.size());
                options_.progress(kShareOfMarch + (1.0 - kShareOfMarch) * done);
            }
            const auto outcome = improver.improve(
                surgery, vertices.subspan(i, std::min(kAskEvery, vertices.size() - i)));
            if (!outcome.has_facets) return Error{ErrorCode::IdBudget, kNoFacetLeft, {}};
            report.edges_swapped += outcome.edges_swapped;
            deviation = std::max(deviation, outcome.max_deviation);
        }
        report.max_vertical_deviation += deviation;
        return std::nullopt;
    }

    /// Of the whole work, where swaps across facets follow on the march.
    static constexpr double kShareOfMarch = 0.5;

    Tin& tin_;
    std::span<const Shape> shapes_;
    const IntegrateOptions& options_;
    MarchLimits limits_;
    Drift drift_;
    Report report_;
    Stopwatch watch_;
    Progress progress_;
    Undo done_;
    std::vector<std::vector<VertexId>> changed_;  ///< by each shape
    std::vector<VertexId> set_vertices_;          ///< by all of them
    bool met_mesh_ = false;
    bool is_delicate_ = false;  ///< rounding decided somewhere
};

}  // namespace

Result<Report> integrate(Tin& tin, std::span<const Shape> shapes, const IntegrateOptions& options,
                         Undo* undo) {
    if (Errors errors = check_shapes(shapes); !errors.empty()) return errors;
    Request request(tin, shapes, options);
    Result<Report> report = request.run();
    if (!report) return report;
    Undo done = request.keep();
    if (undo != nullptr) *undo = std::move(done);
    return report;
}

void take_back(Tin& tin, const Undo& undo) {
    for (auto record = undo.rbegin(); record != undo.rend(); ++record)
        Surgery::undo(tin, *record);
}

void take_back(Tin& tin, Undo&& undo) noexcept {
    for (auto record = undo.rbegin(); record != undo.rend(); ++record)
        Surgery::undo(tin, std::move(*record));
}

}  // namespace tinsmith::core
