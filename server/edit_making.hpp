// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <variant>

#include "api/fault.hpp"
#include "api/formats/edit_json.hpp"
#include "server/edit.hpp"
#include "server/limits.hpp"
#include "server/session.hpp"

namespace tinsmith::server {

/// What keeps an edit from being made of a request: in the polygon, in the core's own words, or in
/// the body.
using NoEdit = std::variant<PolygonFault, core::Errors, api::Fault>;

/// Makes of a request what a session can run, with the ring that it needs, and gives it its
/// budgets, its clock and its end: a deadline from now, or `stopping`. Takes the readers' lock for
/// the time of a copy of the polygon. Requires: `stopping` outlives what is made.
/// Cost: the polygon's points, times their logarithm.
std::variant<PendingEdit, NoEdit> make_edit(const Session& session, const api::EditRequest& request,
                                            const Limits& limits,
                                            const std::atomic<bool>& stopping);

}  // namespace tinsmith::server
