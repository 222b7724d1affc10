// SPDX-License-Identifier: Apache-2.0
#include "server/metrics/connections.hpp"

#include <utility>
#include <vector>

#include <prometheus/collectable.h>
#include <prometheus/metric_family.h>

#include "server/metrics/families.hpp"

namespace tinsmith::server {

namespace {

class ConnectionFigures final : public prometheus::Collectable {
  public:
    explicit ConnectionFigures(std::shared_ptr<const ConnectionTotals> totals)
        : totals_(std::move(totals)) {}

    std::vector<prometheus::MetricFamily> Collect() const override {
        return {gauge("tinsmith_http_connections", "Open connections, idle ones included.",
                      static_cast<double>(totals_->connections.load())),
                counter("tinsmith_http_connections_sent_away_total",
                        "Connections closed to make room: there were --max-connections, or the "
                        "beginnings of their requests held too much memory.",
                        static_cast<double>(totals_->sent_away.load()))};
    }

  private:
    const std::shared_ptr<const ConnectionTotals> totals_;
};

}  // namespace

std::shared_ptr<const prometheus::Collectable> figures_of(
    std::shared_ptr<const ConnectionTotals> totals) {
    return std::make_shared<ConnectionFigures>(std::move(totals));
}

}  // namespace tinsmith::server
