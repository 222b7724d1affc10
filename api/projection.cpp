// SPDX-License-Identifier: Apache-2.0
// The one file that knows PROJ.
#include "api/projection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include <proj.h>

namespace tinsmith::api {

namespace {

/// How far beyond the area of use of a system positions are still taken, in degrees: terrains lie
/// across the borders of zones.
constexpr double kMargin = 5.0;

struct CloseContext {
    void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
};
using Context = std::unique_ptr<PJ_CONTEXT, CloseContext>;

struct Destroy {
    void operator()(PJ* object) const { proj_destroy(object); }
};
using Object = std::unique_ptr<PJ, Destroy>;

/// Silent, and without a network whatever the environment says.
Context make_context() {
    Context context(proj_context_create());
    proj_log_level(context.get(), PJ_LOG_NONE);
    proj_context_set_enable_network(context.get(), 0);
    return context;
}

/// The area of use in degrees. West may be east of east: across 180.
struct Area {
    double west, south, east, north;
};

/// A system; of a compound one the plan part. Heights are taken for nought where it has them.
struct Found {
    CrsFacts facts;
    Object plan;
    std::optional<Area> area;
    double degrees = 0.0;  ///< one unit of a geographic system; 0: of no other
};

CrsFacts::Kind kind_of(PJ_TYPE type) {
    if (type == PJ_TYPE_PROJECTED_CRS) return CrsFacts::Kind::Projected;
    const bool geographic = type == PJ_TYPE_GEOGRAPHIC_2D_CRS || type == PJ_TYPE_GEOGRAPHIC_3D_CRS;
    return geographic ? CrsFacts::Kind::Geographic : CrsFacts::Kind::Other;
}

void read_unit(PJ_CONTEXT* context, Found& found) {
    const Object axes(proj_crs_get_coordinate_system(context, found.plan.get()));
    if (!axes) return;
    found.facts.has_height =
        found.facts.has_height || proj_cs_get_axis_count(context, axes.get()) > 2;
    double factor = 0.0;
    const char* name = nullptr;
    if (proj_cs_get_axis_info(context, axes.get(), 0, nullptr, nullptr, nullptr, &factor, &name,
                              nullptr, nullptr) == 0)
        return;
    if (name != nullptr) found.facts.unit_name = name;
    if (found.facts.kind == CrsFacts::Kind::Projected) found.facts.metres = factor;
    if (found.facts.kind == CrsFacts::Kind::Geographic)
        found.degrees = factor * 180.0 / std::numbers::pi;
}

std::optional<Found> look_up(PJ_CONTEXT* context, std::string_view code) {
    const auto colon = code.find(':');
    if (colon == std::string_view::npos) return std::nullopt;
    const std::string authority(code.substr(0, colon));
    const std::string number(code.substr(colon + 1));
    Object crs(proj_create_from_database(context, authority.c_str(), number.c_str(),
                                         PJ_CATEGORY_CRS, 0, nullptr));
    if (!crs) return std::nullopt;
    Found found;
    found.facts.code = code;
    if (const char* name = proj_get_name(crs.get())) found.facts.name = name;
    Area area{};
    const char* words = nullptr;
    if (proj_get_area_of_use(context, crs.get(), &area.west, &area.south, &area.east, &area.north,
                             &words) != 0) {
        if (area.west >= -180.0 && area.south >= -90.0) found.area = area;  // else unknown: -1000
        if (words != nullptr) found.facts.area_of_use = words;
    }
    if (proj_get_type(crs.get()) == PJ_TYPE_COMPOUND_CRS) {
        found.facts.has_height = true;
        crs.reset(proj_crs_get_sub_crs(context, crs.get(), 0));
        if (!crs) return std::nullopt;
    }
    found.facts.kind = kind_of(proj_get_type(crs.get()));
    found.plan = std::move(crs);
    read_unit(context, found);
    return found;
}

Object between_plans(PJ_CONTEXT* context, const PJ* from, const PJ* to, bool only_exact_datum) {
    const std::array<const char*, 2> options{only_exact_datum ? "ALLOW_BALLPARK=NO" : nullptr,
                                             nullptr};
    const Object any(proj_create_crs_to_crs_from_pj(context, from, to, nullptr, options.data()));
    if (!any) return nullptr;
    return Object(proj_normalize_for_visualization(context, any.get()));
}

std::string number_text(double value) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.10g", value);
    return text.data();
}

std::string position_text(core::Point2 p) {
    return "(" + number_text(p.x) + ", " + number_text(p.y) + ")";
}

bool within(const Area& area, double longitude, double latitude) {
    if (latitude < area.south - kMargin || latitude > area.north + kMargin) return false;
    double width = area.east - area.west;
    if (width <= 0.0) width += 360.0;
    // How far east of the widened area's western edge, in one turn.
    double east = std::fmod(longitude - (area.west - kMargin), 360.0);
    if (east < 0.0) east += 360.0;
    return width + 2.0 * kMargin >= 360.0 || east <= width + 2.0 * kMargin;
}

}  // namespace

std::string crs_with_name(const CrsFacts& facts) {
    return facts.code + " (" + facts.name + ")";
}

NoPlace unknown_crs(std::string_view code) {
    return {"CRS_UNKNOWN",
            std::string(code) + " is in no list that is known here (PROJ " +
                std::string(proj_info().version) +
                "): check the code. A system is named by authority and code, such as EPSG:32616."};
}

NoPlace unfit_crs(const CrsFacts& facts) {
    return {"CRS_UNFIT", crs_with_name(facts) +
                             " has no plan coordinates, neither projected nor geographic: name the "
                             "system of the x and y."};
}

void silence_proj() {
    // New contexts are copies of the default one.
    proj_log_level(PJ_DEFAULT_CTX, PJ_LOG_NONE);
}

std::optional<CrsFacts> find_crs(std::string_view code) {
    const Context context = make_context();
    auto found = look_up(context.get(), code);
    if (!found) return std::nullopt;
    return std::move(found->facts);
}

struct Transformation::State {
    Context context;  // the last to go
    Found from;
    Found to;
    Object forward;
    Object to_degrees;  ///< longitude and latitude of a position of the target; null: not known
};

Transformation::Transformation(std::unique_ptr<State> state) : state_(std::move(state)) {}
Transformation::Transformation(Transformation&&) noexcept = default;
Transformation& Transformation::operator=(Transformation&&) noexcept = default;
Transformation::~Transformation() = default;

const CrsFacts& Transformation::from() const {
    return state_->from.facts;
}
const CrsFacts& Transformation::to() const {
    return state_->to.facts;
}

std::variant<Transformation, NoPlace> Transformation::between(std::string_view from,
                                                              std::string_view to) {
    auto state = std::make_unique<State>();
    state->context = make_context();
    PJ_CONTEXT* const context = state->context.get();
    for (const auto& [code, place] : {std::pair{from, &state->from}, std::pair{to, &state->to}}) {
        auto found = look_up(context, code);
        if (!found) return unknown_crs(code);
        if (found->facts.kind == CrsFacts::Kind::Other) return unfit_crs(found->facts);
        *place = *std::move(found);
    }
    state->forward = between_plans(context, state->from.plan.get(), state->to.plan.get(), true);
    if (!state->forward) {
        return NoPlace{"CRS_NO_TRANSFORMATION",
                       "No transformation is known from " + crs_with_name(state->from.facts) +
                           " to " + crs_with_name(state->to.facts) +
                           " that minds the datum: transform the coordinates first."};
    }
    if (const auto degrees = look_up(context, "OGC:CRS84"); degrees && state->to.area) {
        state->to_degrees =
            between_plans(context, state->to.plan.get(), degrees->plan.get(), false);
    }
    return Transformation(std::move(state));
}

std::variant<core::Point2, NoPlace> Transformation::operator()(core::Point2 position) const {
    const State& s = *state_;
    if (s.from.degrees > 0.0 && (std::fabs(position.x) * s.from.degrees > 360.0 ||
                                 std::fabs(position.y) * s.from.degrees > 90.0)) {
        return NoPlace{"COORDINATE_OUT_OF_RANGE",
                       position_text(position) + " is no longitude and latitude in " +
                           s.from.facts.unit_name + "s, as " + crs_with_name(s.from.facts) +
                           " has them, in this order: name the system that the numbers are in."};
    }
    const std::string understood =
        s.from.degrees > 0.0 ? "longitude and latitude" : "easting and northing";
    const PJ_COORD there =
        proj_trans(s.forward.get(), PJ_FWD, proj_coord(position.x, position.y, 0.0, HUGE_VAL));
    const core::Point2 out{there.xy.x, there.xy.y};
    if (!std::isfinite(out.x) || !std::isfinite(out.y)) {
        const int why = proj_errno(s.forward.get());
        const char* const words =
            why == 0 ? nullptr : proj_context_errno_string(s.context.get(), why);
        proj_errno_reset(s.forward.get());
        return NoPlace{"CRS_TRANSFORM",
                       position_text(position) + ", as " + understood + " in " +
                           crs_with_name(s.from.facts) + ", has no place in " +
                           crs_with_name(s.to.facts) +
                           (words == nullptr ? "." : ": " + std::string(words) + ".")};
    }
    if (!s.to_degrees) return out;
    const PJ_COORD degrees =
        proj_trans(s.to_degrees.get(), PJ_FWD, proj_coord(out.x, out.y, 0.0, HUGE_VAL));
    if (std::isfinite(degrees.xy.x) && within(*s.to.area, degrees.xy.x, degrees.xy.y)) return out;
    return NoPlace{
        "CRS_OUT_OF_AREA",
        position_text(position) + ", as " + understood + " in " + crs_with_name(s.from.facts) +
            ", is far outside of where " + crs_with_name(s.to.facts) + " is used, longitude " +
            number_text(s.to.area->west) + " to " + number_text(s.to.area->east) + ", latitude " +
            number_text(s.to.area->south) + " to " + number_text(s.to.area->north) +
            ". Are x and y in the order that was understood, and is the system right?"};
}

std::variant<std::string, NoPlace> utm_zone_at(std::string_view geographic, core::Point2 place) {
    core::Point2 degrees = place;
    if (geographic != "EPSG:4326" && geographic != "OGC:CRS84") {
        const auto to_wgs = Transformation::between(geographic, "OGC:CRS84");
        if (const auto* no = std::get_if<NoPlace>(&to_wgs)) return *no;
        const auto there = std::get<Transformation>(to_wgs)(place);
        if (const auto* no = std::get_if<NoPlace>(&there)) return *no;
        degrees = std::get<core::Point2>(there);
    }
    if (!(degrees.y >= -80.0 && degrees.y <= 84.0)) {
        return NoPlace{"PROJECT_POLAR", "The terrain's centre, longitude " +
                                            number_text(degrees.x) + " and latitude " +
                                            number_text(degrees.y) +
                                            ", is in no UTM zone. Name a system, such as project=" +
                                            (degrees.y > 0.0 ? "EPSG:32661." : "EPSG:32761.")};
    }
    double turn = std::fmod(degrees.x + 180.0, 360.0);
    if (turn < 0.0) turn += 360.0;
    const int zone = std::min(static_cast<int>(turn / 6.0), 59) + 1;
    return "EPSG:" + std::to_string((degrees.y < 0.0 ? 32700 : 32600) + zone);
}

}  // namespace tinsmith::api
