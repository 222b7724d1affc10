// SPDX-License-Identifier: Apache-2.0
#include "server/metrics/families.hpp"

#include <algorithm>

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
