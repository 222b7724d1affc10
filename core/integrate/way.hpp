// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace tinsmith::core {

/// How a path is marched. In exact arithmetic all ways do the same; where rounding decides, one may
/// find a mesh where another finds none.
struct Way {
    bool is_reversed = false;     ///< from the path's last point to its first
    bool settles_first = false;   ///< all points are made vertices before the first segment
    bool takes_corners = true;    ///< a point near a vertex is that vertex
    bool goes_beside = false;     ///< to a vertex beside the one it stands on rather than split
    double nearness = 0.5;        ///< share of the reach of rounding: what is nearer is one
    double edge_nearness = 0.5;   ///< the same for points beside edges
    bool meets_all = false;       ///< goes through vertices near the segment inside facets too
    bool splits_along = true;     ///< splits edges beside the crossing where it must
    bool absorbs_cliffs = false;  ///< takes needles away even where they are steps of the surface
};

/// The first is the one that paths go; the others are for those that cannot go it.
inline constexpr std::array kWays{
    Way{},
    Way{.is_reversed = true},
    Way{.goes_beside = true},
    Way{.is_reversed = true, .goes_beside = true},
    Way{.settles_first = true},
    Way{.is_reversed = true, .settles_first = true},
    Way{.nearness = 0.0625},
    Way{.is_reversed = true, .nearness = 0.0625},
    Way{.edge_nearness = 0.0625},
    Way{.is_reversed = true, .edge_nearness = 0.0625},
    Way{.nearness = 0.0625, .edge_nearness = 0.0625},
    Way{.is_reversed = true, .nearness = 0.0625, .edge_nearness = 0.0625},
    Way{.meets_all = true},
    Way{.is_reversed = true, .meets_all = true},
    Way{.splits_along = false},
    Way{.is_reversed = true, .splits_along = false},
    Way{.settles_first = true, .meets_all = true},
    Way{.is_reversed = true, .settles_first = true, .meets_all = true},
    Way{.takes_corners = false},
    Way{.is_reversed = true, .takes_corners = false},
    Way{.settles_first = true, .goes_beside = true},
    Way{.is_reversed = true, .settles_first = true, .goes_beside = true},
    Way{.absorbs_cliffs = true},
    Way{.is_reversed = true, .absorbs_cliffs = true},
    Way{.settles_first = true, .absorbs_cliffs = true},
    Way{.is_reversed = true, .settles_first = true, .absorbs_cliffs = true},
    Way{.nearness = 0.0625, .edge_nearness = 0.0625, .absorbs_cliffs = true},
    Way{.is_reversed = true, .nearness = 0.0625, .edge_nearness = 0.0625, .absorbs_cliffs = true},
    Way{.meets_all = true, .absorbs_cliffs = true},
    Way{.is_reversed = true, .meets_all = true, .absorbs_cliffs = true},
};

/// Which way each path of a request goes: the first, unless that went wrong before.
class Ways {
  public:
    const Way& of(std::size_t shape, std::size_t path) const;
    /// Another way for the path that went wrong; for all paths where it has gone each. False: all
    /// were tried. The number of tries has a bound that does not depend on the request.
    bool change(std::size_t shape, std::size_t path);

  private:
    struct Changed {
        std::size_t shape;
        std::size_t path;
        std::size_t way;
    };
    static constexpr std::size_t kMaxTries = 64;

    std::vector<Changed> changed_;  ///< few; in order of their first change
    std::size_t common_ = 0;        ///< the way of all other paths
    std::size_t tries_ = 0;
};

}  // namespace tinsmith::core
