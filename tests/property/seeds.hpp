// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace tinsmith::test {

/// Seeds are shared out among shards that run beside each other.
inline constexpr std::uint64_t kShards = 8;

inline std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
    const char* text = std::getenv(variable);
    return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

/// What one shard tried and what failed, by the word of the fault. The environment chooses:
/// TINSMITH_OPERATIONS=n in all shards together, TINSMITH_FIRST_SEED=n where seeds begin,
/// TINSMITH_SEED=n that one alone.
class SeedRun {
  public:
    SeedRun(std::uint64_t shard, std::uint64_t operations)
        : only_(number_from("TINSMITH_SEED", 0)),
          wanted_(number_from("TINSMITH_OPERATIONS", operations) / kShards),
          next_(only_ != 0 ? only_ : number_from("TINSMITH_FIRST_SEED", 1) + shard) {
        std::cout << "seeds from " << next_ << ", every " << kShards << "th\n";
    }

    bool more() const { return only_ != 0 ? tried_ == 0 : operations_ < wanted_; }
    std::uint64_t next() {
        ++tried_;
        return std::exchange(next_, next_ + kShards);
    }
    void count() { ++operations_; }
    std::uint64_t operations() const { return operations_; }

    void fault(const std::string& word, std::uint64_t seed, const std::string& text) {
        faults_[word].push_back("TINSMITH_SEED=" + std::to_string(seed) + " " + text);
    }
    /// At most so many of a million operations may fail with this word: a defect that is known, or
    /// two more than twice what that makes, so that chance alone does not fail the run.
    void allow(const std::string& word, std::uint64_t per_million, std::uint64_t of) {
        allowed_[word] = only_ != 0 || per_million == 0 ? 0 : 2 + 2 * per_million * of / 1'000'000;
    }

    /// Fails where a word came more often than allowed; says how often each came.
    void judge() const {
        std::cout << operations_ << " operations\n";
        for (const auto& [word, examples] : faults_) {
            const auto found = allowed_.find(word);
            const std::uint64_t allowed = found == allowed_.end() ? 0 : found->second;
            std::cout << "  " << word << ": " << examples.size() << " (allowed " << allowed
                      << ")\n";
            if (examples.size() <= allowed) continue;
            std::string text;
            for (std::size_t i = 0; i < examples.size() && i < 10; ++i)
                text += "\n  " + examples[i];
            ADD_FAILURE() << word << ": " << examples.size() << " of " << operations_
                          << " operations, allowed " << allowed << text;
        }
    }

  private:
    std::uint64_t only_;
    std::uint64_t wanted_;
    std::uint64_t next_;
    std::uint64_t tried_ = 0;
    std::uint64_t operations_ = 0;
    std::map<std::string, std::vector<std::string>> faults_;
    std::map<std::string, std::uint64_t> allowed_;
};

}  // namespace tinsmith::test
