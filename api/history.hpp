// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tinsmith::api {

/// What is told of a version: how it came about and how large the mesh was then.
struct ChangeView {
    std::uint64_t version = 0;
    std::string change;                 ///< "created", "polygons", "undo", "redo", ...
    std::uint64_t of = 0;               ///< undo, redo: the version they are about; 0: none
    std::vector<std::string> polygons;  ///< that it brought, took out, or is about
    std::size_t vertices = 0;
    std::size_t triangles = 0;
};

/// What is told of a session's past.
struct HistoryView {
    std::string_view session;
    std::uint64_t version = 0;
    std::uint64_t oldest = 0;           ///< of all versions that are kept
    std::optional<std::uint64_t> undo;  ///< the version that undo would take back; null: none
    std::optional<std::uint64_t> redo;
    std::span<const ChangeView> changes;  ///< oldest first
};

/// {"session", "version", "change", "of"?, "polygons", "vertices", "triangles"}
std::string write_change(std::string_view session, const ChangeView& change);

/// {"session", "version", "oldest", "undo", "redo", "changes": [...]}
std::string write_history(const HistoryView& history);

}  // namespace tinsmith::api
