// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <new>
#include <thread>

#include <gtest/gtest.h>

#include "core/mesh/build.hpp"
#include "server/session.hpp"
#include "tests/support/random_input.hpp"
#include "tests/support/same_tin.hpp"

namespace tinsmith::server {
namespace {

using test::MeshKind;
using test::Random;
using test::ShapeKind;

core::Tin square() {
    core::MeshData data;
    data.vertices = {{0, 0, 0}, {10, 0, 1}, {10, 10, 2}, {0, 10, 3}};
    data.triangles = {{0, 1, 2}, {0, 2, 3}};
    return std::move(core::build_tin(data).value());
}

core::Shape ring(double low, double high) {
    return {{{{{low, low}, {high, low}, {high, high}, {low, high}}, true}}};
}

PolygonEdit edit_of(std::vector<core::Shape> shapes) {
    PolygonEdit edit;
    edit.origins.resize(shapes.size());
    edit.shapes = std::move(shapes);
    return edit;
}

Session make_session(HistoryLimits limits = {}) {
    return Session({"s", "b", "Square", "", "metre"}, square(), limits);
}

std::uint64_t version_of(const ChangeOutcome& outcome) {
    return std::get<ChangeResult>(outcome).change.view.version;
}

TEST(SessionHistory, UndoesAndRedoesBitForBit) {
    Session s = make_session();
    const core::Tin before = s.copy_tin();
    s.integrate(edit_of({ring(2, 4)}));
    const core::Tin after = s.copy_tin();
    EXPECT_EQ(version_of(s.undo({})), 3U);
    EXPECT_TRUE(test::same_tin(s.copy_tin(), before));
    EXPECT_EQ(s.view().polygons, 0U);
    EXPECT_EQ(version_of(s.redo({})), 4U);
    EXPECT_TRUE(test::same_tin(s.copy_tin(), after));
    EXPECT_EQ(s.draped("p1").polygons.size(), 1U);
    EXPECT_TRUE(std::holds_alternative<NothingToDo>(s.redo({})));
    s.undo({});
    EXPECT_TRUE(std::holds_alternative<NothingToDo>(s.undo({})));
    EXPECT_EQ(s.view().version, 5U) << "what does nothing makes no version";
}

TEST(SessionHistory, ANewEditDropsWhatCouldBeRedone) {
    Session s = make_session();
    s.integrate(edit_of({ring(2, 4)}));
    s.undo({});
    const auto made = s.integrate(edit_of({ring(5, 7)}));
    EXPECT_EQ(std::get<PolygonResult>(made).polygon_ids, std::vector<std::string>{"p2"});
    EXPECT_TRUE(std::holds_alternative<NothingToDo>(s.redo({})));
}

TEST(SessionHistory, ARefusedEditKeepsWhatCanBeRedone) {
    Session s = make_session();
    s.integrate(edit_of({ring(2, 4)}));
    s.undo({});
    EXPECT_TRUE(std::holds_alternative<core::Errors>(s.integrate(edit_of({ring(20, 30)}))));
    EXPECT_EQ(s.history().redo, 2U);
    EXPECT_EQ(version_of(s.redo({})), 4U);
}

TEST(SessionHistory, TakesAPolygonOutOfTheMiddle) {
    Session s = make_session();
    s.integrate(edit_of({ring(2, 6)}));
    s.integrate(edit_of({ring(3, 7), ring(1, 4)}));
    s.integrate(edit_of({ring(5, 9)}));
    const core::Tin full = s.copy_tin();
    EXPECT_EQ(version_of(s.remove_polygon("p2", false, {})), 5U);
    Session fresh = make_session();
    fresh.integrate(edit_of({ring(2, 6)}));
    fresh.integrate(edit_of({ring(1, 4)}));
    fresh.integrate(edit_of({ring(5, 9)}));
    EXPECT_TRUE(test::same_tin(s.copy_tin(), fresh.copy_tin()));
    EXPECT_TRUE(s.draped("p2").polygons.empty());
    EXPECT_EQ(s.draped("p3").polygons.size(), 1U);
    EXPECT_TRUE(std::holds_alternative<NoSuchPolygon>(s.remove_polygon("p2", false, {})));
    s.undo({});
    EXPECT_TRUE(test::same_tin(s.copy_tin(), full));
    EXPECT_EQ(s.draped("p2").polygons.size(), 1U);
    s.redo({});
    EXPECT_TRUE(test::same_tin(s.copy_tin(), fresh.copy_tin()));
}

TEST(SessionHistory, ARemovalThatCannotBeReplayedChangesNothing) {
    Session s = make_session();
    s.integrate(edit_of({ring(2, 6), ring(20, 30)}));  // p2 is outside: skipped, beside p1
    s.integrate(edit_of({ring(3, 7)}));
    const core::Tin before = s.copy_tin();
    const auto outcome = s.remove_polygon("p1", false, {});
    ASSERT_TRUE(std::holds_alternative<ReplayFailure>(outcome));
    EXPECT_EQ(std::get<ReplayFailure>(outcome).version, 2U);
    EXPECT_EQ(s.view().version, 3U);
    EXPECT_EQ(s.view().polygons, 3U);
    EXPECT_TRUE(test::same_tin(s.copy_tin(), before));
    EXPECT_EQ(s.history().undo, 3U);
}

TEST(SessionHistory, WorkThatIsStoppedChangesNothing) {
    Session s = make_session();
    s.integrate(edit_of({ring(2, 6)}));
    s.integrate(edit_of({ring(3, 7)}));
    ChangeRequest stopped;
    stopped.limits.cancelled = [] { return true; };
    const core::Tin before = s.copy_tin();
    EXPECT_TRUE(std::holds_alternative<ReplayFailure>(s.remove_polygon("p1", false, stopped)));
    EXPECT_TRUE(test::same_tin(s.copy_tin(), before));
    s.undo(stopped);  // runs nothing
    EXPECT_TRUE(std::holds_alternative<ReplayFailure>(s.redo(stopped)));
    EXPECT_EQ(s.view().version, 4U);
    EXPECT_EQ(version_of(s.redo({})), 5U);
    EXPECT_TRUE(test::same_tin(s.copy_tin(), before));
}

TEST(SessionHistory, AnExceptionInTheWorkChangesNothing) {
    Session s = make_session();
    s.integrate(edit_of({ring(2, 6)}));
    s.integrate(edit_of({ring(3, 7)}));
    s.integrate(edit_of({ring(4, 8)}));
    s.undo({});
    const core::Tin before = s.copy_tin();
    const auto no_memory = []() -> bool { throw std::bad_alloc(); };
    ChangeRequest fails;
    fails.limits.cancelled = no_memory;
    PolygonEdit edit = edit_of({ring(1, 9)});
    edit.options.cancelled = no_memory;
    EXPECT_THROW(s.integrate(std::move(edit)), std::bad_alloc);
    EXPECT_THROW(s.redo(fails), std::bad_alloc);
    EXPECT_THROW(s.remove_polygon("p1", false, fails), std::bad_alloc);
    EXPECT_TRUE(test::same_tin(s.copy_tin(), before));
    EXPECT_EQ(s.view().version, 5U);
    EXPECT_EQ(s.view().polygons, 2U);
    EXPECT_EQ(s.history().undo, 3U);
    EXPECT_EQ(s.history().redo, 4U);
    EXPECT_EQ(s.history().changes.size(), 5U);
}

TEST(SessionHistory, HonoursTheExpectedVersion) {
    Session s = make_session();
    s.integrate(edit_of({ring(2, 4)}));
    ChangeRequest late;
    late.expected_version = 1;
    EXPECT_TRUE(std::holds_alternative<VersionMismatch>(s.undo(late)));
    EXPECT_TRUE(std::holds_alternative<VersionMismatch>(s.redo(late)));
    EXPECT_TRUE(std::holds_alternative<VersionMismatch>(s.remove_polygon("p1", false, late)));
    EXPECT_EQ(s.view().version, 2U);
}

TEST(SessionHistory, IsBounded) {
    Session s = make_session({3, std::size_t{1} << 30});
    for (int i = 0; i < 6; ++i)
        s.integrate(edit_of({ring(1 + i, 3.5 + i)}));
    EXPECT_EQ(s.view().polygons, 6U) << "those of the base stay";
    EXPECT_EQ(s.draped("p1").polygons.size(), 1U);
    EXPECT_TRUE(std::holds_alternative<PolygonSettled>(s.remove_polygon("p3", false, {})));
    EXPECT_EQ(s.history().changes.size(), 4U);
    EXPECT_EQ(std::get<VersionGone>(s.change_at(3)).oldest, 4U);
    EXPECT_EQ(std::get<VersionGone>(s.delta_since(3)).oldest, 4U);
    for (int i = 0; i < 3; ++i)
        EXPECT_TRUE(std::holds_alternative<ChangeResult>(s.undo({})));
    EXPECT_TRUE(std::holds_alternative<NothingToDo>(s.undo({})));
    Session fresh = make_session();
    for (int i = 0; i < 3; ++i)
        fresh.integrate(edit_of({ring(1 + i, 3.5 + i)}));
    EXPECT_TRUE(test::same_tin(s.copy_tin(), fresh.copy_tin()));
}

TEST(SessionHistory, IsBoundedInBytesButForTheNewestEdit) {
    Session s = make_session({1000, 1});
    for (int i = 0; i < 4; ++i)
        s.integrate(edit_of({ring(1 + i, 3.5 + i)}));
    EXPECT_TRUE(std::holds_alternative<ChangeResult>(s.undo({})));
    EXPECT_TRUE(std::holds_alternative<NothingToDo>(s.undo({})));
    EXPECT_TRUE(std::holds_alternative<ChangeResult>(s.redo({})));
}

TEST(SessionHistory, GoesWithAFork) {
    Session s = make_session();
    s.integrate(edit_of({ring(2, 4)}));
    s.integrate(edit_of({ring(3, 5)}));
    const auto fork = s.fork("f", "c");
    fork->remove_polygon("p1", false, {});
    EXPECT_EQ(s.view().polygons, 2U);
    fork->undo({});
    EXPECT_TRUE(test::same_tin(s.copy_tin(), fork->copy_tin()));
}

TEST(SessionHistory, OfTwoThatExpectTheSameVersionOneWins) {
    Session s = make_session();
    for (int i = 0; i < 20; ++i)
        s.integrate(edit_of({ring(2, 4 + 0.1 * i)}));
    std::atomic<int> done = 0;
    std::atomic<int> refused = 0;
    const auto race = [&] {
        for (std::uint64_t version = 21; version < 41; ++version) {
            while (s.view().version < version)
                std::this_thread::yield();
            ChangeRequest request;
            request.expected_version = version;
            request.want_delta = true;
            const auto outcome = version % 4 == 0 ? s.redo(request) : s.undo(request);
            ++(std::holds_alternative<ChangeResult>(outcome) ? done : refused);
            EXPECT_LE(std::get<api::MeshDelta>(s.delta_since(version)).from, version);
        }
    };
    std::thread one(race);
    std::thread other(race);
    one.join();
    other.join();
    EXPECT_EQ(done, 20);
    EXPECT_EQ(refused, 20);
    EXPECT_EQ(s.view().version, 41U);
}

/// A request as the test remembers it.
struct Made {
    std::vector<core::Shape> shapes;
    std::vector<std::string> ids;
    core::IntegrateOptions options;
};

/// A session and what it should hold, told apart by nothing but going through the same again.
class RandomHistory {
  public:
    explicit RandomHistory(std::uint64_t seed) : random_(seed) {
        const auto kind = static_cast<MeshKind>(test::pick(random_, test::kMeshKinds));
        while (mesh_.triangles.empty())
            mesh_ = test::random_mesh(random_, kind, 2 + test::pick(random_, 4));
        session_.emplace(facts(), std::move(core::build_tin(mesh_).value()));
    }

    void step() {
        switch (test::pick(random_, 6)) {
            case 0:
                return undo();
            case 1:
                return redo();
            case 2:
                return remove();
            default:
                return add();
        }
    }

    /// Empty: the mesh is that of a fresh session.
    std::string compare() {
        Session fresh(facts(), std::move(core::build_tin(mesh_).value()));
        for (const Made& made : now_) {
            PolygonEdit edit = edit_of(made.shapes);
            edit.options = made.options;
            if (!std::holds_alternative<PolygonResult>(fresh.integrate(std::move(edit))))
                return "an operation that remains is refused";
        }
        if (session_->view().version != version_) return "another version";
        std::size_t polygons = 0;
        for (const Made& made : now_)
            polygons += made.ids.size();
        if (session_->view().polygons != polygons) return "another number of polygons";
        return test::same_tin(session_->copy_tin(), fresh.copy_tin()) ? "" : "another mesh";
    }

    int removals() const { return removals_; }

  private:
    static SessionFacts facts() { return {"s", "b", "", "", "metre"}; }

    void add() {
        Made made;
        const int count = 1 + test::pick(random_, 3);
        for (int i = 0; i < count; ++i) {
            const auto kind = static_cast<ShapeKind>(test::pick(random_, test::kShapeKinds));
            made.shapes.push_back(test::random_shape(random_, kind, mesh_));
            if (test::pick(random_, 4) == 0)
                test::give_elevations(random_, made.shapes.back(), mesh_);
        }
        made.options.improve = static_cast<core::Improve>(test::pick(random_, 3));
        PolygonEdit edit = edit_of(made.shapes);
        edit.options = made.options;
        const auto outcome = session_->integrate(std::move(edit));
        if (const auto* result = std::get_if<PolygonResult>(&outcome)) {
            made.ids = result->polygon_ids;
            past_.push_back(now_);
            future_.clear();
            now_.push_back(std::move(made));
            ++version_;
        }
    }

    void undo() {
        const bool done = std::holds_alternative<ChangeResult>(session_->undo({}));
        EXPECT_EQ(done, !past_.empty());
        if (!done) return;
        future_.push_back(std::exchange(now_, past_.back()));
        past_.pop_back();
        ++version_;
    }

    void redo() {
        const bool done = std::holds_alternative<ChangeResult>(session_->redo({}));
        EXPECT_EQ(done, !future_.empty());
        if (!done) return;
        past_.push_back(std::exchange(now_, future_.back()));
        future_.pop_back();
        ++version_;
    }

    void remove() {
        if (now_.empty()) return;
        const auto m = static_cast<std::size_t>(test::pick(random_, static_cast<int>(now_.size())));
        const auto i =
            static_cast<std::ptrdiff_t>(test::pick(random_, static_cast<int>(now_[m].ids.size())));
        const std::string id = now_[m].ids[static_cast<std::size_t>(i)];
        const auto outcome = session_->remove_polygon(id, false, {});
        if (!std::holds_alternative<ChangeResult>(outcome)) {
            EXPECT_TRUE(std::holds_alternative<ReplayFailure>(outcome));
            return;
        }
        past_.push_back(now_);
        future_.clear();
        now_[m].shapes.erase(now_[m].shapes.begin() + i);
        now_[m].ids.erase(now_[m].ids.begin() + i);
        if (now_[m].ids.empty()) now_.erase(now_.begin() + static_cast<std::ptrdiff_t>(m));
        ++version_;
        ++removals_;
    }

    Random random_;
    core::MeshData mesh_;
    std::optional<Session> session_;
    std::uint64_t version_ = 1;
    std::vector<Made> now_;
    std::vector<std::vector<Made>> past_;
    std::vector<std::vector<Made>> future_;
    int removals_ = 0;
};

TEST(SessionHistory, IsThatOfAFreshSessionAfterAnyWayBackAndForth) {
    int removals = 0;
    for (std::uint64_t seed = 1; seed <= 250; ++seed) {
        RandomHistory history(seed);
        for (int i = 0; i < 12; ++i) {
            history.step();
            const std::string difference = history.compare();
            ASSERT_EQ(difference, "") << "seed " << seed << ", step " << i;
        }
        removals += history.removals();
    }
    EXPECT_GT(removals, 150);
}

}  // namespace
}  // namespace tinsmith::server
