// SPDX-License-Identifier: Apache-2.0
#include "server/metrics/metrics.hpp"

#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <prometheus/counter.h>
#include <prometheus/metric_family.h>
#include <prometheus/registry.h>

#include "api/problem.hpp"
#include "server/metrics/families.hpp"
#include "server/metrics/process.hpp"
#include "tests/support/prometheus_text.hpp"

namespace tinsmith::server {
namespace {

using testing_support::PrometheusText;

PrometheusText read(const Metrics& metrics) {
    PrometheusText text(text_of(metrics.collect()));
    EXPECT_EQ(text.faults(), "");
    return text;
}

std::string requests(const std::string& labels) {
    return "tinsmith_http_request_seconds_count{" + labels + "}";
}

TEST(Metrics, CountsRequestsByPatternMethodAndStatus) {
    Metrics metrics;
    const RouteMeter& mesh = metrics.route("/v1/sessions/{id}/mesh");
    EXPECT_EQ(&metrics.route("/v1/sessions/{id}/mesh"), &mesh);
    metrics.request(&mesh, "GET", 200, 0.003, 0, 100);
    metrics.request(&mesh, "GET", 200, 0.004, 0, 100);
    metrics.request(&mesh, "GET", 404, 0.001, 7, 10);
    const PrometheusText text = read(metrics);
    const std::string of = R"(method="GET",route="/v1/sessions/{id}/mesh",status=)";
    EXPECT_EQ(text.value(requests(of + "\"200\"")), 2);
    EXPECT_EQ(text.value(requests(of + "\"404\"")), 1);
    EXPECT_EQ(text.value("tinsmith_http_request_seconds_bucket{" + of + R"("200",le="0.0025"})"),
              0);
    EXPECT_EQ(text.value("tinsmith_http_request_seconds_bucket{" + of + R"("200",le="0.005"})"), 2);
    EXPECT_NEAR(text.value("tinsmith_http_request_seconds_sum{" + of + "\"200\"}"), 0.007, 1e-12);
    EXPECT_EQ(text.value("tinsmith_http_request_bytes_total"), 7);
    EXPECT_EQ(text.value("tinsmith_http_response_bytes_total"), 210);
}

TEST(Metrics, MakesNoSeriesOfWhatClientsInvent) {
    Metrics metrics;
    const RouteMeter& route = metrics.route("/x");
    for (int i = 0; i < 1000; ++i) {
        metrics.request(nullptr, "BREW" + std::to_string(i), 404, 0.0, 0, 0);
        metrics.request(&route, "\"\n} 1", 900 + i, 0.0, 0, 0);
    }
    const PrometheusText text = read(metrics);
    EXPECT_EQ(text.count("tinsmith_http_request_seconds_count"), 2U);
    EXPECT_EQ(text.value(requests(R"(method="other",route="none",status="404")")), 1000);
    EXPECT_EQ(text.value(requests(R"(method="other",route="/x",status="other")")), 1000);
}

TEST(Metrics, HaveASeriesForEachStatusOfAProblem) {
    Metrics metrics;
    for (const api::ProblemType type : api::all_problems())
        metrics.request(nullptr, "GET", api::problem_status(type), 0.0, 0, 0);
    const PrometheusText text = read(metrics);
    for (const api::ProblemType type : api::all_problems()) {
        const std::string status = std::to_string(api::problem_status(type));
        EXPECT_GE(text.value(requests(R"(method="GET",route="none",status=")" + status + "\"")), 1)
            << status;
    }
}

TEST(Metrics, LoseNothingThatManyThreadsRecord) {
    Metrics metrics;
    const RouteMeter& route = metrics.route("/x");
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
        threads.emplace_back([&] {
            for (int i = 0; i < 1000; ++i) {
                const Metrics::InFlight one(metrics);
                metrics.request(&route, "GET", 200 + i % 2, 0.001, 1, 2);
                metrics.answer_replayed();
                if (i % 100 != 0) continue;
                EXPECT_EQ(PrometheusText(text_of(metrics.collect())).faults(), "");
            }
        });
    }
    for (std::thread& thread : threads)
        thread.join();
    const PrometheusText text = read(metrics);
    EXPECT_EQ(text.value(requests(R"(method="GET",route="/x",status="200")")), 2000);
    EXPECT_EQ(text.value(requests(R"(method="GET",route="/x",status="201")")), 2000);
    EXPECT_EQ(text.value("tinsmith_http_request_bytes_total"), 4000);
    EXPECT_EQ(text.value("tinsmith_answers_replayed_total"), 4000);
    EXPECT_EQ(text.value("tinsmith_http_requests_in_flight"), 0);
}

TEST(Metrics, TellWhatEditsDidAndHowLongEachStageTook) {
    Metrics metrics;
    core::Report report;
    report.shapes.resize(2);
    report.shapes[0].crossings = 5;
    report.shapes[0].vertices_added = 7;
    report.shapes[1].triangles_added = 11;
    report.shapes[1].edges_swapped = 13;
    report.time_ms = {1.0, 20.0, 3.0};
    metrics.edited(report, 0.1, false);
    metrics.edited(report, 0.1, true);
    core::EditReport edit;
    edit.vertices_added = 1;
    edit.apply_ms = 50.0;
    metrics.edited(edit, 0.05, false);
    metrics.edited(EditSort::Undo, 0.5);
    const PrometheusText text = read(metrics);
    EXPECT_EQ(text.value("tinsmith_crossings_total"), 5);
    EXPECT_EQ(text.value("tinsmith_vertices_added_total"), 8);
    EXPECT_EQ(text.value("tinsmith_triangles_added_total"), 11);
    EXPECT_EQ(text.value("tinsmith_edges_swapped_total"), 13);
    EXPECT_EQ(text.value(R"(tinsmith_edits_total{sort="polygons"})"), 1) << "dry runs make none";
    EXPECT_EQ(text.value(R"(tinsmith_edits_total{sort="edit"})"), 1);
    EXPECT_EQ(text.value(R"(tinsmith_edits_total{sort="undo"})"), 1);
    const auto sum = [&text](const std::string& stage) {
        return text.value("tinsmith_edit_stage_seconds_sum{stage=\"" + stage + "\"}");
    };
    EXPECT_NEAR(sum("locate"), 0.002, 1e-9);
    EXPECT_NEAR(sum("integrate"), 0.040, 1e-9);
    EXPECT_NEAR(sum("improve"), 0.006, 1e-9);
    EXPECT_NEAR(sum("apply"), 0.050, 1e-9);
    EXPECT_NEAR(sum("rerun"), 0.5, 1e-9);
    EXPECT_NEAR(sum("rest"), 2 * 0.076, 1e-9);
}

TEST(Metrics, TellEncodingsByFormat) {
    Metrics metrics;
    { const EncodeMeter meter(metrics, EncodeFormat::Glb, api::Compression::Meshopt); }
    { const EncodeMeter meter(metrics, EncodeFormat::Obj); }
    const PrometheusText text = read(metrics);
    const auto count = [&text](const char* compression, const char* format) {
        return text.value(std::string("tinsmith_encode_seconds_count{compression=\"") +
                          compression + "\",format=\"" + format + "\"}");
    };
    EXPECT_EQ(count("meshopt", "glb"), 1);
    EXPECT_EQ(count("draco", "glb"), 0);
    EXPECT_EQ(count("none", "obj"), 1);
}

TEST(Metrics, TakeFiguresThatOthersKeep) {
    Metrics metrics;
    const auto journal = std::make_shared<prometheus::Registry>();
    prometheus::BuildCounter()
        .Name("tinsmith_test_commits_total")
        .Help("Of a part of the program with figures of its own.")
        .Register(*journal)
        .Add({})
        .Increment(3);
    metrics.add(journal);
    EXPECT_EQ(read(metrics).value("tinsmith_test_commits_total"), 3);
}

TEST(ProcessFigures, AreThoseOfThisProcess) {
    const ProcessFigures found = process_figures();
    const auto now =
        std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
    EXPECT_LE(found.start_seconds, now + 2.0);
    EXPECT_GT(found.start_seconds, now - 3600.0);
    EXPECT_GT(found.resident_bytes, std::uint64_t{1} << 20);
    EXPECT_GE(found.virtual_bytes, found.resident_bytes);
    EXPECT_GE(found.open_files, 3U);
    EXPECT_GE(found.max_files, found.open_files);
    EXPECT_GE(found.cpu_seconds, 0.0);
}

}  // namespace
}  // namespace tinsmith::server
