// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/fault.hpp"
#include "api/formats/gltf.hpp"
#include "api/requests.hpp"
#include "server/edit.hpp"
#include "server/http_message.hpp"
#include "server/metrics/metrics.hpp"
#include "server/routes/preconditions.hpp"
#include "server/routes/step.hpp"
#include "server/services.hpp"

namespace tinsmith::server {

/// The session that the path names first, or 404.
Step<std::shared_ptr<Session>> require_session(Services& services, const Request& request,
                                               const std::string& id);

/// 201 with a session that has been made.
Response tell_created(const api::SessionView& view, const std::string& birth);
/// How a version came about: the report of a request again; of another change what is told of it.
Response tell_change(const Session& session, const ChangeCopy& change);

Response no_such_session(const Services& services, const Request& request, const std::string& id);

Response no_such_polygon(const Request& request, const Session& session, const std::string& id);

/// 7 of "p7"; 0, which no polygon has, where it is none.
std::uint64_t polygon_number(std::string_view id);

/// Which of the offers the Accept header prefers, or 406 naming all of them.
Step<std::size_t> require_media_type(const Request& request,
                                     std::span<const std::string_view> offers);

/// 415 that says what is read here and, to those who come with curl, what to add.
Response refuse_media_type(const Request& request, const std::string& type, std::string_view what,
                           std::string_view known, std::string_view curl_hint);

/// The query as options, with no place in the body.
std::vector<api::NamedOption> options_of_query(const Request& request);

/// Those of the query that have one of these names.
std::vector<api::NamedOption> options_of_query(const Request& request,
                                               std::span<const std::string_view> names);

/// How the query of an edit wants its mesh written, which is to be sent as that type; 400 where it
/// says so of a type that is not glTF.
Step<api::GltfOptions> require_gltf_options(const Request& request, std::string_view type);

/// How a mesh goes out as glTF.
struct GltfAnswer {
    std::string_view type = "model/gltf-binary";    ///< or "model/gltf+json"
    const api::RegionPartition* regions = nullptr;  ///< see api::write_glb
    std::string note = {};  ///< told with a refusal: what has been done all the same
};

/// The mesh as glTF, with headers that say what rounding did, or why it cannot be written.
Response gltf_response(Metrics& metrics, const Request& request, const core::MeshData& mesh,
                       const api::GltfOptions& options, const GltfAnswer& as);

/// What changed, or why it cannot be sent though the edit was made.
Response delta_response(Metrics& metrics, const Request& request, const Session& session,
                        std::uint64_t version, const std::optional<api::MeshDelta>& delta);

/// The mesh after an edit as glTF of that type. The edit is made even where its mesh cannot be
/// sent, and the answer says so, unless it was a dry run.
Response mesh_after(Metrics& metrics, const Request& request, const Session& session,
                    std::uint64_t version, const std::optional<core::MeshData>& mesh, bool dry_run,
                    std::string_view type, api::GltfOptions options);

/// 400: a dry run makes no version.
Response refuse_delta_of_dry_run(const Request& request);

/// 400: a mesh has no place for what the report counts.
Response refuse_angles_of_mesh(const Request& request);

/// A parameter that is true or false; false where it is not given.
Step<bool> require_flag(const Request& request, const std::string& name);

/// 404 or 422, for the polygon that the body's member "polygon" names.
Response refuse_polygon(const Request& request, const std::string& id, PolygonFault fault);

/// Where the report of a version stays, as a Link header has it.
std::string history_link(const Session& session, std::uint64_t version);

/// A version as it stands in a path or a query; nothing where that is no whole number.
std::optional<std::uint64_t> parse_version(std::string_view text);

/// 404: versions end at the current one.
Response version_ahead(const Request& request, const VersionAhead& ahead);

/// 410, naming the oldest version that is kept.
Response version_gone(const Request& request, const Session& session, const VersionGone& gone);

/// 404 or 410; nothing where the session has the version.
std::optional<Response> refusal_of_version(const Request& request, const Session& session,
                                           std::uint64_t version);

/// What `tin_at` or `state_at` did not give, as an answer.
Response refuse_version(const Request& request, const Session& session,
                        const VersionOutcome& outcome);
Response refuse_version(const Request& request, const Session& session,
                        const StateOutcome& outcome);

/// What the core refused of a question; faults are told at places of the body, if there is one.
/// `limit`: what a budget is called that is not the usual one.
Response refuse_question(const Request& request, const core::Errors& errors,
                         const std::vector<api::RequestedShape>& shapes = {},
                         const std::string& limit = {});

/// The shortest text that reads back to the same number.
std::string text_of(double value);

/// Memory for copies of meshes, or 507.
Step<BorrowedMemory> require_memory(Services& services, const Request& request, std::size_t bytes);

/// Memory for a mesh that is built of what a request brought, held as long as this lives.
class MemoryToBuild {
  public:
    MemoryToBuild(Services& services, const Request& request)
        : services_(services), request_(request) {}

    /// Whether there is so much. Once.
    bool take(std::size_t bytes);
    /// 507 where there was not.
    std::optional<Response> refusal() const;

  private:
    Services& services_;
    const Request& request_;
    std::optional<BorrowedMemory> memory_;
    std::size_t refused_ = 0;
};

/// About what a copy of a mesh, its encoding and the answer take together, beside the mesh itself,
/// at most: of every format the dearest, as measured with a million triangles.
constexpr std::size_t bytes_to_encode(std::size_t mesh_bytes) {
    return 5 * mesh_bytes;
}

/// 507, or nothing where all sessions together are within their limit of memory.
std::optional<Response> refusal_of_memory(Services& services, const Request& request);

}  // namespace tinsmith::server
