// SPDX-License-Identifier: Apache-2.0
#include "api/formats/obj_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "api/formats/fault_log.hpp"
#include "api/formats/number_text.hpp"
#include "api/formats/shown_text.hpp"
#include "core/predicates/orientation.hpp"

namespace tinsmith::api {

namespace {

constexpr std::string_view kPassedOver[] = {
    "vt",     "vn",     "vp",    "g",        "o",        "s",   "mg",         "usemtl",   "mtllib",
    "maplib", "usemap", "bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj"};
constexpr std::string_view kFreeForm[] = {"cstype", "deg",  "bmat",  "step",  "curv", "curv2",
                                          "surf",   "parm", "trim",  "hole",  "scrv", "sp",
                                          "end",    "con",  "ctech", "stech", "call", "csh"};

/// Faces of more corners than these are looked at from their first corner only.
constexpr std::size_t kMostCornersTried = 32;
constexpr std::size_t kLinesBetweenLooks = 4096;

bool is_in(std::string_view word, std::span<const std::string_view> words) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

/// Words of a file, line by line. A backslash at the end of a line goes on with the next.
class Words {
  public:
    explicit Words(std::string_view bytes) : bytes_(bytes) {}

    bool at_end() const { return at_ >= bytes_.size(); }
    std::size_t line() const { return line_; }
    double share() const { return static_cast<double>(at_) / static_cast<double>(bytes_.size()); }

    /// The next word of this line; empty: there is none.
    std::string_view next() {
        while (at_ < bytes_.size() && (is_space(bytes_[at_]) || goes_on())) {
            if (bytes_[at_] == '\\')
                skip_to_next_line();
            else
                ++at_;
        }
        const std::size_t begin = at_;
        while (at_ < bytes_.size() && bytes_[at_] != '\n' && !is_space(bytes_[at_]) && !goes_on())
            ++at_;
        return bytes_.substr(begin, at_ - begin);
    }
    void skip_line() {
        // Comments go on by a backslash as well, in the letter of the format.
        while (at_ < bytes_.size() && bytes_[at_] != '\n') {
            if (goes_on())
                skip_to_next_line();
            else
                ++at_;
        }
        skip_to_next_line();
    }

  private:
    static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f'; }
    bool goes_on() const {
        if (bytes_[at_] != '\\') return false;
        const std::string_view rest = bytes_.substr(at_ + 1, 2);
        return rest.starts_with('\n') || rest == "\r\n";
    }
    void skip_to_next_line() {
        at_ = std::min(bytes_.find('\n', at_), bytes_.size());
        if (at_ < bytes_.size()) {
            ++at_;
            ++line_;
        }
    }

    std::string_view bytes_;
    std::size_t at_ = 0;
    std::size_t line_ = 1;
};

class ObjReader {
  public:
    ObjReader(std::string_view bytes, const ReadLimits& limits)
        : words_(bytes),
          limits_(limits),
          log_(limits.max_faults),
          is_ours_(bytes.starts_with("# tinsmith") || bytes.starts_with("# Tinsmith")) {}

    Parsed<Terrain> read() {
        for (std::size_t lines = 0; !words_.at_end() && !log_.full() && !stopped_; ++lines) {
            if (lines % kLinesBetweenLooks == 0 && limits_.progress &&
                !limits_.progress(words_.share())) {
                log_.add(FaultKind::Stopped, reading_stopped());
                break;
            }
            line_ = words_.line();
            read_statement(words_.next());
            words_.skip_line();
        }
        if (!log_.empty()) return std::move(log_).refusal<Terrain>();
        if (terrain_.mesh.triangles.empty())
            return {FaultKind::Invalid, Fault{"OBJ_EMPTY", "The file has no face (f).", {}}};
        if (passed_over_ > 0)
            terrain_.notes.push_back(std::to_string(passed_over_) +
                                     " lines or points (l, p) were passed over.");
        name_places();
        return std::move(terrain_);
    }

  private:
    void fault(std::string code, const std::string& detail, FaultKind kind = FaultKind::Invalid) {
        log_.add(kind, {std::move(code), "Line " + std::to_string(line_) + ": " + detail, {}});
    }
    void stop(std::string code, const std::string& detail) {
        fault(std::move(code), detail, FaultKind::TooLarge);
        stopped_ = true;
    }

    void read_statement(std::string_view word) {
        if (word.empty() || word.starts_with('#')) return;
        if (word == "v") return read_vertex();
        if (word == "f" || word == "fo") return read_face();
        if (word == "l" && is_ours_) return read_lines();
        if (word == "l" || word == "p") {
            ++passed_over_;
        } else if (is_in(word, kFreeForm)) {
            fault("OBJ_FREE_FORM",
                  std::string(word) +
                      " belongs to curves and surfaces, which are not read: "
                      "convert them to faces first.",
                  FaultKind::Unsupported);
        } else if (!is_in(word, kPassedOver)) {
            fault("OBJ_KEYWORD", shown(word) + " begins no statement of an OBJ.",
                  FaultKind::Syntax);
        }
    }

    void read_vertex() {
        std::array<double, 3> p{};
        for (double& value : p) {
            const std::string_view word = words_.next();
            const auto number = number_in<double>(word);
            if (!number) {
                fault("OBJ_VERTEX", word.empty() ? "A vertex has three numbers, x y z."
                                                 : shown(word) + " is no number.");
                value = 0.0;
                break;
            }
            value = *number;
            if (std::fabs(value) <= kMaxCoordinate) continue;
            fault("COORDINATE_OUT_OF_RANGE", shown(word) + " is not finite, or beyond 1e9.");
            value = 0.0;
        }
        if (terrain_.mesh.vertices.size() >= limits_.max_vertices)
            return stop(
                "TOO_MANY_VERTICES",
                "No more than " + std::to_string(limits_.max_vertices) + " vertices are taken.");
        terrain_.mesh.vertices.push_back({p[0], p[1], p[2]});
        places_->vertices.push_back(static_cast<std::uint32_t>(line_));
    }

    /// The vertex of a corner: "7", "7/1", "7/1/2", "7//2" or, counted back, "-1".
    std::optional<std::uint32_t> corner(std::string_view word) {
        const std::string_view own = word.substr(0, word.find('/'));
        const auto number = number_in<std::int64_t>(own);
        if (!number || *number == 0) {
            fault("OBJ_INDEX",
                  shown(word) + " names no vertex: they are counted from 1, or back from -1.");
            return std::nullopt;
        }
        const auto count = static_cast<std::int64_t>(terrain_.mesh.vertices.size());
        const std::int64_t index = *number > 0 ? *number - 1 : count + *number;
        if (*number < -count || index >= count) {
            fault("OBJ_INDEX", shown(word) + " names a vertex that is not there: " +
                                   std::to_string(count) + " were given by then.");
            return std::nullopt;
        }
        return static_cast<std::uint32_t>(index);
    }

    bool read_corners() {
        corners_.clear();
        bool fine = true;
        for (std::string_view word = words_.next();
             !word.empty() && !word.starts_with('#') && !log_.full(); word = words_.next()) {
            const auto v = corner(word);
            if (v) corners_.push_back(*v);
            fine = fine && v;
        }
        return fine;
    }

    void read_face() {
        if (!read_corners()) return;
        if (corners_.size() < 3) return fault("OBJ_FACE", "A face has three corners or more.");
        if (corners_.size() == 3) return add(0, 1, 2);
        const std::size_t count = corners_.size();
        // An upright face has no area either way: as it is, for the builder to name or to mend.
        if (is_upright()) return add_fan(0);
        const std::size_t tried = count <= kMostCornersTried ? count : 1;
        for (std::size_t apex = 0; apex < tried; ++apex)
            if (sees_all(apex)) return add_fan(apex);
        fault("OBJ_POLYGON", "The face of " + std::to_string(count) +
                                 " corners is not convex in plan: cut it into triangles first.");
    }

    void add_fan(std::size_t apex) {
        const std::size_t count = corners_.size();
        for (std::size_t i = 1; i + 1 < count; ++i)
            add(apex, (apex + i) % count, (apex + i + 1) % count);
    }

    /// How the triangle of a corner with two after it turns; they are counted around the face.
    core::Orientation turn(std::size_t apex, std::size_t i) const {
        const auto plan = [&](std::size_t k) {
            return terrain_.mesh.vertices[corners_[(apex + k) % corners_.size()]].plan();
        };
        return core::orientation(plan(0), plan(i), plan(i + 1));
    }

    bool is_upright() const {
        for (std::size_t i = 1; i + 1 < corners_.size(); ++i)
            if (turn(0, i) != core::Orientation::Collinear) return false;
        return true;
    }

    /// Whether the triangles about that corner all turn the same way: then they do not overlap.
    bool sees_all(std::size_t apex) const {
        const core::Orientation way = turn(apex, 1);
        if (way == core::Orientation::Collinear) return false;
        for (std::size_t i = 2; i + 1 < corners_.size(); ++i)
            if (turn(apex, i) != way) return false;
        return true;
    }

    void add(std::size_t a, std::size_t b, std::size_t c) {
        if (stopped_) return;
        if (terrain_.mesh.triangles.size() >= limits_.max_triangles)
            return stop(
                "TOO_MANY_TRIANGLES",
                "No more than " + std::to_string(limits_.max_triangles) + " triangles are taken.");
        terrain_.mesh.triangles.push_back({corners_[a], corners_[b], corners_[c]});
        places_->triangles.push_back(static_cast<std::uint32_t>(line_));
    }

    void read_lines() {
        if (!read_corners()) return;
        for (std::size_t i = 0; i + 1 < corners_.size(); ++i)
            if (corners_[i] != corners_[i + 1])
                terrain_.mesh.constraints.push_back({corners_[i], corners_[i + 1]});
    }

    void name_places() {
        const auto line = [](const std::vector<std::uint32_t>& lines, std::size_t i) {
            return i < lines.size() ? "line " + std::to_string(lines[i]) : std::string("no line");
        };
        terrain_.vertex_place = [line, places = places_](std::size_t v) {
            return line(places->vertices, v);
        };
        terrain_.triangle_place = [line, places = places_](std::size_t t) {
            return line(places->triangles, t);
        };
    }

    struct Places {
        std::vector<std::uint32_t> vertices;
        std::vector<std::uint32_t> triangles;
    };

    Words words_;
    const ReadLimits& limits_;
    FaultLog log_;
    const bool is_ours_;
    Terrain terrain_;
    std::vector<std::uint32_t> corners_;
    std::shared_ptr<Places> places_ = std::make_shared<Places>();
    std::size_t line_ = 0;
    std::size_t passed_over_ = 0;
    bool stopped_ = false;
};

}  // namespace

Parsed<Terrain> read_obj(std::string_view bytes, const ReadLimits& limits) {
    return ObjReader(bytes, limits).read();
}

}  // namespace tinsmith::api
