// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "server/log.hpp"
#include "server/random_id.hpp"
#include "server/store/journal.hpp"

namespace tinsmith::server {

/// A folder of its own for a test's journal, and sessions whose bytes follow from their names.
class JournalFolder : public testing::Test {
  protected:
    void SetUp() override {
        set_log_level(LogLevel::Off);
        folder_ = std::filesystem::temp_directory_path() / ("tinsmith-journal-" + random_hex(8));
        options_.folder = folder_ / "data";
        options_.grow_log = false;
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override {
        set_log_level(LogLevel::Info);
        std::filesystem::remove_all(folder_);
    }

    std::filesystem::path file() const { return options_.folder / "tinsmith.db"; }

    std::variant<std::unique_ptr<Journal>, std::string> try_open() const {
        return Journal::open(options_);
    }
    std::string why_not() const {
        const auto opened = try_open();
        return opened.index() == 1 ? std::get<1>(opened) : std::string("it opens");
    }
    std::unique_ptr<Journal> open() const {
        auto opened = try_open();
        if (auto* why = std::get_if<std::string>(&opened)) {
            ADD_FAILURE() << *why;
            return nullptr;
        }
        return std::move(std::get<0>(opened));
    }
    std::unique_ptr<Journal> reopen(std::unique_ptr<Journal> journal) const {
        journal.reset();
        return open();
    }

    static StoredFacts facts(const std::string& birth, const std::string& id) {
        return {birth, id, "facts of " + birth, "key of " + birth, "print of " + birth, 1000};
    }
    static SnapshotHead head(std::uint64_t version, std::uint64_t bytes = 0) {
        return {
            version, 3, 2, "digest " + std::to_string(version), "view " + std::to_string(version),
            bytes};
    }
    static JournalEntry entry(const std::string& birth, std::uint64_t version,
                              std::size_t body_bytes = 300) {
        const std::string text = birth + " " + std::to_string(version);
        std::string body = "body " + text + std::string(1, '\0');
        while (body.size() < body_bytes)
            body += text;
        return {birth,           version,       4, body, "digest " + text, "key " + text,
                "print " + text, "view " + text};
    }
    static void make(Journal& journal, const std::string& birth, const std::string& id,
                     std::uint64_t version = 1, const std::string& bytes = "mesh") {
        const auto fault = journal.create(facts(birth, id), head(version), bytes);
        ASSERT_FALSE(fault) << fault->text;
    }
    static StoredSession read(const Journal& journal, const std::string& birth) {
        auto stored = journal.read(birth);
        if (const auto* fault = std::get_if<JournalFault>(&stored)) {
            ADD_FAILURE() << fault->text;
            return {};
        }
        return std::get<StoredSession>(std::move(stored));
    }
    static std::vector<SessionRow> rows(const Journal& journal) {
        auto sessions = journal.sessions();
        if (const auto* fault = std::get_if<JournalFault>(&sessions)) {
            ADD_FAILURE() << fault->text;
            return {};
        }
        return std::get<0>(std::move(sessions));
    }

    std::filesystem::path folder_;
    JournalOptions options_;
};

}  // namespace tinsmith::server
