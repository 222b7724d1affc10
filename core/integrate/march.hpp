// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/integrate/drift.hpp"
#include "core/integrate/improve.hpp"
#include "core/integrate/options.hpp"
#include "core/integrate/progress.hpp"
#include "core/integrate/report.hpp"
#include "core/integrate/shape.hpp"
#include "core/integrate/way.hpp"
#include "core/mesh/surgery.hpp"
#include "core/mesh/vertex_set.hpp"
#include "core/mesh/walk.hpp"
#include "core/types/error.hpp"

namespace tinsmith::core {

/// What a march counted.
struct MarchTally {
    std::uint64_t segments = 0;
    std::uint64_t crossings = 0;       ///< proper crossings with edges there before the operation
    std::uint64_t self_crossings = 0;  ///< proper crossings with the operation's own constraints
    std::uint64_t edges_swapped = 0;
    double max_plan_deviation = 0.0;
    bool met_mesh = false;
    std::vector<OutsidePart> outside;
    std::vector<Chain> chains;
};

/// An elevation that a path brings to a vertex of its chain.
struct OwnElevation {
    VertexId vertex;
    double z = 0.0;
};

/// Bounds on a march, and how to ask for its end.
struct MarchLimits {
    std::uint64_t max_crossings = UINT64_MAX;
    std::uint64_t max_new_triangles = UINT64_MAX;
    const std::function<bool()>* cancelled = nullptr;
    Progress* progress = nullptr;
};

/// Walks paths through a mesh and leaves each of their segments behind as a chain of constrained
/// edges: the paper's sections 3.2, 3.3 and 3.5.
///
/// At the vertex where it stands, the march finds by exact predicates where the straight way to
/// the segment's end leaves: along an edge, which it marks; or through an edge. An edge inside a
/// facet is swapped out of the way. An edge between facets, or a constraint, is split where the
/// *input* segment crosses it, so that what rounding did to one vertex never adds up.
///
/// Laws, after each segment:
///   1. the mesh is valid (laws 1-5 of `Tin`);
///   2. every vertex of the chain is within the larger of snap and `reach_of_rounding` of the input
///      segment, however often the way was snapped;
///   3. no triangle changed that the segment does not meet, but for swaps inside their facets.
/// Where no mesh of doubles is found that does, the march stops with NotRepresentable; the caller
/// rolls back, and may go another way. Where rounding decided, it says so (`is_delicate`): the laws
/// are then to be checked. It ends: each step is nearer to the segment's end, and a budget on steps
/// stands behind that for the cases in which rounding decides.
class March {
  public:
    /// `drift` is the request's, and knows what earlier shapes of it did. `improver`, where there
    /// is one, swaps at once what can be told at once; it sees the rest by `changed`.
    March(Surgery& surgery, const IntegrateOptions& options, const MarchLimits& limits,
          Drift& drift, Improver* improver);

    /// Begins a path at its first point; `index` is the path's in its shape. The path must live
    /// until `finish`. Costs a location. False: stopped, see `error`.
    bool begin(std::size_t index, const Path& path, const Way& way = kWays[0]);
    /// Integrates the segment from where the march stands to the path's point `to`. Requires: begin
    /// was called, and the point's position differs from the one before. False: stopped, see
    /// `error`.
    bool advance(std::size_t to);
    /// Ends the path: closes what runs outside. False: stopped, see `error`.
    bool finish();

    const MarchTally& tally() const { return tally_; }
    MarchTally& tally() { return tally_; }
    std::optional<Error>& error() { return error_; }
    /// Whether rounding decided somewhere, so that what was done is to be checked.
    bool is_delicate() const { return is_delicate_; }
    /// Vertices whose surroundings changed, but for those where the improver has seen to that; the
    /// caller swaps what it will and clears them. Complete once the path is finished.
    std::vector<VertexId>& changed() {
        exit_ahead_ = {};  // its triangle may be swapped
        return changed_;
    }
    bool has_changed(std::size_t vertices) const { return changed_.size() >= vertices; }
    /// Elevations that the paths bring, in order; the mesh has those of its surface until they are
    /// set.
    const std::vector<OwnElevation>& own_elevations() const { return own_elevations_; }

  private:
    struct Passing;
    // march.cpp
    void set_snap(double snap);
    void set_segment(Point2 start, Point2 end);
    void settle_all();
    bool march_to_end();
    bool march_home();
    bool has_arrived() const;
    double corner_reach() const { return way_.takes_corners ? near_ : snap_; }
    Side first_look() const;
    bool is_as_promised();
    bool follow(const Departure& departure);
    bool cross(Side exit);
    bool reach(VertexId t, bool needs_swaps);
    /// Asked before each step. False: stopped, see `error`.
    bool within_budget() {
        if (covered_ == 0) return look_at_limits();
        --covered_;
        return true;
    }
    bool look_at_limits();
    std::uint64_t ids_left() const;
    bool has_ids();
    bool fail(ErrorCode code, const char* detail);

    // stand.cpp
    VertexId settle(const Location& location, Point2 p);
    std::optional<VertexId> vertex_within_snap(const Location& location, Point2 p) const;
    std::optional<std::pair<Side, Point2>> edge_within_snap(const Location& location,
                                                            Point2 p) const;
    VertexId place(Location location, Point2 p);
    VertexId place_on(Side edge, Point2 p);
    double bend_of(Side edge, Point2 p) const;
    double stray_of(Side edge, Point2 p) const;
    double off_edge(Side edge, Point2 p, double at_origin, double at_destination) const;
    bool bends_unusually(Side edge, Point2 p) const;
    bool can_bend(Side edge, Point2 p) const;
    std::uint32_t deepest_corner(TriangleId t) const;
    void stand_on(VertexId v);
    void step_along(Side edge, VertexId next);
    void log_elevation(double share);
    double share_along(Point2 p) const;
    bool is_on_older_constraint(VertexId v) const;

    // crossing.cpp
    bool cross_facet_edge(Side exit, bool needs_swaps);
    bool comes_from_end_of(Side edge) const;
    bool leave_across(Side edge);
    std::optional<Point2> find_split(Side edge);
    std::optional<Point2> find_split_along(Side edge, Point2 p) const;
    Point2 intersection(Side edge);
    Point2 crossing_of(Point2 low, Point2 high, Point2 a, Point2 b);
    bool can_split(Side edge, Point2 p) const;
    bool is_clear_of_boundary(Side edge, Point2 p) const;
    bool is_near_segment(Point2 p, double distance) const;
    bool is_near_edge(Side edge, Point2 p, double distance) const;
    bool can_absorb(Side edge, double distance) const;
    bool is_cliff(Side edge) const;
    bool absorb(Side edge);
    bool absorb_needle_at(Side edge);
    bool split_beyond(Side entry);
    std::optional<VertexId> end_within(Side edge, double distance) const;
    std::optional<VertexId> end_beside(Side edge);
    bool is_ahead_of(Point2 p, Point2 q) const;
    bool is_ahead_within_snap(VertexId v) const;
    void count_crossing(Side edge);
    void measure(VertexId v);
    bool is_beside_segment(Point2 p) const;

    // stride.cpp
    bool stride(Side& exit);
    void fetch_path() const;
    void fetch(Side side) const;
    void fetch_apex(Side side) const;
    bool is_plain(const Passing& here) const;
    bool find_plain_split(const Passing& here, Point2& p) const;
    bool is_plainly_split(const Passing& here, Point2 p) const;
    Side pass(const Passing& here, Point2 p);
    /// What a plain step leaves to improve.
    struct Seam {
        Side free;                 ///< an edge that may be better swapped, before the step
        bool is_next = false;      ///< that is the next side, not the previous
        bool is_whole = false;     ///< the facet that the step enters was one triangle
        bool is_simple = false;    ///< all is known: no other edge there may swap
        bool covers_open = false;  ///< among them what the last step left open
    };
    Seam seam_of(const Passing& here) const;
    /// Sides of the four triangles around the new vertex, across from it.
    struct Outer {
        Side behind;
        Side behind_too;
        Side other;
        Side entered;
    };
    bool close(const Seam& seam, const Outer& outer);
    bool close_all(const Seam& seam, const Outer& outer);
    void flush_open();

    // landing.cpp
    void land(Side exit);
    VertexId land_beyond(Side exit);
    VertexId split_at_end(TriangleId t);
    void improve_split(TriangleId t);
    bool improves_at_once() const;
    bool lands_in(Side exit) const;

    // connect.cpp
    bool connect(VertexId t);
    bool is_passed(Point2 goal) const;
    bool has_way(VertexId t);
    std::optional<VertexId> collect_corridor(VertexId t);
    Side edge_on_way(double limit) const;
    Side detour(double limit);
    VertexId far_end(Side edge) const;
    bool clear_corridor(VertexId t);

    // outside.cpp
    /// A place where the segment meets the boundary coming from outside.
    struct Entry {
        double along = 0.0;  ///< growing along the segment
        VertexId vertex;     ///< met; or, when `edge` is valid, the first end of the edge crossed
        Side edge;
        bool ends_here = false;  ///< the segment ends on the edge, to within rounding
    };
    bool enter();
    void collect_entries();
    std::optional<Entry> entry_at(VertexId v);
    std::optional<Entry> next_entry();
    bool was_here(VertexId v) const;
    bool enter_by(const Entry& entry);
    Location locate_on_boundary(Point2 p) const;
    void visit_boundary(VertexId v);
    bool enter_other_fan(double distance);
    VertexId vertex_of_other_fan(double distance);
    Location locate_beside(TriangleId t, Point2 p) const;
    bool is_one_with_end(double distance) const;
    void leave_mesh();
    void close_outside();
    double along(Point2 p) const;

    Surgery& surgery_;
    const Tin& tin_;
    const IntegrateOptions& options_;
    const MarchLimits& limits_;
    Drift& drift_;
    Improver* improver_;
    /// What the improver is told of at once is all that can fail: each facet was one triangle when
    /// the request began.
    const bool knows_facets_;
    double reach_of_rounding_;   ///< 4 ulp of the mesh's largest coordinate
    double flat_;                ///< a step of the surface that is none
    double snap_ = 0.0;          ///< of this segment
    double outline_bend_ = 0.0;  ///< how far at most an edge of the outline was bent
    double near_ = 0.0;          ///< what is nearer is one: half of that, or the snap
    MarchTally tally_;
    std::optional<Error> error_;
    std::vector<VertexId> changed_;
    std::vector<OwnElevation> own_elevations_;
    /// Of a side's marks: constrained, locked, inside a facet.
    static constexpr std::uint32_t kNotPlain = 0x1011U;

    const Path* path_ = nullptr;
    Way way_;                   ///< of the path at hand
    bool is_delicate_ = false;  ///< rounding decided somewhere
    std::size_t path_index_ = 0;
    std::size_t from_ = 0;  ///< the input segment's points in the path
    std::size_t to_ = 0;
    VertexId first_;         ///< where the path began; invalid: outside the mesh
    bool may_land_ = false;  ///< on this path, where that is plain
    /// Landings that the caller is to improve around. Along an arc each new vertex may turn the
    /// edges of all before it, and many together turn fewer.
    std::size_t put_off_ = 0;
    Side way_on_;   ///< a side at `at_` near the way on, to look at first; any side is right
    VertexId at_;   ///< where the march stands; invalid: outside the mesh
    Point2 start_;  ///< the input segment
    Point2 end_;
    Point2 ahead_;     ///< where the path goes on from its end
    Side exit_ahead_;  ///< the edge that the way there goes through, if a plain step has seen it
    VertexId open_;    ///< the end of a plain step, all around it improved but for two triangles
    TriangleId open_entered_;
    TriangleId open_other_;
    double length_ = 0.0;
    std::uint64_t steps_ = 0;    ///< of this segment, those that are covered among them
    std::uint64_t covered_ = 0;  ///< so many steps can pass no limit
    std::uint64_t asked_ = 256;  ///< steps since the caller was asked whether to go on
    static constexpr std::uint64_t kMostOfAStep = 16;  ///< triangles, vertices, crossings
    static constexpr unsigned kMaxAbsorbed = 8;
    VertexId absorbed_at_;  ///< where the march last absorbed needles, and how many there
    unsigned absorbed_ = 0;
    static constexpr unsigned kMaxNeedles = 4;
    unsigned beyond_ = 0;          ///< how often the segment's way out of a needle was split first
    std::vector<Point2> outside_;  ///< the stretch outside that is being walked
    VertexSet boundary_visits_;    ///< where this segment met the boundary
    double farthest_visit_ = 0.0;  ///< the last of them along the segment
    std::vector<Entry> entries_;   ///< all that the segment may meet, in order
    std::size_t next_entry_ = 0;   ///< the first that is not yet passed
    bool entries_known_ = false;
    VertexSet detours_;      ///< where this segment took an edge beside it, not across
    VertexSet spent_edges_;  ///< boundary edges that led back to one of those
    /// Edges between at_ and the next vertex, by their ends, for swaps move sides about.
    std::vector<std::pair<VertexId, VertexId>> corridor_;
    std::vector<std::pair<VertexId, VertexId>> waiting_;
};

}  // namespace tinsmith::core
