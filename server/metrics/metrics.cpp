// SPDX-License-Identifier: Apache-2.0
#include "server/metrics/metrics.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include <prometheus/collectable.h>
#include <prometheus/histogram.h>
#include <prometheus/metric_family.h>
#include <prometheus/registry.h>

#include "server/metrics/families.hpp"

namespace tinsmith::server {

namespace {

using HistogramFamily = prometheus::Family<prometheus::Histogram>;
using Buckets = prometheus::Histogram::BucketBoundaries;
using prometheus::MetricFamily;

constexpr std::array<std::string_view, 8> kMethods{"GET",   "HEAD",   "POST",    "PUT",
                                                   "PATCH", "DELETE", "OPTIONS", "other"};
/// What the server and the library below it answer with.
constexpr std::array kStatuses{200, 201, 202, 204, 304, 400, 401, 403, 404, 405,
                               406, 408, 409, 410, 411, 412, 413, 414, 415, 416,
                               417, 422, 428, 429, 431, 500, 501, 503, 505, 507};
constexpr std::size_t kOther = kStatuses.size();
constexpr const char* kNoRoute = "none";

/// In seconds.
const Buckets kRequestBuckets{0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025,
                              0.05,   0.1,   0.25,   1.0,   5.0,  30.0};
const Buckets kWorkBuckets{0.0001, 0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025,
                           0.05,   0.1,    0.25,  1.0,    5.0,   30.0};

enum Stage : std::size_t { Locate, Integrate, Improve, Apply, Rerun, Lock, Rest };
constexpr std::array<const char*, 7> kStages{"locate", "integrate", "improve", "apply",
                                             "rerun",  "lock",      "rest"};
/// In the order of EditSort.
constexpr std::array<const char*, 6> kSorts{"polygons", "edit", "locks", "undo", "redo", "removal"};
/// In the orders of EncodeFormat and api::Compression.
constexpr std::array<const char*, 6> kFormats{"glb", "gltf", "json", "obj", "landxml", "delta"};
constexpr std::array<const char*, 3> kCompressions{"draco", "meshopt", "none"};

std::size_t index_of_method(std::string_view method) {
    const auto found = std::find(kMethods.begin(), kMethods.end() - 1, method);
    return static_cast<std::size_t>(found - kMethods.begin());
}

std::size_t index_of_status(int status) {
    const auto found = std::lower_bound(kStatuses.begin(), kStatuses.end(), status);
    return found != kStatuses.end() && *found == status
               ? static_cast<std::size_t>(found - kStatuses.begin())
               : kOther;
}

constexpr double kMilli = 1e-3;

}  // namespace

struct RouteMeter::Series {
    Series(HistogramFamily& of, std::string_view pattern) : family(of), route(pattern) {}

    HistogramFamily& family;
    const std::string route;
    /// Null: not asked for yet. What the family gives stays where it is.
    std::array<std::array<std::atomic<prometheus::Histogram*>, kOther + 1>, kMethods.size()>
        places{};

    prometheus::Histogram& at(std::size_t method, std::size_t status) {
        auto& place = places[method][status];
        if (auto* made = place.load(std::memory_order_acquire)) return *made;
        const std::string code = status == kOther ? "other" : std::to_string(kStatuses[status]);
        // Two threads that come here together are given the same one.
        prometheus::Histogram& fresh = family.Add(
            {{"method", std::string(kMethods[method])}, {"route", route}, {"status", code}},
            kRequestBuckets);
        place.store(&fresh, std::memory_order_release);
        return fresh;
    }
};

RouteMeter::RouteMeter(std::string pattern, std::unique_ptr<Series> series)
    : pattern_(std::move(pattern)), series_(std::move(series)) {}

RouteMeter::~RouteMeter() = default;

void RouteMeter::record(std::string_view method, int status, double seconds) const noexcept {
    try {
        series_->at(index_of_method(method), index_of_status(status)).Observe(seconds);
    } catch (const std::exception&) {
        // Want of memory: the request is answered all the same.
    }
}

struct Metrics::Families {
    Families() {
        for (std::size_t i = 0; i < kStages.size(); ++i)
            stages[i] = &stage_family.Add({{"stage", kStages[i]}}, kWorkBuckets);
        for (std::size_t i = 0; i < kFormats.size(); ++i) {
            const bool has_choice = i <= static_cast<std::size_t>(EncodeFormat::Gltf);
            for (std::size_t j = 0; j < kCompressions.size(); ++j) {
                const char* compression = has_choice ? kCompressions[j] : "none";
                encodings[i][j] = &encode_family.Add(
                    {{"format", kFormats[i]}, {"compression", compression}}, kWorkBuckets);
            }
        }
    }

    prometheus::Registry registry;
    HistogramFamily& requests =
        prometheus::BuildHistogram()
            .Name("tinsmith_http_request_seconds")
            .Help(
                "Time from the end of a request's head to its answer being ready, by the "
                "pattern of its path.")
            .Register(registry);
    HistogramFamily& stage_family =
        prometheus::BuildHistogram()
            .Name("tinsmith_edit_stage_seconds")
            .Help(
                "Time of edits by stage, dry runs included; rest: waiting for the session, and "
                "keeping what was done.")
            .Register(registry);
    HistogramFamily& encode_family = prometheus::BuildHistogram()
                                         .Name("tinsmith_encode_seconds")
                                         .Help("Time of making a mesh or a delta into bytes.")
                                         .Register(registry);
    std::array<prometheus::Histogram*, kStages.size()> stages{};
    std::array<std::array<prometheus::Histogram*, kCompressions.size()>, kFormats.size()>
        encodings{};
};

Metrics::Metrics() : families_(std::make_unique<Families>()), none_(route(kNoRoute)) {}

Metrics::~Metrics() = default;

const RouteMeter& Metrics::route(std::string_view pattern) {
    const std::lock_guard lock(mutex_);
    for (const RouteMeter& meter : routes_)
        if (meter.pattern() == pattern) return meter;
    return routes_.emplace_back(std::string(pattern),
                                std::make_unique<RouteMeter::Series>(families_->requests, pattern));
}

void Metrics::request(const RouteMeter* route, std::string_view method, int status, double seconds,
                      std::size_t bytes_in, std::size_t bytes_out) noexcept {
    (route != nullptr ? *route : none_).record(method, status, seconds);
    if (status == 500) ++defects_;
    bytes_in_.fetch_add(bytes_in, std::memory_order_relaxed);
    bytes_out_.fetch_add(bytes_out, std::memory_order_relaxed);
}

void Metrics::observe(std::size_t stage, double seconds) noexcept {
    try {
        families_->stages[stage]->Observe(std::max(0.0, seconds));
    } catch (const std::exception&) {
        // A lock that cannot be taken: the edit is made all the same.
    }
}

void Metrics::edited(const core::Report& report, double seconds, bool dry_run) noexcept {
    const core::StageTimes& ms = report.time_ms;
    observe(Locate, ms.locate * kMilli);
    observe(Integrate, ms.integrate * kMilli);
    observe(Improve, ms.improve * kMilli);
    observe(Rest, seconds - (ms.locate + ms.integrate + ms.improve) * kMilli);
    if (dry_run) return;
    ++edits_[static_cast<std::size_t>(EditSort::Polygons)];
    for (const core::ShapeReport& shape : report.shapes) {
        crossings_ += shape.crossings;
        vertices_ += shape.vertices_added;
        triangles_ += shape.triangles_added;
        swaps_ += shape.edges_swapped;
    }
}

void Metrics::edited(const core::EditReport& report, double seconds, bool dry_run) noexcept {
    const core::StageTimes& ms = report.time_ms;
    observe(Locate, ms.locate * kMilli);
    observe(Integrate, ms.integrate * kMilli);
    observe(Improve, ms.improve * kMilli);
    observe(Apply, report.apply_ms * kMilli);
    observe(Rest, seconds - (ms.locate + ms.integrate + ms.improve + report.apply_ms) * kMilli);
    if (dry_run) return;
    ++edits_[static_cast<std::size_t>(EditSort::Edit)];
    vertices_ += report.vertices_added;
    triangles_ += report.triangles_added;
}

void Metrics::edited(EditSort sort, double seconds, bool dry_run) noexcept {
    observe(sort == EditSort::Locks ? Lock : Rerun, seconds);
    if (!dry_run) ++edits_[static_cast<std::size_t>(sort)];
}

void Metrics::encoded(EncodeFormat format, api::Compression compression, double seconds) noexcept {
    try {
        families_
            ->encodings[static_cast<std::size_t>(format)][static_cast<std::size_t>(compression)]
            ->Observe(seconds);
    } catch (const std::exception&) {
        // As above.
    }
}

void Metrics::add(std::shared_ptr<const prometheus::Collectable> figures) {
    const std::lock_guard lock(mutex_);
    others_.push_back(std::move(figures));
}

std::vector<MetricFamily> Metrics::collect() const {
    std::vector<MetricFamily> all = families_->registry.Collect();
    const auto count = [&all](const char* name, const char* help, const Count& value) {
        all.push_back(counter(name, help, static_cast<double>(value.load())));
    };
    count("tinsmith_http_request_bytes_total", "Bytes of requests' bodies.", bytes_in_);
    count("tinsmith_http_response_bytes_total", "Bytes of answers' bodies, as they were sent.",
          bytes_out_);
    count("tinsmith_crossings_total", "Edges of meshes that polygons crossed.", crossings_);
    count("tinsmith_vertices_added_total", "Vertices that edits added.", vertices_);
    count("tinsmith_triangles_added_total", "Triangles that edits added.", triangles_);
    count("tinsmith_edges_swapped_total", "Edges that edits swapped.", swaps_);
    count("tinsmith_defects_total",
          "Requests that met a defect of the server: their series by route begin with the first.",
          defects_);
    count("tinsmith_answers_replayed_total",
          "Retries by Idempotency-Key that were given the first answer again.", replayed_);
    all.push_back(gauge("tinsmith_http_requests_in_flight",
                        "Requests that have been read and are being answered, the scrape itself "
                        "included.",
                        static_cast<double>(in_flight_.load())));
    MetricFamily edits = counter("tinsmith_edits_total", "Versions made, by what made them.", 0.0);
    edits.metric.clear();
    for (std::size_t i = 0; i < kSorts.size(); ++i)
        add_series(edits, {"sort", kSorts[i]}, static_cast<double>(edits_[i].load()));
    all.push_back(std::move(edits));
    std::vector<std::shared_ptr<const prometheus::Collectable>> others;
    {
        const std::lock_guard lock(mutex_);
        others = others_;
    }
    for (const auto& figures : others) {
        for (MetricFamily& family : figures->Collect())
            all.push_back(std::move(family));
    }
    sort(all);
    return all;
}

}  // namespace tinsmith::server
