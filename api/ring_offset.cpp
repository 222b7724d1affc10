// SPDX-License-Identifier: Apache-2.0
#include "api/ring_offset.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <memory>
#include <utility>
#include <vector>

#include <geos_c.h>

#include "core/types/range.hpp"
#include "core/types/ulp.hpp"

namespace tinsmith::api {

namespace {

constexpr int kSegmentsOfAQuarter = 8;
constexpr double kMitreLimit = 2.0;
constexpr int kHalvings = 12;
/// So many parts that vanish are asked what they would bear.
constexpr int kMostAsked = 32;
/// So many ulps of the largest coordinate lines must be apart, to be two in a mesh.
constexpr double kLeastUlps = 256.0;

/// What this thread asks whether to stop; null outside of this file's work.
thread_local const std::function<bool()>* asked_to_stop = nullptr;

bool is_told_to_stop() {
    return asked_to_stop != nullptr && (*asked_to_stop)();
}

struct Stopped : std::exception {
    const char* what() const noexcept override { return "stopped"; }
};

/// The library calls this wherever it may be interrupted, on any thread, for whoever uses it: on a
/// thread that does not work here it does nothing. It throws, as the library itself does there, and
/// the C functions answer null to any exception. GEOS_interruptRequest would not do: its flag is
/// one for all threads, and would end another's work.
void interrupt_if_told() {
    if (is_told_to_stop()) throw Stopped();
}

/// There is one callback for the whole process, and no lock for it: set before there are threads.
[[maybe_unused]] GEOSInterruptCallback* const kCallbackBefore =
    GEOS_interruptRegisterCallback(&interrupt_if_told);

/// While it lives, the library asks `stop` on this thread.
class StopScope {
  public:
    explicit StopScope(const std::function<bool()>& stop) { asked_to_stop = &stop; }
    StopScope(const StopScope&) = delete;
    StopScope& operator=(const StopScope&) = delete;
    ~StopScope() { asked_to_stop = nullptr; }
};

/// The library's state of one call; it says by null pointers what failed.
class Geos {
  public:
    Geos() : handle_(GEOS_init_r()) {}
    Geos(const Geos&) = delete;
    Geos& operator=(const Geos&) = delete;
    ~Geos() { GEOS_finish_r(handle_); }
    GEOSContextHandle_t handle() const { return handle_; }

    struct Destroy {
        GEOSContextHandle_t handle;
        void operator()(GEOSGeometry* geometry) const { GEOSGeom_destroy_r(handle, geometry); }
    };
    using Geometry = std::unique_ptr<GEOSGeometry, Destroy>;
    Geometry own(GEOSGeometry* geometry) const { return Geometry(geometry, Destroy{handle_}); }

    Geometry triangle(const core::Triangle2& t, core::Point2 origin) const {
        std::array<double, 8> corners{};
        for (std::size_t i = 0; i < 4; ++i) {
            corners[2 * i] = t[i % 3].x - origin.x;
            corners[2 * i + 1] = t[i % 3].y - origin.y;
        }
        GEOSCoordSequence* const line =
            GEOSCoordSeq_copyFromBuffer_r(handle_, corners.data(), 4, 0, 0);
        if (line == nullptr) return own(nullptr);
        GEOSGeometry* const ring = GEOSGeom_createLinearRing_r(handle_, line);
        if (ring == nullptr) return own(nullptr);
        return own(GEOSGeom_createPolygon_r(handle_, ring, nullptr, 0));
    }

    /// What the triangles fill; null where that failed.
    Geometry area(std::span<const core::Triangle2> triangles, core::Point2 origin) const {
        std::vector<GEOSGeometry*> parts;
        parts.reserve(triangles.size());
        bool made_all = true;
        for (const core::Triangle2& t : triangles) {
            parts.push_back(triangle(t, origin).release());
            made_all = made_all && parts.back() != nullptr;
        }
        if (!made_all) {
            for (GEOSGeometry* part : parts)
                if (part != nullptr) GEOSGeom_destroy_r(handle_, part);
            return own(nullptr);
        }
        const Geometry all = own(GEOSGeom_createCollection_r(
            handle_, GEOS_GEOMETRYCOLLECTION, parts.data(), static_cast<unsigned>(parts.size())));
        if (!all) return own(nullptr);
        Geometry area = own(GEOSCoverageUnion_r(handle_, all.get()));
        // It gives up where the area touches itself around a place that is none of it.
        return area ? std::move(area) : own(GEOSUnaryUnion_r(handle_, all.get()));
    }

    Geometry buffer(const GEOSGeometry* area, double distance) const {
        const int join = distance < 0.0 ? GEOSBUF_JOIN_MITRE : GEOSBUF_JOIN_ROUND;
        return own(GEOSBufferWithStyle_r(handle_, area, distance, kSegmentsOfAQuarter,
                                         GEOSBUF_CAP_ROUND, join, kMitreLimit));
    }

    std::vector<const GEOSGeometry*> parts_of(const GEOSGeometry* geometry) const {
        std::vector<const GEOSGeometry*> parts;
        const int count = GEOSGetNumGeometries_r(handle_, geometry);
        parts.reserve(static_cast<std::size_t>(std::max(count, 0)));
        for (int i = 0; i < count; ++i)
            parts.push_back(GEOSGetGeometryN_r(handle_, geometry, i));
        return parts;
    }

    /// About the largest distance at which a ring inside the polygon is left. Requires: none is
    /// left at `most`. By halving: the library's own search for the largest circle takes for ever
    /// in slivers. Anything where it is told to stop.
    double bearable(const GEOSGeometry* polygon, double most) const {
        double area = 0.0, length = 0.0;
        GEOSArea_r(handle_, polygon, &area);
        GEOSLength_r(handle_, polygon, &length);
        // A circle of this radius always fits.
        double low = length > 0.0 ? std::min(area / length, most) : 0.0, high = most;
        for (int i = 0; i < kHalvings && !is_told_to_stop(); ++i) {
            const double middle = low + (high - low) / 2.0;
            const Geometry ring = buffer(polygon, -middle);
            const bool is_left = ring && GEOSisEmpty_r(handle_, ring.get()) == 0;
            (is_left ? low : high) = middle;
        }
        return low;
    }

    /// Adds the rings of polygons as paths, moved to the origin. False where that failed.
    bool add_rings(const GEOSGeometry* geometry, core::Point2 origin, core::Shape& out) const {
        for (const GEOSGeometry* part : parts_of(geometry)) {
            if (GEOSGeomTypeId_r(handle_, part) != GEOS_POLYGON) continue;
            if (GEOSisEmpty_r(handle_, part) != 0) continue;
            if (!add_ring(GEOSGetExteriorRing_r(handle_, part), origin, out)) return false;
            const int holes = GEOSGetNumInteriorRings_r(handle_, part);
            for (int i = 0; i < holes; ++i)
                if (!add_ring(GEOSGetInteriorRingN_r(handle_, part, i), origin, out)) return false;
        }
        return true;
    }

  private:
    bool add_ring(const GEOSGeometry* ring, core::Point2 origin, core::Shape& out) const {
        const GEOSCoordSequence* const line =
            ring == nullptr ? nullptr : GEOSGeom_getCoordSeq_r(handle_, ring);
        unsigned count = 0;
        if (line == nullptr || GEOSCoordSeq_getSize_r(handle_, line, &count) == 0) return false;
        core::Path path{{}, true, {}};
        for (unsigned i = 0; i + 1 < count; ++i) {  // without the repeated first
            double x = 0.0, y = 0.0;
            if (GEOSCoordSeq_getXY_r(handle_, line, i, &x, &y) == 0) return false;
            const core::Point2 p{in_range(x + origin.x), in_range(y + origin.y)};
            if (path.points.empty() || path.points.back() != p) path.points.push_back(p);
        }
        while (path.points.size() > 1 && path.points.back() == path.points.front())
            path.points.pop_back();
        if (path.points.size() > 2) out.paths.push_back(std::move(path));
        return true;
    }

    /// What is nearer to nothing than a coordinate may be is nothing.
    static double in_range(double x) { return std::fabs(x) < core::kCoordinateFloor ? 0.0 : x; }

    GEOSContextHandle_t handle_;
};

double largest_coordinate(std::span<const core::Triangle2> area) {
    double largest = 0.0;
    for (const core::Triangle2& t : area)
        for (const core::Point2 p : t)
            largest = std::max({largest, std::fabs(p.x), std::fabs(p.y)});
    return largest;
}

/// Three digits of it, rounded down. Requires: above 0.
double somewhat_less(double x) {
    const double unit = std::pow(10.0, std::floor(std::log10(x)) - 2.0);
    return std::floor(x / unit * (1.0 - 1e-6)) * unit;
}

/// Above 0: outside. `origin` keeps digits where coordinates are large. Whatever failed where it is
/// told to stop.
std::variant<RingOffset, NoRing> draw(std::span<const core::Triangle2> triangles, double distance) {
    using Reason = NoRing::Reason;
    if (triangles.empty()) return NoRing{Reason::Empty, 0.0};
    const double least =
        kLeastUlps * core::ulp(largest_coordinate(triangles) + std::fabs(distance));
    if (std::fabs(distance) < least) return NoRing{Reason::TooSmall, least};
    const core::Point2 origin = triangles.front()[0];
    const Geos geos;
    const Geos::Geometry area = geos.area(triangles, origin);
    RingOffset made;
    if (!area || !geos.add_rings(area.get(), origin, made.border)) return NoRing{};
    if (distance > 0.0) {
        const Geos::Geometry ring = geos.buffer(area.get(), distance);
        if (!ring || !geos.add_rings(ring.get(), origin, made.ring)) return NoRing{};
        return made;
    }
    double bears = HUGE_VAL;
    int asked = 0;
    for (const GEOSGeometry* part : geos.parts_of(area.get())) {
        if (is_told_to_stop()) return NoRing{};
        const Geos::Geometry ring = geos.buffer(part, distance);
        const std::size_t before = made.ring.paths.size();
        if (!ring || !geos.add_rings(ring.get(), origin, made.ring)) return NoRing{};
        if (made.ring.paths.size() == before && asked++ < kMostAsked)
            bears = std::min(bears, geos.bearable(part, -distance));
    }
    if (bears == HUGE_VAL) return made;
    return NoRing{Reason::TooThin, bears > 0.0 ? somewhat_less(bears) : 0.0};
}

std::variant<RingOffset, NoRing> offset(std::span<const core::Triangle2> triangles, double distance,
                                        const std::function<bool()>& stop) {
    // Once told to stop it stays so, whatever is asked later.
    bool is_stopped = false;
    const std::function<bool()> ask = [&] { return is_stopped = is_stopped || (stop && stop()); };
    const StopScope scope(ask);
    auto made = draw(triangles, distance);
    if (is_stopped) return NoRing{NoRing::Reason::Stopped, 0.0};
    return made;
}

}  // namespace

std::variant<RingOffset, NoRing> ring_inside(std::span<const core::Triangle2> area, double distance,
                                             const std::function<bool()>& stop) {
    return offset(area, -distance, stop);
}

std::variant<RingOffset, NoRing> ring_outside(std::span<const core::Triangle2> area,
                                              double distance, const std::function<bool()>& stop) {
    return offset(area, distance, stop);
}

}  // namespace tinsmith::api
