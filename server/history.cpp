// SPDX-License-Identifier: Apache-2.0
#include "server/history.hpp"

#include <algorithm>
#include <utility>

namespace tinsmith::server {

namespace {

template <typename T>
void make_room(std::vector<T>& list, std::size_t more) {
    const std::size_t needed = list.size() + more;
    if (needed > list.capacity()) list.reserve(std::max(needed, list.capacity() * 2));
}

}  // namespace

History::History(HistoryLimits limits, std::size_t vertices, std::size_t triangles)
    : limits_(limits) {
    limits_.operations = std::max<std::size_t>(limits_.operations, 1);
    Change created;
    created.version = 1;
    created.vertices = vertices;
    created.triangles = triangles;
    changes_.push_back(std::move(created));
}

const Change* History::change_at(std::uint64_t version) const {
    const std::uint64_t oldest = changes_.front().version;
    if (version < oldest || version - oldest >= changes_.size()) return nullptr;
    return &changes_[version - oldest];
}

std::vector<Polygon> History::polygons() const {
    std::vector<Polygon> list;
    const auto add = [&list](const auto& done) {
        const auto* request = std::get_if<PolygonsOperation>(&*done.operation);
        for (std::size_t i = 0; request != nullptr && i < request->shapes.size(); ++i)
            list.push_back({*request, *done.report, i});
    };
    for (const Settled& settled : settled_)
        add(settled);
    for (const AppliedPtr& applied : applied_)
        add(*applied);
    return list;
}

std::size_t History::polygon_count() const {
    std::size_t count = settled_polygons_;
    for (const AppliedPtr& applied : applied_)
        count += polygon_ids(*applied->operation).size();
    return count;
}

void History::prepare(std::size_t added) {
    make_room(changes_, 1);
    make_room(settled_, added + applied_.size());
    make_room(applied_, added);
    make_room(undoable_, 1);
    make_room(redoable_, 1);
}

std::size_t History::memory_bytes() const {
    std::size_t sum = settled_bytes_;
    for (const AppliedPtr& applied : applied_)
        sum += applied->lasting_bytes + applied->record_bytes;
    for (const Edit& edit : undoable_)
        sum += sizeof edit + edit.removed_bytes;
    for (const Edit& edit : redoable_)
        sum += sizeof edit + edit.added_bytes;
    return sum;
}

void History::make(Edit edit, std::vector<AppliedPtr> done, Change change) noexcept {
    redoable_.clear();
    replace(edit.first, done);
    undoable_.push_back(std::move(edit));
    keep(std::move(change));
}

void History::undo(std::vector<AppliedPtr> done, Change change) noexcept {
    replace(undoable_.back().first, done);
    redoable_.push_back(std::move(undoable_.back()));
    undoable_.pop_back();
    keep(std::move(change));
}

void History::redo(std::vector<AppliedPtr> done, Change change) noexcept {
    replace(redoable_.back().first, done);
    undoable_.push_back(std::move(redoable_.back()));
    redoable_.pop_back();
    keep(std::move(change));
}

void History::replace(std::size_t first, std::vector<AppliedPtr>& by) noexcept {
    applied_.resize(first - base());
    for (AppliedPtr& applied : by)
        applied_.push_back(std::move(applied));
}

void History::keep(Change change) noexcept {
    changes_.push_back(std::move(change));
    shrink();
}

void History::settle_oldest() noexcept {
    const AppliedPtr& oldest = applied_.front();
    settled_.push_back({oldest->operation, oldest->report});
    settled_bytes_ += oldest->lasting_bytes;
    settled_polygons_ += polygon_ids(*oldest->operation).size();
    applied_.erase(applied_.begin());
    // Undo goes from the newest on: what is older than one that is out of reach is so too.
    const auto last = std::find_if(undoable_.rbegin(), undoable_.rend(),
                                   [this](const Edit& edit) { return edit.first < base(); });
    undoable_.erase(undoable_.begin(), last.base());
}

/// Ends: each turn an edit or an operation less.
void History::shrink() noexcept {
    if (changes_.size() > limits_.operations + 1) changes_.erase(changes_.begin());
    if (undoable_.size() > limits_.operations) undoable_.erase(undoable_.begin());
    while (applied_.size() > limits_.operations || memory_bytes() > limits_.bytes) {
        const bool is_needed = !undoable_.empty() && undoable_.back().first <= base();
        // What could be redone stands on the operations that are there now.
        if (applied_.size() > 1 && !is_needed && redoable_.empty()) {
            settle_oldest();
        } else if (undoable_.size() > 1) {
            undoable_.erase(undoable_.begin());
        } else {
            break;
        }
    }
}

}  // namespace tinsmith::server
