// SPDX-License-Identifier: Apache-2.0
// A disk without room, and one that refuses to let a file grow: changes are refused and leave no
// trace, everything else goes on, and with room all is as before.
#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/mount.h>
#include <sys/resource.h>

#include "tests/durability/random_shapes.hpp"
#include "tests/durability/steady_client.hpp"
#include "tests/e2e/program.hpp"

namespace tinsmith::e2e {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

const std::string kJson = "Content-Type: application/json";
const std::string kSession = "/v1/sessions/field";
constexpr int kPosts = 30;
/// The journal's log has some MiB on the fullest disk: this fills it.
constexpr std::size_t kLongNote = 60'000;
/// The journal tries a disk that fails once a second.
constexpr std::chrono::seconds kRecovery{20};

/// A small file system of a test's own, where the system lets us have one.
class SmallDisk {
  public:
    explicit SmallDisk(std::string path) : path_(std::move(path)) {
        std::filesystem::create_directory(path_);
        is_mounted_ = ::mount("tinsmith", path_.c_str(), "tmpfs", 0, "size=48m,mode=0700") == 0;
    }
    ~SmallDisk() {
        if (is_mounted_) ::umount2(path_.c_str(), MNT_DETACH);
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;

    bool is_there() const { return is_mounted_; }

    void fill() const {
        std::ofstream file(path_ + "/other", std::ios::binary);
        const std::string page(4096, 'x');
        while (file.write(page.data(), static_cast<std::streamsize>(page.size())).flush()) {
        }
    }
    void make_room() const { std::filesystem::remove(path_ + "/other"); }

  private:
    std::string path_;
    bool is_mounted_ = false;
};

class FullDisk : public testing::Test {
  protected:
    void start(const std::string& data) {
        server_.emplace(std::vector<std::string>{"--data", data});
        ASSERT_NE(server_->port(), 0) << server_->program().output();
        client_.emplace(server_->port());
    }

    void make_session() {
        ASSERT_EQ(client_->ask("PUT", kSession, {kJson}, grid_text(dice_, kPosts)).status, 201);
        for (int i = 0; i < 20; ++i)
            ASSERT_EQ(edit().status, 200);
    }

    /// A polygon of its own each time, with a property of that length; the request can be sent
    /// again.
    Answer edit(std::size_t note = 0) {
        body_ = R"({"type":"Feature","properties":{"note":")" + std::string(note, 'x') +
                R"("},"geometry":)" +
                polygon_text(ring_text(dice_, dice_.between(5, 25), dice_.between(5, 25), 3, 8)) +
                "}";
        ++keys_;
        return edit_again();
    }

    Answer edit_again() {
        const Answer answer =
            client_->ask("POST", kSession + "/polygons",
                         {kJson, "Idempotency-Key: k" + std::to_string(keys_)}, body_);
        if (answer.status != 200) return answer;
        acknowledged_ = version_in(answer);
        ++polygons_;
        return answer;
    }

    static std::uint64_t version_in(const Answer& answer) {
        return answer.status == 200 ? json::parse(answer.body).value("version", std::uint64_t{0})
                                    : 0;
    }

    std::string mesh() { return client_->ask("GET", kSession + "/mesh.json").body; }

    /// Edits until the disk has no room, first for large ones, then for small ones either. The mesh
    /// before the last refusal.
    std::string edit_until_refused() {
        std::string before = mesh();
        std::size_t note = kLongNote;
        for (int i = 0; i < 3000 && server_->program().is_running(); ++i) {
            const Answer answer = edit(note);
            if (answer.status == 503) {
                const json problem = json::parse(answer.body, nullptr, false);
                EXPECT_NE(problem.value("type", "").find("storage-unavailable"), std::string::npos)
                    << answer.body;
                EXPECT_FALSE(answer.header("retry-after").empty()) << answer.body;
                if (note == 0) return before;
                note = 0;
                continue;
            }
            EXPECT_EQ(answer.status, 200) << answer.body;
            if (answer.status != 200) break;
            before = mesh();
        }
        ADD_FAILURE() << "it never says that the disk is full";
        return before;
    }

    void expect_reads_go_on(const std::string& mesh_before) {
        EXPECT_EQ(mesh(), mesh_before);
        EXPECT_EQ(version_in(client_->ask("GET", kSession)), acknowledged_);
        EXPECT_EQ(client_->ask("GET", "/healthz").status, 200);
        for (const char* path : {"/mesh.glb", "/polygons", "/history", "/elevation?x=4&y=4"})
            EXPECT_EQ(client_->ask("GET", kSession + path).status, 200) << path;
        const Answer ready = client_->ask("GET", "/readyz");
        EXPECT_EQ(ready.status, 503);
        EXPECT_NE(ready.body.find("CHECK_FAILED"), std::string::npos) << ready.body;
    }

    /// Every kind of change, and a session that would be new.
    void expect_changes_refused() {
        const struct {
            std::string method;
            std::string path;
            std::string body;
        } changes[] = {
            {"POST", kSession + "/undo", ""},
            {"POST", kSession + "/edits", R"({"operation":"smooth","polygon":"p1","passes":1})"},
            // The newest one: an old one takes all the later ones to be made again.
            {"DELETE", kSession + "/polygons/p" + std::to_string(polygons_), ""},
            {"POST", kSession + "/fork", ""},
            {"PUT", "/v1/sessions/another", grid_text(dice_, kPosts)},
        };
        for (const auto& [method, path, body] : changes) {
            const Answer answer = client_->ask(
                method, path, body.empty() ? std::vector<std::string>() : std::vector{kJson}, body);
            EXPECT_EQ(answer.status, 503) << method << path << answer.body;
        }
        EXPECT_EQ(client_->ask("GET", "/v1/sessions/another").status, 404);
        EXPECT_EQ(edit_again().status, 503);
    }

    void expect_recovery() {
        const auto deadline = Clock::now() + kRecovery;
        int status = 0;
        while (status != 200 && Clock::now() < deadline) {
            status = client_->ask("GET", "/readyz").status;
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
        EXPECT_EQ(status, 200);
        const std::uint64_t before = acknowledged_;
        const Answer again = edit_again();
        EXPECT_EQ(again.status, 200) << again.body;
        EXPECT_EQ(acknowledged_, before + 1) << "what was refused was not made";
        EXPECT_EQ(edit().status, 200);
    }

    /// Nothing that was acknowledged is lost, whatever the disk has been through.
    void expect_kept_after_a_kill(const std::string& data) {
        const std::string before = mesh();
        const std::string log = server_->program().output();
        EXPECT_NE(log.find("\"event\":\"journal_failed\""), std::string::npos);
        EXPECT_NE(log.find("\"event\":\"journal_recovered\""), std::string::npos);
        server_->program().send_signal(SIGKILL);
        server_->program().wait();
        start(data);
        EXPECT_EQ(version_in(client_->ask("GET", kSession)), acknowledged_);
        EXPECT_EQ(mesh(), before);
        EXPECT_EQ(server_->stop(), "");
    }

    ScratchDirectory folder_;
    Dice dice_{5};
    std::optional<ServerUnderTest> server_;
    std::optional<SteadyClient> client_;
    std::string body_;
    int keys_ = 0;
    std::uint64_t acknowledged_ = 0;
    int polygons_ = 0;  ///< that are in the mesh: p1 and so on
};

TEST_F(FullDisk, RefusesChangesAndRecoversWithRoom) {
    const SmallDisk disk(folder_.file("disk"));
    if (!disk.is_there()) GTEST_SKIP() << "only root may mount a file system";
    const std::string data = folder_.file("disk") + "/data";
    ASSERT_NO_FATAL_FAILURE(start(data));
    ASSERT_NO_FATAL_FAILURE(make_session());
    for (int i = 0; i < 2; ++i) {
        disk.fill();
        const std::string before = edit_until_refused();
        expect_changes_refused();
        expect_reads_go_on(before);
        disk.make_room();
        expect_recovery();
    }
    expect_kept_after_a_kill(data);
}

TEST_F(FullDisk, SoDoesAFileThatMayNotGrow) {
    const std::string data = folder_.file("data");
    ASSERT_NO_FATAL_FAILURE(start(data));
    ASSERT_NO_FATAL_FAILURE(make_session());
    std::uintmax_t largest = 0;
    for (const auto& file : std::filesystem::directory_iterator(data))
        largest = std::max(largest, file.file_size());
    const rlimit limit{largest, RLIM_INFINITY};
    ASSERT_EQ(::prlimit(server_->program().pid(), RLIMIT_FSIZE, &limit, nullptr), 0);
    const std::string before = edit_until_refused();
    expect_changes_refused();
    expect_reads_go_on(before);
    const rlimit none{RLIM_INFINITY, RLIM_INFINITY};
    ASSERT_EQ(::prlimit(server_->program().pid(), RLIMIT_FSIZE, &none, nullptr), 0);
    expect_recovery();
    expect_kept_after_a_kill(data);
}

}  // namespace
}  // namespace tinsmith::e2e
