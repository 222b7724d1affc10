// SPDX-License-Identifier: Apache-2.0
#include "server/metrics/families.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <prometheus/metric_family.h>
#include <prometheus/text_serializer.h>

namespace tinsmith::server {

namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;

void set(ClientMetric& metric, MetricType type, double value) {
    if (type == MetricType::Counter) {
        metric.counter.value = value;
    } else {
        metric.gauge.value = value;
    }
}

MetricFamily family_of(MetricType type, std::string name, std::string help, double value) {
    MetricFamily family{std::move(name), std::move(help), type, {}};
    set(family.metric.emplace_back(), type, value);
    return family;
}

}  // namespace

MetricFamily counter(std::string name, std::string help, double value) {
    return family_of(MetricType::Counter, std::move(name), std::move(help), value);
}

MetricFamily gauge(std::string name, std::string help, double value) {
    return family_of(MetricType::Gauge, std::move(name), std::move(help), value);
}

prometheus::MetricFamily histogram(std::string name, std::string help,
                                   std::span<const double> bounds,
                                   std::span<const std::uint64_t> within, double sum) {
    prometheus::MetricFamily family;
    family.name = std::move(name);
    family.help = std::move(help);
    family.type = prometheus::MetricType::Histogram;
    prometheus::ClientMetric metric;
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < within.size(); ++i) {
        count += within[i];
        const bool is_last = i >= bounds.size();
        prometheus::ClientMetric::Bucket bucket;
        bucket.cumulative_count = count;
        bucket.upper_bound = is_last ? std::numeric_limits<double>::infinity() : bounds[i];
        metric.histogram.bucket.push_back(bucket);
    }
    metric.histogram.sample_count = count;
    metric.histogram.sample_sum = sum;
    family.metric.push_back(std::move(metric));
    return family;
}

void add_series(MetricFamily& family, MetricLabel label, double value) {
    ClientMetric& metric = family.metric.emplace_back();
    metric.label.push_back({std::string(label.first), std::string(label.second)});
    set(metric, family.type, value);
}

void sort(std::vector<MetricFamily>& families) {
    std::sort(families.begin(), families.end(),
              [](const MetricFamily& a, const MetricFamily& b) { return a.name < b.name; });
    for (MetricFamily& family : families) {
        std::sort(family.metric.begin(), family.metric.end(),
                  [](const ClientMetric& a, const ClientMetric& b) { return a.label < b.label; });
    }
}

std::string text_of(const std::vector<MetricFamily>& families) {
    return prometheus::TextSerializer().Serialize(families);
}

}  // namespace tinsmith::server
