// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "api/formats/gltf.hpp"
#include "core/edit/region_edit.hpp"
#include "core/integrate/report.hpp"
#include "server/stopwatch.hpp"

namespace prometheus {
class Collectable;
struct MetricFamily;
}  // namespace prometheus

namespace tinsmith::server {

/// The figures of the requests to one pattern of path.
///
/// Laws: however hostile the requests, there is one series for each known method, or "other", and
/// each known status, or "other", and it is there from the first such request on.
class RouteMeter {
  public:
    struct Series;

    RouteMeter(std::string pattern, std::unique_ptr<Series> series);
    ~RouteMeter();
    RouteMeter(const RouteMeter&) = delete;
    RouteMeter& operator=(const RouteMeter&) = delete;

    const std::string& pattern() const { return pattern_; }

    /// Cost: two table lookups and a histogram's own short lock. What cannot be recorded for want
    /// of memory is not.
    void record(std::string_view method, int status, double seconds) const noexcept;

  private:
    const std::string pattern_;
    const std::unique_ptr<Series> series_;
};

/// What became of a version, as the metric `tinsmith_edits_total` tells it.
enum class EditSort { Polygons, Edit, Locks, Undo, Redo, Removal };

enum class EncodeFormat { Glb, Gltf, Json, Obj, LandXml, Delta };

/// What the process has done since it began, as Prometheus asks for it.
///
/// Laws: recording is noexcept, takes no lock that is held for longer than an addition, and finds
/// its place without searching labels; figures only grow, but for those of the moment; a scrape
/// waits for nobody's edit or encoding.
/// Figures that others keep are asked for when scraped: `add` takes them. The journal's belong
/// there: a `prometheus::Registry` of its own with its counters and histograms is a collectable.
class Metrics {
  public:
    Metrics();
    ~Metrics();
    Metrics(const Metrics&) = delete;
    Metrics& operator=(const Metrics&) = delete;

    /// The meter of a pattern, the same each time; it lives as long as this. Not for every request:
    /// it searches.
    const RouteMeter& route(std::string_view pattern);

    /// One request answered. `route` null: no route did, whatever the path was.
    void request(const RouteMeter* route, std::string_view method, int status, double seconds,
                 std::size_t bytes_in, std::size_t bytes_out) noexcept;

    /// An edit that was made, or tried where `dry_run`: then its time counts and nothing else.
    /// `seconds` is all that the session took; what is no stage of the core is told as "rest".
    void edited(const core::Report& report, double seconds, bool dry_run) noexcept;
    void edited(const core::EditReport& report, double seconds, bool dry_run) noexcept;
    /// Another change, whose stages nobody measures.
    void edited(EditSort sort, double seconds, bool dry_run = false) noexcept;

    void encoded(EncodeFormat format, api::Compression compression, double seconds) noexcept;
    void answer_replayed() noexcept { ++replayed_; }

    /// Asked at each scrape, on the thread that scrapes. It must not wait for long, must not throw,
    /// and keeps its names to itself (tests hold all names to Prometheus' rules).
    void add(std::shared_ptr<const prometheus::Collectable> figures);

    /// Everything, families and series in order of their names.
    std::vector<prometheus::MetricFamily> collect() const;

    /// While it lives, one request more is in flight.
    class InFlight {
      public:
        explicit InFlight(Metrics& metrics) : count_(metrics.in_flight_) { ++count_; }
        ~InFlight() { --count_; }
        InFlight(const InFlight&) = delete;
        InFlight& operator=(const InFlight&) = delete;

      private:
        std::atomic<std::int64_t>& count_;
    };

  private:
    struct Families;
    using Count = std::atomic<std::uint64_t>;

    void observe(std::size_t stage, double seconds) noexcept;

    std::unique_ptr<Families> families_;
    mutable std::mutex mutex_;  ///< guards the two lists below
    std::deque<RouteMeter> routes_;
    std::vector<std::shared_ptr<const prometheus::Collectable>> others_;
    const RouteMeter& none_;  ///< that of no route
    std::atomic<std::int64_t> in_flight_{0};
    Count bytes_in_{0};
    Count bytes_out_{0};
    Count crossings_{0};
    Count vertices_{0};
    Count triangles_{0};
    Count swaps_{0};
    Count replayed_{0};
    Count defects_{0};
    std::array<Count, 6> edits_{};  ///< by EditSort
};

/// One encoding, from its making to its end, whatever comes of it.
class EncodeMeter {
  public:
    EncodeMeter(Metrics& metrics, EncodeFormat format,
                api::Compression compression = api::Compression::None)
        : metrics_(metrics), format_(format), compression_(compression) {}
    ~EncodeMeter() { metrics_.encoded(format_, compression_, watch_.seconds()); }
    EncodeMeter(const EncodeMeter&) = delete;
    EncodeMeter& operator=(const EncodeMeter&) = delete;

  private:
    Metrics& metrics_;
    const EncodeFormat format_;
    const api::Compression compression_;
    const Stopwatch watch_;
};

}  // namespace tinsmith::server
