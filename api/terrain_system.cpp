// SPDX-License-Identifier: Apache-2.0
#include "api/terrain_system.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/crs.hpp"

namespace tinsmith::api {

namespace {

/// Vertices that are brought over between two looks at whether to go on.
constexpr std::size_t kBetweenLooks = 65'536;

struct Refused {
    FaultKind kind;
    Fault fault;
};

Refused refused(FaultKind kind, std::string code, std::string detail, std::string parameter = {}) {
    Fault fault{std::move(code), std::move(detail), {}};
    fault.parameter = std::move(parameter);
    return {kind, std::move(fault)};
}

Refused refused(NoPlace no, std::string parameter = {}) {
    return refused(FaultKind::Invalid, std::move(no.code), std::move(no.detail),
                   std::move(parameter));
}

bool same_length(double a, double b) {
    return std::fabs(a - b) <= 1e-9;
}

class Settler {
  public:
    using Zone = std::function<std::variant<std::string, NoPlace>()>;
    Settler(SystemSaid&& said, const TerrainOptions& options, const Zone& zone)
        : said_(std::move(said)), options_(options), zone_(zone) {}

    Parsed<SystemSettled> settle() {
        using Step = std::optional<Refused> (Settler::*)();
        for (const Step step : {&Settler::take_options, &Settler::take_system,
                                &Settler::take_target, &Settler::take_elevations}) {
            if (auto no = (this->*step)()) return {no->kind, std::move(no->fault)};
        }
        return std::move(settled_);
    }

  private:
    std::optional<Refused> take_options();
    std::optional<Refused> take_named(const std::string& crs);
    std::optional<Refused> take_system();
    std::optional<Refused> take_target();
    std::optional<Refused> take_elevations();

    SystemSaid said_;
    const TerrainOptions& options_;
    const Zone& zone_;
    std::string unit_;  ///< that an option names
    SystemSettled settled_;
};

std::optional<Refused> Settler::take_options() {
    if (!options_.unit.empty()) {
        const auto unit = normalise_unit(options_.unit);
        if (!unit) {
            return refused(FaultKind::Invalid, "UNIT_UNKNOWN",
                           "This unit is not known. Known are: metre, foot, US survey foot.",
                           "unit");
        }
        unit_ = *unit;
    }
    if (options_.crs.empty()) return std::nullopt;
    const auto crs = normalise_crs(options_.crs);
    if (!crs) {
        return refused(FaultKind::Invalid, "CRS_UNKNOWN",
                       "This is no name of a reference system. Write it like EPSG:32616.", "crs");
    }
    if (!said_.crs.empty() && !same_crs(said_.crs, *crs)) {
        return refused(FaultKind::Invalid, "CONTRADICTION",
                       "The terrain says that it is in " + said_.crs + ", the option crs says " +
                           *crs + ": leave the option out, or give the same.",
                       "crs");
    }
    return said_.crs.empty() ? take_named(*crs) : std::nullopt;
}

/// The option names the system of bytes that name none, or one without a code.
std::optional<Refused> Settler::take_named(const std::string& crs) {
    const auto facts = find_crs(crs);
    if (!facts) return refused(unknown_crs(crs), "crs");
    const bool geographic = facts->kind == CrsFacts::Kind::Geographic;
    if (said_.named && (said_.geographic != geographic ||
                        (!geographic && !same_length(said_.plan_metres, facts->metres)))) {
        return refused(FaultKind::Invalid, "CONTRADICTION",
                       "The terrain names a system without a code, and it cannot be " +
                           crs_with_name(*facts) + ": that has another unit.",
                       "crs");
    }
    said_.named = true;
    said_.crs = crs;
    if (said_.source.empty()) said_.source = crs;
    return std::nullopt;
}

std::optional<Refused> Settler::take_system() {
    if (!said_.named) {
        if (options_.project.empty()) return std::nullopt;
        return refused(FaultKind::Invalid, "PROJECT_WITHOUT_CRS",
                       "The terrain does not say what system it is in, so it cannot be projected: "
                       "name it, such as crs=EPSG:4326.",
                       "project");
    }
    if (said_.crs.empty()) return std::nullopt;
    const auto facts = find_crs(said_.crs);
    if (!facts) return refused(unknown_crs(said_.crs));
    if (facts->kind == CrsFacts::Kind::Other) return refused(unfit_crs(*facts));
    said_.geographic = facts->kind == CrsFacts::Kind::Geographic;
    if (!said_.geographic) said_.plan_metres = facts->metres;
    settled_.crs = said_.crs;
    return std::nullopt;
}

std::optional<Refused> Settler::take_target() {
    if (!said_.geographic) {
        if (options_.project.empty() || options_.project == "auto") return std::nullopt;
        if (normalise_crs(options_.project) == settled_.crs) return std::nullopt;
        return refused(FaultKind::Invalid, "PROJECT_NOT_GEOGRAPHIC",
                       "The terrain is projected already, in " +
                           (settled_.crs.empty() ? "a system without a code" : settled_.crs) +
                           ": project is for terrains in degrees. Leave it out.",
                       "project");
    }
    if (options_.project.empty()) {
        return refused(FaultKind::Unsupported, "CRS_GEOGRAPHIC",
                       (said_.crs.empty() ? std::string("The terrain's system") : said_.crs) +
                           " is in degrees, and lengths and slopes need a plan. Ask for one with "
                           "project=auto (the UTM zone of its centre), or name it, such as "
                           "project=EPSG:32633.");
    }
    std::string target;
    if (options_.project == "auto") {
        auto zone = zone_();
        if (auto* no = std::get_if<NoPlace>(&zone)) return refused(std::move(*no), "project");
        target = std::get<std::string>(std::move(zone));
    } else if (const auto named = normalise_crs(options_.project)) {
        target = *named;
    } else {
        return refused(FaultKind::Invalid, "CRS_UNKNOWN",
                       "project is auto or the name of a projected system, such as EPSG:32633.",
                       "project");
    }
    const auto facts = find_crs(target);
    if (!facts) return refused(unknown_crs(target), "project");
    if (facts->kind != CrsFacts::Kind::Projected) {
        return refused(FaultKind::Invalid, "PROJECT_UNFIT",
                       crs_with_name(*facts) +
                           " is no projected system. Name one, such as EPSG:32633, or say "
                           "project=auto.",
                       "project");
    }
    settled_.crs = target;
    settled_.warp_from = said_.source;
    if (!said_.elevation_metres) said_.elevation_metres = unit_.empty() ? 1.0 : metres_per(unit_);
    if (!unit_.empty() && !same_length(*said_.elevation_metres, metres_per(unit_))) {
        return refused(FaultKind::Invalid, "CONTRADICTION",
                       "The terrain says that its elevations are in another unit than " + unit_ +
                           ": leave the option unit out.",
                       "unit");
    }
    unit_.clear();  // it was that of the elevations
    said_.plan_metres = facts->metres;
    return std::nullopt;
}

std::optional<Refused> Settler::take_elevations() {
    if (!said_.named) {
        // Nothing is known of the plan: one unit for all three.
        if (unit_.empty() && said_.elevation_metres)
            unit_ = unit_of_length(*said_.elevation_metres).value_or("");
        if (unit_.empty()) unit_ = "metre";
        said_.plan_metres = metres_per(unit_);
    }
    const auto unit = unit_of_length(said_.plan_metres);
    if (!unit) {
        return refused(FaultKind::Unsupported, "UNIT_UNKNOWN",
                       "The terrain's coordinates are in a unit of " +
                           std::to_string(said_.plan_metres) +
                           " metres. Known are metre, foot and US survey foot.");
    }
    if (!unit_.empty() && unit_ != *unit) {
        return refused(FaultKind::Invalid, "CONTRADICTION",
                       "The unit is said to be " + unit_ + ", and " + settled_.crs + " is in " +
                           *unit + ": leave the unit out, or give the same.",
                       "unit");
    }
    settled_.unit = *unit;
    if (said_.elevation_metres && !same_length(*said_.elevation_metres, said_.plan_metres))
        settled_.elevation_factor = *said_.elevation_metres / said_.plan_metres;
    return std::nullopt;
}

core::Point2 centre_of(const core::MeshData& mesh) {
    core::Point2 low{HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL};
    for (const core::Point3& p : mesh.vertices) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    return {0.5 * (low.x + high.x), 0.5 * (low.y + high.y)};
}

/// Every vertex in the new system, or why not: all of that, up to the limit.
Parsed<Terrain> moved(Terrain terrain, const SystemSettled& settled, const ReadLimits& limits) {
    auto made = Transformation::between(settled.warp_from, settled.crs);
    if (auto* no = std::get_if<NoPlace>(&made))
        return {FaultKind::Invalid, Fault{std::move(no->code), std::move(no->detail), {}}};
    const auto& transformation = std::get<Transformation>(made);
    Faults faults;
    const std::size_t count = terrain.mesh.vertices.size();
    for (std::size_t i = 0; i < count && faults.size() < limits.max_faults; ++i) {
        // Points have most of their work before them.
        const double share =
            terrain.points ? 0.5 : static_cast<double>(i) / static_cast<double>(count);
        if (i % kBetweenLooks == 0 && limits.progress && !limits.progress(share))
            return {FaultKind::Stopped, reading_stopped()};
        core::Point3& vertex = terrain.mesh.vertices[i];
        auto there = transformation(vertex.plan());
        if (const auto* plan = std::get_if<core::Point2>(&there)) {
            vertex = {plan->x, plan->y, vertex.z * settled.elevation_factor};
            continue;
        }
        auto& no = std::get<NoPlace>(there);
        Fault fault{std::move(no.code), std::move(no.detail), {}};
        fault.coordinate = {vertex.x, vertex.y};
        fault.index = i;
        if (terrain.points) terrain.points->of_point(fault, i, std::nullopt);
        faults.push_back(std::move(fault));
    }
    if (!faults.empty()) return {FaultKind::Invalid, std::move(faults)};
    return terrain;
}

}  // namespace

Parsed<SystemSettled> reconcile_system(
    SystemSaid said, const TerrainOptions& options,
    const std::function<std::variant<std::string, NoPlace>()>& zone) {
    return Settler(std::move(said), options, zone).settle();
}

void bring_from_metres(Terrain& terrain, const TerrainOptions& options) {
    std::optional<std::string> unit = normalise_unit(options.unit);
    const auto crs = normalise_crs(terrain.crs.empty() ? options.crs : terrain.crs);
    const auto facts = crs ? find_crs(*crs) : std::nullopt;
    if (facts && facts->kind == CrsFacts::Kind::Geographic) return;  // only z is a length
    if (!unit && facts && facts->kind == CrsFacts::Kind::Projected)
        unit = unit_of_length(facts->metres);
    if (!unit && !crs && !terrain.unit_before.empty()) unit = terrain.unit_before;
    if (!unit || unit == "metre") return;
    const double metres = metres_per(*unit);
    for (core::Point3& p : terrain.mesh.vertices)
        p = {p.x / metres, p.y / metres, p.z / metres};
    terrain.unit = *unit;
}

Parsed<Terrain> in_its_system(Terrain terrain, const TerrainOptions& options,
                              const ReadLimits& limits) {
    if (terrain.settled) return terrain;
    SystemSaid said;
    said.named = !terrain.crs.empty();
    said.crs = said.source = terrain.crs;
    TerrainOptions wanted = options;
    // A unit that the bytes name is as good as one that an option names, and is refused as theirs.
    const bool names_unit = terrain.unit_is_said || terrain.unit != "metre";
    if (names_unit && wanted.unit.empty()) {
        wanted.unit = terrain.unit;
    } else if (names_unit && normalise_unit(wanted.unit) != terrain.unit) {
        Fault fault{"CONTRADICTION",
                    "The terrain says that its unit is " + terrain.unit +
                        ", the option unit says another: leave the option out.",
                    {}};
        fault.parameter = "unit";
        return {FaultKind::Invalid, std::move(fault)};
    }
    const bool unit_is_theirs = names_unit && options.unit.empty();
    auto settled = reconcile_system(std::move(said), wanted, [&] {
        const std::string& from = terrain.crs.empty() ? options.crs : terrain.crs;
        return utm_zone_at(normalise_crs(from).value_or(from), centre_of(terrain.mesh));
    });
    if (!settled) {
        for (Fault& fault : settled.faults()) {
            if (fault.parameter == "unit" && unit_is_theirs) {
                fault.parameter.clear();
                fault.pointer = "/unit";
            } else if (fault.parameter.empty() && options.crs.empty()) {
                fault.pointer = "/crs";
            } else if (fault.parameter.empty()) {
                fault.parameter = "crs";
            }
        }
        return {settled.kind(), std::move(settled.faults())};
    }
    terrain.crs = settled->crs;
    terrain.unit = settled->unit;
    terrain.settled = true;
    if (settled->warp_from.empty()) return terrain;
    return moved(std::move(terrain), *settled, limits);
}

}  // namespace tinsmith::api
