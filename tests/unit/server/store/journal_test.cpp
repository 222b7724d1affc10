// SPDX-License-Identifier: Apache-2.0
#include "server/store/journal.hpp"

#include <gtest/gtest.h>

#include "tests/unit/server/store/journal_folder.hpp"

namespace tinsmith::server {
namespace {

class JournalTest : public JournalFolder {};

TEST_F(JournalTest, GivesBackWhatWasWritten) {
    auto journal = open();
    make(*journal, "birth", "id", 7, "the mesh");
    for (std::uint64_t version = 8; version <= 20; ++version)
        ASSERT_FALSE(journal->append(entry("birth", version)));
    const StoredSession stored = read(*journal, "birth");
    EXPECT_EQ(stored.bytes, "the mesh");
    EXPECT_EQ(stored.head, head(7, 8));
    ASSERT_EQ(stored.tail.size(), 13U);
    for (std::size_t i = 0; i < stored.tail.size(); ++i)
        EXPECT_EQ(stored.tail[i], entry("birth", 8 + i));
    journal = reopen(std::move(journal));
    const StoredSession again = read(*journal, "birth");
    EXPECT_EQ(again.bytes, stored.bytes);
    EXPECT_EQ(again.tail, stored.tail);
}

}  // namespace
}  // namespace tinsmith::server
