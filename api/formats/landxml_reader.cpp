// SPDX-License-Identifier: Apache-2.0
#include "api/formats/landxml_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <pugixml.hpp>

#include "api/crs.hpp"
#include "api/formats/breaklines.hpp"
#include "api/formats/fault_log.hpp"
#include "api/formats/number_text.hpp"
#include "api/formats/shown_text.hpp"
#include "core/predicates/orientation.hpp"

namespace tinsmith::api {

namespace {

constexpr std::size_t kOtherElements = 1'000'000;  ///< beside points and faces
constexpr std::size_t kElementsBetweenLooks = 4096;

/// The element's name without the prefix of its namespace.
std::string_view name_of(const pugi::xml_node& node) {
    const std::string_view name = node.name();
    return name.substr(name.find(':') + 1);
}

pugi::xml_node child_of(const pugi::xml_node& node, std::string_view name) {
    for (const pugi::xml_node& child : node.children())
        if (name_of(child) == name) return child;
    return {};
}

/// The words of a text, one after the other.
class Words {
  public:
    explicit Words(std::string_view text) : text_(text) {}
    std::string_view next() {
        constexpr std::string_view kSpaces = " \t\r\n";
        text_.remove_prefix(std::min(text_.find_first_not_of(kSpaces), text_.size()));
        const std::string_view word = text_.substr(0, text_.find_first_of(kSpaces));
        text_.remove_prefix(word.size());
        return word;
    }

  private:
    std::string_view text_;
};

class LandXmlReader {
  public:
    LandXmlReader(std::string_view bytes, const ReadLimits& limits)
        : bytes_(bytes), limits_(limits), log_(limits.max_faults) {}

    Parsed<Terrain> read() {
        if (is_small_enough() && parse()) read_document();
        if (!log_.empty()) return std::move(log_).refusal<Terrain>();
        return std::move(terrain_);
    }

  private:
    void fault(FaultKind kind, std::string code, std::string detail) {
        log_.add(kind, {std::move(code), std::move(detail), {}});
    }
    void invalid(std::string code, std::string detail) {
        fault(FaultKind::Invalid, std::move(code), std::move(detail));
    }

    /// The line of a place in the file. Places come in order, mostly: it counts on from the last.
    std::size_t line_at(std::ptrdiff_t offset) {
        const std::size_t at =
            std::min(offset < 0 ? std::size_t{0} : static_cast<std::size_t>(offset), bytes_.size());
        if (at < counted_) {
            counted_ = 0;
            line_ = 1;
        }
        line_ += static_cast<std::size_t>(
            std::count(bytes_.begin() + static_cast<std::ptrdiff_t>(counted_),
                       bytes_.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
        counted_ = at;
        return line_;
    }
    std::string place(const pugi::xml_node& node) {
        return "line " + std::to_string(line_at(node.offset_debug()));
    }

    /// A tree takes many times the bytes of the shortest elements, so they are counted first: no
    /// more than points and faces that are taken, and no shorter than those can be.
    bool is_small_enough() {
        constexpr std::size_t kShortest = 10;  // <F>1 2 3</F>
        const std::size_t most =
            std::min(limits_.max_vertices + limits_.max_triangles, bytes_.size() / kShortest) +
            kOtherElements;
        std::size_t elements = 0, attributes = 0;
        char before = ' ';
        for (const char c : bytes_) {
            elements += before == '<' && c != '/' ? 1U : 0U;
            attributes += c == '=' ? 1U : 0U;
            before = c;
        }
        if (elements <= most && attributes <= 2 * most) return true;
        fault(FaultKind::TooLarge, "XML_TOO_LARGE",
              "The file has more elements or attributes than points and faces that are taken.");
        return false;
    }

    bool parse() {
        const auto result = document_.load_buffer(bytes_.data(), bytes_.size(),
                                                  pugi::parse_default | pugi::parse_doctype);
        for (const pugi::xml_node& node : document_.children()) {
            if (node.type() != pugi::node_doctype) continue;
            invalid("XML_DOCTYPE", "A DOCTYPE is not taken: leave it out.");
            return false;
        }
        if (result) return true;
        fault(FaultKind::Syntax, "XML_SYNTAX",
              "Line " + std::to_string(line_at(result.offset)) + ": " + result.description() + ".");
        return false;
    }

    void read_document() {
        const pugi::xml_node root = child_of(document_, "LandXML");
        if (!root)
            return invalid("LANDXML_MISSING", "The document is no LandXML: its element is " +
                                                  shown(name_of(document_.document_element())) +
                                                  ".");
        read_units(child_of(root, "Units"));
        if (const auto code = child_of(root, "CoordinateSystem").attribute("epsgCode")) {
            if (const auto crs = normalise_crs("EPSG:" + std::string(code.value())))
                terrain_.crs = *crs;
        }
        if (const pugi::xml_node surface = only_surface(root)) read_surface(surface);
    }

    void read_units(const pugi::xml_node& units) {
        pugi::xml_node system = child_of(units, "Metric");
        if (!system) system = child_of(units, "Imperial");
        if (!system) return;
        const std::string unit = system.attribute("linearUnit").value();
        const auto known = unit == "USSurveyFoot" ? std::optional<std::string>("US survey foot")
                                                  : normalise_unit(unit);
        if (!known)
            return invalid("UNIT_UNKNOWN", shown(unit) +
                                               " is no linear unit that is read: meter, foot and "
                                               "USSurveyFoot are (" +
                                               place(system) + ").");
        terrain_.unit = *known;
        terrain_.unit_is_said = true;
    }

    pugi::xml_node only_surface(const pugi::xml_node& root) {
        pugi::xml_node found;
        std::string names;
        std::size_t count = 0, others = 0;
        for (const pugi::xml_node& surfaces : root.children()) {
            if (name_of(surfaces) != "Surfaces") continue;
            for (const pugi::xml_node& surface : surfaces.children()) {
                if (name_of(surface) != "Surface") continue;
                const pugi::xml_node definition = child_of(surface, "Definition");
                const std::string_view type = definition.attribute("surfType").value();
                if (!child_of(definition, "Faces") || (!type.empty() && type != "TIN")) {
                    ++others;
                    continue;
                }
                found = surface;
                if (++count <= kMostNames)
                    names += (names.empty() ? "" : ", ") + shown(surface.attribute("name").value());
            }
        }
        if (count == 1) {
            if (others > 0)
                terrain_.notes.push_back(std::to_string(others) +
                                         " surfaces that are no TIN were passed over.");
            return found;
        }
        if (count > kMostNames) names += ", ...";
        if (count == 0)
            invalid("SURFACE_MISSING", "There is no surface that is a TIN, with points and faces.");
        else
            invalid("SURFACES", "There are " + std::to_string(count) + " TIN surfaces, " + names +
                                    ": leave one of them in the file.");
        return {};
    }

    void read_surface(const pugi::xml_node& surface) {
        terrain_.name = text_in_utf8(surface.attribute("name").value(), kLongestName);
        const pugi::xml_node definition = child_of(surface, "Definition");
        for (const pugi::xml_node& list : definition.children())
            if (name_of(list) == "Pnts") read_points(list);
        // Points that are at fault are not there, and would be missed by each face.
        if (!log_.empty()) return;
        for (const pugi::xml_node& list : definition.children())
            if (name_of(list) == "Faces") read_faces(list);
        leave_out_unused();
        const pugi::xml_node source = child_of(surface, "SourceData");
        for (const pugi::xml_node& list : source.children())
            if (name_of(list) == "Breaklines") read_breaklines(list);
        note_rest(source);
        name_places();
    }

    /// False: stop.
    bool go_on() {
        if (log_.full()) return false;
        if (++seen_ % kElementsBetweenLooks != 0 || !limits_.progress) return true;
        const double all = static_cast<double>(bytes_.size()) / 40.0;
        if (limits_.progress(std::min(1.0, static_cast<double>(seen_) / all))) return true;
        fault(FaultKind::Stopped, "STOPPED", reading_stopped().detail);
        return false;
    }

    void read_points(const pugi::xml_node& list) {
        for (const pugi::xml_node& point : list.children()) {
            if (name_of(point) != "P") continue;
            if (!go_on()) return;
            if (points_.size() >= limits_.max_vertices)
                return fault(
                    FaultKind::TooLarge, "TOO_MANY_VERTICES",
                    "No more than " + std::to_string(limits_.max_vertices) + " points are taken.");
            read_point(point);
        }
    }

    void read_point(const pugi::xml_node& point) {
        const std::string_view id = point.attribute("id").value();
        const std::string what = "Point " + shown(id) + " (";
        Words words(point.child_value());
        std::array<double, 3> p{};
        for (double& value : p) {
            const std::string_view word = words.next();
            const auto number = number_in<double>(word);
            if (!number)
                return invalid("LANDXML_POINT",
                               what + place(point) + ") is not \"northing easting elevation\".");
            value = *number;
            if (!(std::fabs(value) <= kMaxCoordinate))
                return invalid(
                    "COORDINATE_OUT_OF_RANGE",
                    what + place(point) + ") has a coordinate that is not finite, or beyond 1e9.");
        }
        if (!words.next().empty())
            return invalid("LANDXML_POINT", what + place(point) + ") has more than three numbers.");
        const auto number = static_cast<std::uint32_t>(points_.size());
        if (id.empty() || !by_id_.try_emplace(id, number).second)
            return invalid("LANDXML_ID", what + place(point) +
                                             (id.empty() ? ") has no id." : ") is there twice."));
        points_.push_back({p[1], p[0], p[2]});
        ids_.push_back(id);
    }

    void read_faces(const pugi::xml_node& list) {
        for (const pugi::xml_node& face : list.children()) {
            if (name_of(face) != "F") continue;
            if (!go_on()) return;
            ++face_;
            if (std::string_view(face.attribute("i").value()) == "1") continue;
            if (terrain_.mesh.triangles.size() >= limits_.max_triangles)
                return fault(
                    FaultKind::TooLarge, "TOO_MANY_TRIANGLES",
                    "No more than " + std::to_string(limits_.max_triangles) + " faces are taken.");
            read_face(face);
        }
    }

    void read_face(const pugi::xml_node& face) {
        const auto what = [&] {
            return "Face " + std::to_string(face_) + " (" + place(face) + ") ";
        };
        Words words(face.child_value());
        std::array<std::uint32_t, 3> corners{};
        for (std::uint32_t& corner : corners) {
            const std::string_view id = words.next();
            if (id.empty()) return invalid("LANDXML_FACE", what() + "names fewer than 3 points.");
            const auto found = by_id_.find(id);
            if (found == by_id_.end())
                return invalid("LANDXML_FACE",
                               what() + "names point " + shown(id) + ", which is not there.");
            corner = found->second;
        }
        if (!words.next().empty())
            return invalid("LANDXML_FACE", what() + "names more than 3 points: a TIN's has three.");
        const auto plan = [&](unsigned i) { return points_[corners[i]].plan(); };
        if (core::orientation(plan(0), plan(1), plan(2)) == core::Orientation::Clockwise)
            std::swap(corners[1], corners[2]);
        terrain_.mesh.triangles.push_back(corners);
        faces_.push_back(face_);
    }

    /// Those that run along edges of the mesh are constraints; of the others there is a note.
    void read_breaklines(const pugi::xml_node& list) {
        if (!log_.empty()) return;
        Breaklines lines(terrain_.mesh);
        std::vector<core::Point3> line;
        std::size_t passed_over = 0;
        for (const pugi::xml_node& breakline : list.children()) {
            if (!go_on()) return;
            const bool is_taken =
                read_places(child_of(breakline, "PntList3D"), line) && lines.take(line);
            if (!is_taken) ++passed_over;
        }
        if (passed_over > 0)
            terrain_.notes.push_back(std::to_string(passed_over) +
                                     " breaklines that do not run along edges of the faces were "
                                     "passed over.");
    }

    /// False: they are no positions.
    static bool read_places(const pugi::xml_node& list, std::vector<core::Point3>& out) {
        out.clear();
        std::array<double, 3> p{};
        std::size_t axis = 0;
        Words words(list.child_value());
        for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
            const auto number = number_in<double>(word);
            if (!number || !std::isfinite(*number)) return false;
            p[axis] = *number;
            if (++axis < p.size()) continue;
            axis = 0;
            out.push_back({p[1], p[0], p[2]});
        }
        return axis == 0;
    }

    void note_rest(const pugi::xml_node& source) {
        for (const pugi::xml_node& part : source.children()) {
            if (name_of(part) == "Breaklines") continue;
            const auto count = std::distance(part.begin(), part.end());
            terrain_.notes.push_back(shown(name_of(part)) + " of the source data, " +
                                     std::to_string(count) + ", were passed over.");
            if (terrain_.notes.size() > kMostNames) break;
        }
    }

    void leave_out_unused() {
        if (!log_.empty()) return;
        auto& mesh = terrain_.mesh;
        std::vector<std::uint32_t> now(points_.size(), UINT32_MAX);
        for (const auto& triangle : mesh.triangles)
            for (const std::uint32_t v : triangle)
                now[v] = 0;
        std::uint32_t kept = 0;
        for (std::uint32_t v = 0; v < now.size(); ++v) {
            if (now[v] == UINT32_MAX) continue;
            now[v] = kept++;
            mesh.vertices.push_back(points_[v]);
        }
        for (auto& triangle : mesh.triangles)
            for (std::uint32_t& v : triangle)
                v = now[v];
        if (kept < points_.size())
            terrain_.notes.push_back(std::to_string(points_.size() - kept) +
                                     " points that no visible face names were passed over.");
        std::erase_if(
            ids_, [&, v = std::size_t{0}](const auto&) mutable { return now[v++] == UINT32_MAX; });
    }

    void name_places() {
        terrain_.vertex_place =
            [ids = std::vector<std::string>(ids_.begin(), ids_.end())](std::size_t v) {
                return v < ids.size() ? "point " + shown(ids[v]) : std::string("a point");
            };
        terrain_.triangle_place = [faces = std::move(faces_)](std::size_t t) {
            return t < faces.size() ? "face " + std::to_string(faces[t]) : std::string("a face");
        };
    }

    static constexpr std::size_t kMostNames = 10;
    static constexpr std::size_t kLongestName = 200;

    std::string_view bytes_;
    const ReadLimits& limits_;
    FaultLog log_;
    Terrain terrain_;
    pugi::xml_document document_;
    std::vector<core::Point3> points_;
    std::vector<std::string_view> ids_;                          ///< of the points, in the document
    std::unordered_map<std::string_view, std::uint32_t> by_id_;  ///< looked up only
    std::vector<std::uint32_t> faces_;  ///< the number in the file of each triangle
    std::uint32_t face_ = 0;
    std::size_t seen_ = 0;
    std::size_t counted_ = 0;
    std::size_t line_ = 1;
};

}  // namespace

Parsed<Terrain> read_landxml(std::string_view bytes, const ReadLimits& limits) {
    return LandXmlReader(bytes, limits).read();
}

}  // namespace tinsmith::api
