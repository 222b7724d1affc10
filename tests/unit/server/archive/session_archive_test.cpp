// SPDX-License-Identifier: Apache-2.0
#include "server/archive/session_archive.hpp"

#include <gtest/gtest.h>

#include "core/mesh/check.hpp"
#include "server/mesh_digest.hpp"
#include "tests/support/same_tin.hpp"
#include "tests/unit/server/random_work.hpp"

namespace tinsmith::server {
namespace {

using test::RandomWork;

constexpr std::uint64_t kSeeds = 25;
constexpr HistoryLimits kShortHistory{12, std::size_t{256} << 20};

/// Keeps what it is told, as bytes, or refuses.
class Notebook : public ChangeLog {
  public:
    struct Entry {
        std::string asked;
        std::uint64_t version;
        std::string digest;
    };

    void keep(const LoggedChange& change) override {
        if (refuses) throw StorageFault("the disk is full");
        entries.push_back({pack(change.asked), change.counts.version, change.digest});
        counts = change.counts;
    }

    std::vector<Entry> entries;
    SessionCounts counts;
    bool refuses = false;
};

TEST(SessionArchive, GivesBackWhatWentInToTheLastBit) {
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        SCOPED_TRACE(seed);
        RandomWork work(seed);
        const auto session = work.make_session(kShortHistory);
        for (int i = 0; i < 30; ++i)
            work.ask(*session);
        const std::string bytes = pack(session->image().parts());
        auto image = unpack_image(bytes, kShortHistory);
        ASSERT_TRUE(image);
        EXPECT_TRUE(test::same_tin(image->tin, session->copy_tin()));
        EXPECT_TRUE(core::check_tin(image->tin).empty());
        Session again(std::move(*image));
        EXPECT_EQ(pack(again.image().parts()), bytes);
        // They also go on in the same way, back into the past and forth.
        RandomWork same_work = work;
        for (int i = 0; i < 15; ++i) {
            work.ask(*session);
            same_work.ask(again);
        }
        EXPECT_TRUE(test::same_tin(again.copy_tin(), session->copy_tin()));
        EXPECT_EQ(again.view().version, session->view().version);
        EXPECT_EQ(again.view().polygons, session->view().polygons);
        for (std::uint64_t v = 1; v <= session->view().version; ++v) {
            auto ours = session->tin_at(v, {}), theirs = again.tin_at(v, {});
            ASSERT_EQ(ours.index(), theirs.index()) << v;
            if (const auto* tin = std::get_if<core::Tin>(&ours)) {
                EXPECT_TRUE(test::same_tin(std::get<core::Tin>(theirs), *tin)) << v;
            }
        }
    }
}

TEST(SessionArchive, SharesWhatWasShared) {
    RandomWork work(3);
    const auto session = work.make_session();
    while (session->view().polygons < 3)
        work.ask(*session);
    const auto image = unpack_image(pack(session->image().parts()), {});
    ASSERT_TRUE(image);
    for (const AppliedPtr& applied : image->history.applied()) {
        const Change* made = image->history.change_at(applied->version);
        if (made != nullptr && made->report) {
            EXPECT_EQ(made->report, applied->report);
        }
    }
}

TEST(SessionArchive, MakesNothingOfBytesThatAreCutOrAreNone) {
    RandomWork work(1);
    const auto session = work.make_session();
    for (int i = 0; i < 12; ++i)
        work.ask(*session);
    const std::string bytes = pack(session->image().parts());
    for (std::size_t length = 0; length < bytes.size(); length += 1 + length / 50)
        EXPECT_FALSE(unpack_image(std::string_view(bytes).substr(0, length), {})) << length;
    EXPECT_FALSE(unpack_image(bytes + '\0', {}));
    EXPECT_FALSE(unpack_image(std::string(64, '\xFF'), {}));
    EXPECT_FALSE(unpack_asked("\x09"));
    EXPECT_FALSE(unpack_counts(""));
    // Whatever is wrong, a list is never longer than the bytes allow.
    test::Random random(7);
    for (int i = 0; i < 2000; ++i) {
        std::string broken = bytes;
        for (int k = 0; k < 4; ++k)
            broken[random() % broken.size()] = static_cast<char>(random());
        (void)unpack_image(broken, {});
    }
}

TEST(SessionLog, MakesTheSameSessionAgain) {
    for (std::uint64_t seed = 100; seed < 100 + kSeeds; ++seed) {
        SCOPED_TRACE(seed);
        RandomWork work(seed);
        const auto session = work.make_session(kShortHistory);
        const auto notebook = std::make_shared<Notebook>();
        session->start_log(notebook);
        const std::string start = pack(session->image().parts());
        for (int i = 0; i < 30; ++i)
            work.ask(*session);
        Session again(*unpack_image(start, kShortHistory));
        for (const auto& [asked, version, digest] : notebook->entries)
            ASSERT_EQ(again.repeat(*unpack_asked(asked), version, digest), std::nullopt);
        EXPECT_TRUE(test::same_tin(again.copy_tin(), session->copy_tin()));
        EXPECT_EQ(again.image().digest, session->image().digest);
        EXPECT_EQ(again.image().next_polygon, session->image().next_polygon);
        EXPECT_EQ(again.view().polygons, session->view().polygons);
        EXPECT_EQ(again.history().undo, session->history().undo);
        EXPECT_EQ(again.history().redo, session->history().redo);
        if (!notebook->entries.empty()) {
            EXPECT_EQ(notebook->counts.version, session->view().version);
        }
    }
}

TEST(SessionLog, FindsAChangeThatComesOutOtherwise) {
    RandomWork work(5);
    const auto session = work.make_session();
    const auto notebook = std::make_shared<Notebook>();
    session->start_log(notebook);
    const std::string start = pack(session->image().parts());
    while (notebook->entries.empty())
        work.ask(*session);
    const auto& [asked, version, digest] = notebook->entries.front();
    std::string other = digest;
    other[0] = static_cast<char>(other[0] ^ 1);
    EXPECT_NE(Session(*unpack_image(start, {})).repeat(*unpack_asked(asked), version, other),
              std::nullopt);
    EXPECT_NE(Session(*unpack_image(start, {})).repeat(*unpack_asked(asked), version + 1, digest),
              std::nullopt);
    EXPECT_NE(Session(*unpack_image(start, {})).repeat(UndoAsked{}, version, digest), std::nullopt);
}

TEST(SessionLog, TakesBackWhatIsNotKept) {
    std::size_t refused = 0;
    for (std::uint64_t seed = 200; seed < 200 + kSeeds; ++seed) {
        SCOPED_TRACE(seed);
        RandomWork work(seed);
        const auto session = work.make_session(kShortHistory);
        const auto notebook = std::make_shared<Notebook>();
        session->start_log(notebook);
        for (int i = 0; i < 25; ++i) {
            const std::string before = pack(session->image().parts());
            notebook->refuses = true;
            RandomWork same_work = work;
            try {
                same_work.ask(*session);
            } catch (const StorageFault&) {
                ++refused;
            }
            ASSERT_EQ(pack(session->image().parts()) == before, true) << i;
            ASSERT_FALSE(session->is_lost());
            notebook->refuses = false;
            work.ask(*session);
        }
    }
    EXPECT_GT(refused, 10 * kSeeds);
}

TEST(MeshDigest, SeesEverySlot) {
    RandomWork work(11);
    const auto session = work.make_session();
    const std::string before = whole_digest(session->copy_tin());
    EXPECT_EQ(whole_digest(session->copy_tin()), before);
    while (session->view().version == 1)
        work.ask(*session);
    EXPECT_NE(whole_digest(session->copy_tin()), before);
}

}  // namespace
}  // namespace tinsmith::server
