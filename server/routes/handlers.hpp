// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "server/http_message.hpp"
#include "server/router.hpp"
#include "server/services.hpp"

namespace tinsmith::server {

// Each is one line of the route table: parse, check, call, write. None needs a socket.

// page_routes.cpp
Response get_page(Services&, const Request&, const PathArguments&);

// service_routes.cpp
Response get_health(Services&, const Request&, const PathArguments&);  ///< takes no lock
Response get_ready(Services&, const Request&, const PathArguments&);   ///< waits for nobody
Response get_metrics(Services&, const Request&, const PathArguments&);
Response get_limits(Services&, const Request&, const PathArguments&);

/// Until the sessions have been loaded whoever asks for them is told to come again.
Handler once_started(Services& services, Handler handler);

// description_routes.cpp: the interface described, for programs and for people
Response get_description(Services&, const Request&, const PathArguments&);
Response get_docs(Services&, const Request&, const PathArguments&);
Response get_docs_file(Services&, const Request&, const PathArguments&);

// session_routes.cpp
Response list_sessions(Services&, const Request&, const PathArguments&);
Response create_session(Services&, const Request&, const PathArguments&);
Response put_session(Services&, const Request&, const PathArguments&);
Response get_session(Services&, const Request&, const PathArguments&);
Response delete_session(Services&, const Request&, const PathArguments&);
Response fork_session(Services&, const Request&, const PathArguments&);

// polygon_routes.cpp
Response integrate_polygons(Services&, const Request&, const PathArguments&);
Response list_polygons(Services&, const Request&, const PathArguments&);
Response get_polygon(Services&, const Request&, const PathArguments&);

// edit_routes.cpp
Response edit_polygon(Services&, const Request&, const PathArguments&);

// history_routes.cpp
Response delete_polygon(Services&, const Request&, const PathArguments&);
Response undo_edit(Services&, const Request&, const PathArguments&);
Response redo_edit(Services&, const Request&, const PathArguments&);
Response get_history(Services&, const Request&, const PathArguments&);
Response get_change(Services&, const Request&, const PathArguments&);

// lock_routes.cpp
inline constexpr std::array<std::string_view, 3> kLockParameters{"snap", "crs", "dry_run"};
Response put_locks(Services&, const Request&, const PathArguments&);
Response delete_locks(Services&, const Request&, const PathArguments&);
Response get_locks(Services&, const Request&, const PathArguments&);

// region_routes.cpp
Response list_regions(Services&, const Request&, const PathArguments&);
Response get_region(Services&, const Request&, const PathArguments&);

// constraint_routes.cpp
Response list_constraints(Services&, const Request&, const PathArguments&);

// job_routes.cpp
Response list_jobs(Services&, const Request&, const PathArguments&);
Response get_job(Services&, const Request&, const PathArguments&);
Response get_job_result(Services&, const Request&, const PathArguments&);
Response delete_job(Services&, const Request&, const PathArguments&);

// integrate_routes.cpp
Response integrate_once(Services&, const Request&, const PathArguments&);

// delta_routes.cpp
Response get_delta(Services&, const Request&, const PathArguments&);  ///< mesh?since=

// mesh_routes.cpp
Response get_mesh(Services&, const Request&, const PathArguments&);
Response get_mesh_glb(Services&, const Request&, const PathArguments&);
Response get_mesh_gltf(Services&, const Request&, const PathArguments&);
Response get_mesh_json(Services&, const Request&, const PathArguments&);
Response get_mesh_obj(Services&, const Request&, const PathArguments&);
Response get_mesh_landxml(Services&, const Request&, const PathArguments&);

// question_routes.cpp: nothing changes
Response get_elevation(Services&, const Request&, const PathArguments&);
Response ask_elevations(Services&, const Request&, const PathArguments&);
Response ask_profile(Services&, const Request&, const PathArguments&);
Response ask_volume(Services&, const Request&, const PathArguments&);

}  // namespace tinsmith::server
