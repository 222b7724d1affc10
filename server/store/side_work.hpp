// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "server/store/rows.hpp"

namespace tinsmith::server::store {

/// What goes along with the next commit and is waited for by nobody.
struct SideWork {
    std::map<std::string, std::int64_t> touched;  ///< by birth: when
    std::deque<KeptAnswerRow> answers;
    std::size_t answer_bytes = 0;  ///< of those

    bool empty() const { return touched.empty() && answers.empty(); }

    static std::size_t bytes_of(const KeptAnswerRow& answer) {
        return sizeof answer + answer.scope.size() + answer.key.size() + answer.print.size() +
               answer.bytes.size();
    }

    void add(KeptAnswerRow answer) {
        const std::size_t bytes = bytes_of(answer);
        answers.push_back(std::move(answer));
        answer_bytes += bytes;
    }

    /// Puts what is older before it: of a session's times the later one stays.
    void put_back(SideWork older) {
        touched.merge(older.touched);
        for (; !older.answers.empty(); older.answers.pop_back())
            answers.push_front(std::move(older.answers.back()));
        answer_bytes += older.answer_bytes;
    }
};

}  // namespace tinsmith::server::store
