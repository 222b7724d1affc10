// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "api/formats/questions_json.hpp"
#include "core/edit/profile.hpp"
#include "core/edit/spot.hpp"
#include "core/edit/volume.hpp"
#include "core/types/result.hpp"
#include "server/limits.hpp"
#include "server/session.hpp"
#include "server/work.hpp"

namespace tinsmith::server {

/// The surface at positions, of one version.
struct SpotsAnswer {
    std::vector<std::optional<core::Spot>> spots;
    std::uint64_t version = 0;
};

struct SpotAnswer {
    std::optional<core::Spot> spot;
    std::vector<std::string> polygons;  ///< ids of those around the position, as they were drawn
    std::uint64_t version = 0;
};

struct ProfileAnswer {
    core::Profile profile;
    std::uint64_t version = 0;
};

struct VolumeAnswer {
    core::Volume volume;
    double area_left_out = 0.0;  ///< within rounding of nothing: nothing
    std::uint64_t version = 0;
    std::uint64_t other_version = 0;
};

using ProfileOutcome = std::variant<ProfileAnswer, core::Errors>;
using VolumeOutcome =
    std::variant<VolumeAnswer, core::Errors, PolygonFault, VersionGone, VersionAhead>;

// Each holds a session's readers' lock while it looks at the mesh, or copies it for longer work;
// never two at the same time.

SpotAnswer spot_in(const Session& session, core::Point2 p);
SpotsAnswer spots_in(const Session& session, std::span<const core::Point2> points);
ProfileOutcome profile_in(const Session& session, std::span<const core::Point2> line,
                          const core::ProfileLimits& limits);

/// About what `volume_in` takes for its copies of meshes.
std::size_t volume_bytes(const Session& session, const api::VolumeRequest& request,
                         const Session* other);

/// Works on copies of the meshes. Requires: `other` where the request names another session.
VolumeOutcome volume_in(const Session& session, const api::VolumeRequest& request,
                        const Session* other, const Limits& limits,
                        const std::atomic<bool>& stopping);

}  // namespace tinsmith::server
