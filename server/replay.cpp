// SPDX-License-Identifier: Apache-2.0
#include "server/replay.hpp"

#include <utility>

namespace tinsmith::server {

namespace {

void take_back_all(core::Tin& tin, std::span<const AppliedPtr> taken) {
    for (auto applied = taken.rbegin(); applied != taken.rend(); ++applied)
        core::take_back(tin, (*applied)->undo);
}

}  // namespace

RunLimits limits_of_part(const RunLimits& limits, std::size_t index, std::size_t count) {
    RunLimits part = limits;
    if (limits.progress) {
        part.progress = [tell = limits.progress, index, count](double share) {
            tell((static_cast<double>(index) + share) / static_cast<double>(count));
        };
    }
    return part;
}

Replayed run_all(core::Tin& tin, std::span<const Rerun> wanted, const RunLimits& limits,
                 const PolygonFinder& find) {
    std::vector<AppliedPtr> done;
    done.reserve(wanted.size());
    // What was run again lies in the mesh as it says now.
    const PolygonFinder find_here = [&](std::string_view id) {
        for (auto applied = done.rbegin(); applied != done.rend(); ++applied)
            if (auto polygon = polygon_of(**applied, id)) return polygon;
        return find(id);
    };
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const Rerun& rerun = wanted[i];
        auto applied = run(tin, rerun.version, rerun.operation,
                           limits_of_part(limits, i, wanted.size()), find_here);
        if (!applied) return ReplayFailure{rerun.version, std::move(applied.errors())};
        done.push_back(std::move(*applied));
    }
    return done;
}

Replayed replace_newest(core::Tin& tin, std::span<const AppliedPtr> taken,
                        std::span<const Rerun> wanted, const RunLimits& limits,
                        const PolygonFinder& find) {
    // One operation alone is whole or not at all by itself.
    if (wanted.empty() && taken.size() <= 1) {
        take_back_all(tin, taken);
        return std::vector<AppliedPtr>{};
    }
    if (taken.empty() && wanted.size() == 1) return run_all(tin, wanted, limits, find);
    core::Tin trial = tin;
    take_back_all(trial, taken);
    auto done = run_all(trial, wanted, limits, find);
    if (std::holds_alternative<std::vector<AppliedPtr>>(done)) tin = std::move(trial);
    return done;
}

}  // namespace tinsmith::server
