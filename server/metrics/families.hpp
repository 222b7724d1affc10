// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace prometheus {
struct MetricFamily;
}

namespace tinsmith::server {

/// A figure that is known when it is asked for, as Prometheus' library passes it on. Counters only
/// grow and end in "_total"; gauges go both ways.
prometheus::MetricFamily counter(std::string name, std::string help, double value);
prometheus::MetricFamily gauge(std::string name, std::string help, double value);

/// `within` has how many there were up to each bound and not up to the one before, and last those
/// beyond all.
prometheus::MetricFamily histogram(std::string name, std::string help,
                                   std::span<const double> bounds,
                                   std::span<const std::uint64_t> within, double sum);

using MetricLabel = std::pair<std::string_view, std::string_view>;

/// One series more of the family, with that label.
void add_series(prometheus::MetricFamily& family, MetricLabel label, double value);

/// Families and their series in order of name and labels: the library's own order changes.
void sort(std::vector<prometheus::MetricFamily>& families);

/// As the text that Prometheus reads, version 0.0.4.
std::string text_of(const std::vector<prometheus::MetricFamily>& families);
inline constexpr const char* kMetricsMediaType = "text/plain; version=0.0.4; charset=utf-8";

}  // namespace tinsmith::server
