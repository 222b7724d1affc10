// SPDX-License-Identifier: Apache-2.0
// A session's edits of what is inside its polygons.
#include <utility>

#include "server/session.hpp"

namespace tinsmith::server {

EditOutcome Session::edit(PendingEdit edit) {
    if (edit.dry_run) return edit_dry(edit);
    const auto lock = lock_to_write();
    const std::uint64_t before = version();
    if (!is_expected(edit, before)) return VersionMismatch{before};
    const std::string polygon = edit.operation.asked.polygon;
    if (!polygon_finder()(polygon)) return PolygonFault::NotThere;
    const RunLimits limits = tightened(edit.limits, size_now(), edit.most);
    const auto applied = perform(std::make_shared<const Operation>(std::move(edit.operation)),
                                 ChangeKind::Edit, {polygon}, limits);
    if (!applied) return named_by(limits, applied.errors());
    refresh_view();
    EditResult result{before + 1, (*applied)->answer, std::nullopt, std::nullopt};
    if (edit.want_mesh) result.mesh = mesh_if_possible();
    if (edit.want_delta) result.delta = delta_if_possible(before);
    return result;
}

EditOutcome Session::edit_dry(const PendingEdit& edit) const {
    auto lock = lock_to_read();
    const std::uint64_t now = version();
    if (!is_expected(edit, now)) return VersionMismatch{now};
    const auto found = polygon_finder()(edit.operation.asked.polygon);
    if (!found) return PolygonFault::NotThere;
    // Copied out: the views end with the lock.
    const core::Shape shape = found->outline();
    const core::ShapeReport own = found->own_report();
    const core::Winding winding = found->request.winding;
    core::Tin trial = tin_;
    const RunLimits limits = tightened(edit.limits, size_now(), edit.most);
    lock.unlock();
    auto report =
        core::edit_region(trial, {shape, own.chains, own.outside}, winding, edit.operation.edit,
                          {limits.max_crossings,
                           limits.max_new_triangles,
                           {},
                           limits.cancelled,
                           limits.clock_ms,
                           limits.progress});
    if (!report) return named_by(limits, report.errors());
    auto answer = std::make_shared<api::EditAnswer>(edit.operation.asked);
    report->apply_ms += answer->report.apply_ms;
    answer->report = *report;
    EditResult result{now, std::move(answer), std::nullopt, std::nullopt};
    if (edit.want_mesh) result.mesh = trial.to_data();
    return result;
}

}  // namespace tinsmith::server
