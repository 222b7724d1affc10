// SPDX-License-Identifier: Apache-2.0
#include "server/history.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace tinsmith::server {

namespace {

template <typename T>
void make_room(std::vector<T>& list, std::size_t more) {
    const std::size_t needed = list.size() + more;
    if (needed > list.capacity()) list.reserve(std::max(needed, list.capacity() * 2));
}

std::size_t undoable_bytes(const Edit& edit) {
    return sizeof edit + edit.removed_bytes;
}
std::size_t redoable_bytes(const Edit& edit) {
    return sizeof edit + edit.added_bytes;
}

/// The part of all bytes that what changes tell of themselves may take.
constexpr std::size_t kToldShare = 4;

/// Counted whether or not the operations on the mesh share it.
std::size_t told_bytes_of(const Change& change) noexcept {
    std::size_t sum = 0;
    for (const auto& slots : change.written)
        sum += sizeof slots + held_bytes(*slots);
    if (change.report) {
        sum += sizeof(core::Report);
        for (const core::ShapeReport& shape : change.report->shapes)
            sum += held_bytes(shape);
    }
    if (change.locks) sum += held_bytes(*change.locks);
    return change.answer ? sum + sizeof(api::EditAnswer) : sum;
}

}  // namespace

History::History(HistoryLimits limits, std::size_t vertices, std::size_t triangles)
    : limits_(limits) {
    limits_.operations = std::max<std::size_t>(limits_.operations, 1);
    in_force_ = limits_;
    Change created;
    created.version = 1;
    created.vertices = vertices;
    created.triangles = triangles;
    changes_.push_back(std::move(created));
}

void History::bound(HistoryLimits limits) noexcept {
    in_force_.operations = std::clamp<std::size_t>(limits.operations, 1, limits_.operations);
    in_force_.bytes = std::min(limits.bytes, limits_.bytes);
}

const Change* History::change_at(std::uint64_t version) const {
    const std::uint64_t oldest = changes_.front().version;
    if (version < oldest || version - oldest >= changes_.size()) return nullptr;
    return &changes_[version - oldest];
}

std::variant<WayBack, VersionGone> History::way_to(std::uint64_t version) const {
    std::vector<Rerun> list;
    list.reserve(applied_.size());
    for (const AppliedPtr& applied : applied_)
        list.push_back({applied->version, applied->operation});
    for (std::uint64_t v = this->version(); v > version; --v) {
        const Change* change = change_at(v);
        if (change == nullptr || !change->step || change->step->first < base()) {
            return VersionGone{change == nullptr ? changes_.front().version : v};
        }
        list.resize(change->step->first - base());
        list.insert(list.end(), change->step->removed.begin(), change->step->removed.end());
    }
    if (change_at(version) == nullptr) return VersionGone{changes_.front().version};
    // The same operations on the same ones before them gave the same mesh.
    std::size_t same = 0;
    while (same < list.size() && same < applied_.size() &&
           list[same].operation == applied_[same]->operation)
        ++same;
    WayBack way;
    const auto first = static_cast<std::ptrdiff_t>(same);
    way.taken.assign(applied_.begin() + first, applied_.end());
    way.wanted.assign(list.begin() + first, list.end());
    return way;
}

std::vector<Polygon> History::polygons() const {
    std::vector<Polygon> list;
    const auto add = [&list](const auto& done) {
        const auto* request = std::get_if<PolygonsOperation>(done.operation.get());
        for (std::size_t i = 0; request != nullptr && i < request->shapes.size(); ++i)
            list.push_back({*request, *done.report, i});
    };
    for (const Settled& settled : settled_)
        add(settled);
    for (const AppliedPtr& applied : applied_)
        add(*applied);
    return list;
}

void History::prepare(std::size_t added) {
    make_room(changes_, 1);
    make_room(settled_, added + applied_.size());
    make_room(applied_, added);
    make_room(undoable_, 1);
    make_room(redoable_, 1);
}

std::size_t History::memory_bytes() const {
    return settled_bytes_ + told_bytes_ + sums_.applied_bytes + sums_.undoable_bytes +
           sums_.redoable_bytes + sums_.lone_bytes;
}

History::Sums History::counted() const {
    Sums sums;
    for (const AppliedPtr& applied : applied_) {
        if (!applied || !applied->operation) continue;  // of bytes that nobody wrote
        sums.polygons += polygon_ids(*applied->operation).size();
        sums.applied_bytes += applied->lasting_bytes + applied->record_bytes;
    }
    for (const Edit& edit : undoable_)
        sums.undoable_bytes += undoable_bytes(edit);
    for (const Edit& edit : redoable_)
        sums.redoable_bytes += redoable_bytes(edit);
    for (const Change& change : changes_)
        sums.lone_bytes += change.lone_bytes;
    return sums;
}

/// Requires: room for it.
void History::add_applied(AppliedPtr applied) noexcept {
    sums_.polygons += polygon_ids(*applied->operation).size();
    sums_.applied_bytes += applied->lasting_bytes + applied->record_bytes;
    applied_.push_back(std::move(applied));
}

void History::count_out(const Applied& applied) noexcept {
    sums_.polygons -= polygon_ids(*applied.operation).size();
    sums_.applied_bytes -= applied.lasting_bytes + applied.record_bytes;
}

void History::make(Edit edit, std::vector<AppliedPtr> done, Change change) noexcept {
    for (const Edit& dropped : redoable_)
        leave_to_steps(dropped.version, dropped.added_bytes);
    redoable_.clear();
    sums_.redoable_bytes = 0;
    replace(edit.first, done);
    sums_.undoable_bytes += undoable_bytes(edit);
    undoable_.push_back(std::move(edit));
    keep(std::move(change));
}

void History::undo(std::vector<AppliedPtr> done, Change change) noexcept {
    replace(undoable_.back().first, done);
    sums_.undoable_bytes -= undoable_bytes(undoable_.back());
    sums_.redoable_bytes += redoable_bytes(undoable_.back());
    redoable_.push_back(std::move(undoable_.back()));
    undoable_.pop_back();
    keep(std::move(change));
}

void History::redo(std::vector<AppliedPtr> done, Change change) noexcept {
    replace(redoable_.back().first, done);
    sums_.redoable_bytes -= redoable_bytes(redoable_.back());
    sums_.undoable_bytes += undoable_bytes(redoable_.back());
    undoable_.push_back(std::move(redoable_.back()));
    redoable_.pop_back();
    keep(std::move(change));
}

void History::replace(std::size_t first, std::vector<AppliedPtr>& by) noexcept {
    for (std::size_t i = first - base(); i < applied_.size(); ++i)
        count_out(*applied_[i]);
    applied_.resize(first - base());
    for (AppliedPtr& applied : by)
        add_applied(std::move(applied));
}

void History::keep(Change change) noexcept {
    change.told_bytes = told_bytes_of(change);
    told_bytes_ += change.told_bytes;
    sums_.lone_bytes += change.lone_bytes;
    changes_.push_back(std::move(change));
    shrink();
    assert(sums_ == counted());
}

void History::settle_oldest() noexcept {
    const AppliedPtr& oldest = applied_.front();
    if (std::holds_alternative<PolygonsOperation>(*oldest->operation)) {
        settled_.push_back({oldest->operation, oldest->report});
        settled_bytes_ += oldest->lasting_bytes;
        settled_polygons_ += polygon_ids(*oldest->operation).size();
    } else {
        settled_.push_back({});  // its place alone counts
    }
    count_out(*oldest);
    applied_.erase(applied_.begin());
    // Undo goes from the newest on: what is older than one that is out of reach is so too.
    const auto last = std::find_if(undoable_.rbegin(), undoable_.rend(),
                                   [this](const Edit& edit) { return edit.first < base(); });
    for (auto edit = undoable_.begin(); edit != last.base(); ++edit) {
        leave_to_steps(edit->version, edit->removed_bytes);
        sums_.undoable_bytes -= undoable_bytes(*edit);
    }
    undoable_.erase(undoable_.begin(), last.base());
    forget_unreachable();
}

void History::settle() {
    make_room(settled_, applied_.size());
    redoable_.clear();
    undoable_.clear();
    sums_ = counted();
    while (!applied_.empty())
        settle_oldest();
    changes_.erase(changes_.begin(), changes_.end() - 1);
    changes_.back().step.reset();
    changes_.back().written.clear();
    changes_.back().lone_bytes = 0;
    sums_ = counted();
    told_bytes_ = changes_.back().told_bytes = told_bytes_of(changes_.back());
}

/// No version is made again by way of a step that reaches below the base, nor one before it.
void History::forget_unreachable() noexcept {
    const auto newest = std::find_if(
        changes_.rbegin(), changes_.rend(),
        [this](const Change& change) { return change.step && change.step->first < base(); });
    for (auto change = changes_.begin(); change != newest.base(); ++change)
        forget_step(*change);
}

void History::forget_step(Change& change) noexcept {
    change.step.reset();
    sums_.lone_bytes -= std::exchange(change.lone_bytes, 0);
}

void History::drop_oldest_change() noexcept {
    told_bytes_ -= changes_.front().told_bytes;
    sums_.lone_bytes -= changes_.front().lone_bytes;
    changes_.erase(changes_.begin());
}

void History::drop_oldest_undoable() noexcept {
    leave_to_steps(undoable_.front().version, undoable_.front().removed_bytes);
    sums_.undoable_bytes -= undoable_bytes(undoable_.front());
    undoable_.erase(undoable_.begin());
}

/// An edit is about to go, and with it the last but the steps that keeps some operations. They stay
/// as long as the newest change that is about the edit.
void History::leave_to_steps(std::uint64_t version, std::size_t bytes) noexcept {
    const auto about =
        std::find_if(changes_.rbegin(), changes_.rend(), [version](const Change& change) {
            return change.version == version || change.of == version;
        });
    if (about == changes_.rend() || !about->step) return;
    about->lone_bytes += bytes;
    sums_.lone_bytes += bytes;
}

/// False: no step keeps anything alone. Versions before the ones forgotten are gone.
bool History::forget_oldest_lone() noexcept {
    const auto lone = std::find_if(changes_.begin(), changes_.end(),
                                   [](const Change& change) { return change.lone_bytes > 0; });
    if (lone == changes_.end()) return false;
    for (auto change = changes_.begin(); change <= lone; ++change)
        forget_step(*change);
    return true;
}

/// Ends: each turn an edit or an operation less.
void History::shrink() noexcept {
    while (changes_.size() > in_force_.operations + 1)
        drop_oldest_change();
    while (changes_.size() > 2 && told_bytes_ > in_force_.bytes / kToldShare)
        drop_oldest_change();
    while (undoable_.size() > in_force_.operations)
        drop_oldest_undoable();
    while (applied_.size() > in_force_.operations || memory_bytes() > in_force_.bytes) {
        const bool is_needed = !undoable_.empty() && undoable_.back().first <= base();
        // What could be redone stands on the operations that are there now.
        if (memory_bytes() > in_force_.bytes && forget_oldest_lone()) {
            continue;
        } else if (applied_.size() > 1 && !is_needed && redoable_.empty()) {
            settle_oldest();
        } else if (undoable_.size() > 1) {
            drop_oldest_undoable();
        } else {
            break;
        }
    }
}

}  // namespace tinsmith::server
