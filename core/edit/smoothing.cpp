// SPDX-License-Identifier: Apache-2.0
#include "core/edit/smoothing.hpp"

#include <algorithm>
#include <numeric>

#include "core/integrate/distance.hpp"
#include "core/mesh/walk.hpp"

namespace tinsmith::core {

namespace {

/// An end of an edge at a vertex that moves.
struct Neighbour {
    std::size_t moving = SIZE_MAX;  ///< its place among those that move
    double z = 0.0;                 ///< where it does not
    double weight = 0.0;
};

class Smoothing {
  public:
    Smoothing(const Tin& tin, std::span<const Moving> moving) : tin_(tin), moving_(moving) {
        now_.reserve(moving.size());
        for (const Moving& each : moving)
            now_.push_back(tin.vertex(each.vertex).z);
        find_neighbours();
        next_ = now_;
    }

    void pass() {
        for (std::size_t i = 0; i < moving_.size(); ++i) {
            if (begins_[i] == begins_[i + 1]) continue;  // another's, at its place
            double pull = 0.0, weights = 0.0;
            for (std::size_t n = begins_[i]; n < begins_[i + 1]; ++n) {
                const auto& [other, z, weight] = neighbours_[n];
                pull += weight * ((other == SIZE_MAX ? z : now_[other]) - now_[i]);
                weights += weight;
            }
            next_[i] = now_[i] + pull / weights / 2.0;
        }
        now_.swap(next_);
    }

    std::vector<VertexMove> moves() const {
        std::vector<VertexMove> moves;
        moves.reserve(moving_.size());
        for (const Moving& each : moving_)
            moves.push_back({each.vertex, now_[place_of(each.leader)]});
        return moves;
    }

  private:
    std::size_t place_of(VertexId v) const {
        const auto found = std::ranges::lower_bound(moving_, v, {}, &Moving::vertex);
        const bool moves = found != moving_.end() && found->vertex == v;
        return moves ? static_cast<std::size_t>(found - moving_.begin()) : SIZE_MAX;
    }

    /// Counts them first, so that all lie in one array: a list each takes twice the memory.
    void find_neighbours() {
        begins_.assign(moving_.size() + 1, 0);
        for (const Moving& each : moving_) {
            std::size_t& count = begins_[place_of(each.leader) + 1];
            for_each_side_at(tin_, each.vertex, [&count](Side) { ++count; });
        }
        std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
        neighbours_.resize(begins_.back());
        std::vector<std::size_t> ends(begins_.begin(), begins_.end() - 1);
        for (const Moving& each : moving_)
            add_neighbours(each.vertex, ends[place_of(each.leader)]);
    }

    void add_neighbours(VertexId v, std::size_t& end) {
        for_each_side_at(tin_, v, [&](Side side) {
            const VertexId from = tin_.origin(side);
            const VertexId other = from == v ? tin_.destination(side) : from;
            const std::size_t place = place_of(other);
            neighbours_[end++] = {place == SIZE_MAX ? SIZE_MAX : place_of(moving_[place].leader),
                                  tin_.vertex(other).z,
                                  1.0 / distance_between(tin_.plan(v), tin_.plan(other))};
        });
    }

    const Tin& tin_;
    std::span<const Moving> moving_;
    std::vector<Neighbour> neighbours_;  ///< of leaders, in their order; of others none
    std::vector<std::size_t> begins_;    ///< of each one's among these, and the end of the last's
    std::vector<double> now_;
    std::vector<double> next_;
};

}  // namespace

std::optional<std::vector<VertexMove>> smoothed(const Tin& tin, std::span<const Moving> moving,
                                                std::uint32_t passes,
                                                const std::function<bool()>& cancelled,
                                                const std::function<void(double)>& progress) {
    Smoothing smoothing(tin, moving);
    for (std::uint32_t i = 0; i < passes; ++i) {
        if (cancelled && cancelled()) return std::nullopt;
        smoothing.pass();
        if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(passes));
    }
    return smoothing.moves();
}

}  // namespace tinsmith::core
