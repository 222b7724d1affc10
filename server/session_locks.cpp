// SPDX-License-Identifier: Apache-2.0
// A session's locked edges.
#include <utility>

#include "server/session.hpp"

namespace tinsmith::server {

LocksOutcome Session::set_locks(LocksEdit edit, RunLimits limits) {
    limits.must_find = true;
    if (edit.dry_run) return lock_dry(edit, limits);
    const auto lock = lock_to_write();
    const std::uint64_t before = version();
    if (!is_expected(edit, before)) return VersionMismatch{before};
    auto applied = perform(std::make_shared<const Operation>(std::move(edit.operation)),
                           ChangeKind::Locks, {}, limits);
    if (!applied) return std::move(applied.errors());
    refresh_view();
    LocksResult result{before + 1, (*applied)->locks, std::nullopt};
    if (edit.want_delta) result.delta = delta_if_possible(before);
    return result;
}

LocksOutcome Session::lock_dry(const LocksEdit& edit, const RunLimits& limits) const {
    auto lock = lock_to_read();
    const std::uint64_t now = version();
    if (!is_expected(edit, now)) return VersionMismatch{now};
    core::Tin trial = tin_;
    lock.unlock();
    const PolygonFinder none = [](std::string_view) { return std::optional<Polygon>(); };
    auto applied = run(trial, now, std::make_shared<const Operation>(edit.operation), limits, none);
    if (!applied) return std::move(applied.errors());
    return LocksResult{now, (*applied)->locks, std::nullopt};
}

LockedCopy Session::locked_after(std::optional<std::uint32_t> side, std::size_t limit) const {
    const auto lock = lock_to_read();
    LockedCopy copy;
    copy.version = version();
    const std::size_t first = side ? *side >> 2 : 0;
    for (std::size_t t = first; t < tin_.triangle_count(); ++t) {
        for (unsigned i = 0; i < 3; ++i) {
            const core::Side s({static_cast<std::uint32_t>(t)}, i);
            if (!tin_.is_locked(s) || (side && s.code <= *side)) continue;
            if (const core::Side twin = tin_.twin(s); twin.valid() && twin < s) continue;
            copy.more = copy.edges.size() == limit;
            if (copy.more) return copy;
            const core::VertexId a = tin_.origin(s);
            const core::VertexId b = tin_.destination(s);
            copy.edges.push_back(
                {{a.value, b.value}, {tin_.vertex(a).point(), tin_.vertex(b).point()}});
            copy.last = s.code;
        }
    }
    return copy;
}

}  // namespace tinsmith::server
