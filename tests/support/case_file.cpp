// SPDX-License-Identifier: Apache-2.0
#include "tests/support/case_file.hpp"

#include <array>
#include <charconv>
#include <fstream>
#include <istream>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace tinsmith::test {

using core::IntegrateOptions;
using core::Path;

namespace {

constexpr std::array<std::string_view, 4> kImproveWords{"none", "strict", "paper", "bounded"};

std::string number(double value) {
    std::array<char, 32> text;
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

void write_options(std::ostream& out, const IntegrateOptions& options) {
    const IntegrateOptions usual;
    out << "request " << kImproveWords.at(static_cast<std::size_t>(options.improve)) << '\n';
    if (options.max_deviation != usual.max_deviation)
        out << "max_deviation " << number(options.max_deviation) << '\n';
    if (options.snap != usual.snap) out << "snap " << number(options.snap) << '\n';
    if (options.outside == core::Outside::Reject) out << "outside reject\n";
    if (options.on_crossing == core::OnCrossing::Old) out << "on_crossing old\n";
    if (options.lock) out << "lock\n";
}

void write_path(std::ostream& out, const Path& path) {
    out << (path.closed ? "path closed\n" : "path open\n");
    for (std::size_t i = 0; i < path.points.size(); ++i) {
        out << "point " << number(path.points[i].x) << ' ' << number(path.points[i].y);
        if (!path.elevations.empty()) out << ' ' << number(path.elevations.at(i));
        out << '\n';
    }
}

/// The words of a line, taken one by one.
class Words {
  public:
    explicit Words(const std::string& line) : in_(line) {}

    std::string word() {
        std::string next;
        if (!(in_ >> next)) throw std::runtime_error("a word is missing");
        return next;
    }
    template <typename Number>
    Number value() {
        const std::string text = word();
        Number result{};
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), result);
        if (error != std::errc{} || end != text.data() + text.size())
            throw std::runtime_error(text + " is no number");
        return result;
    }
    bool more() { return !(in_ >> std::ws).eof(); }

  private:
    std::istringstream in_;
};

core::Improve improve_of(const std::string& word) {
    for (std::size_t i = 0; i < kImproveWords.size(); ++i)
        if (word == kImproveWords.at(i)) return static_cast<core::Improve>(i);
    throw std::runtime_error(word + " is no way to improve");
}

/// Whether the word is the one of two that is not the usual.
bool is_other(const std::string& word, std::string_view usual, std::string_view other) {
    if (word != usual && word != other) throw std::runtime_error(word + " is not known here");
    return word == other;
}

template <typename Item>
Item& last(std::vector<Item>& items, const char* what) {
    if (items.empty()) throw std::runtime_error(std::string("no ") + what + " yet");
    return items.back();
}

void read_option(const std::string& key, Words& words, IntegrateOptions& options) {
    if (key == "snap")
        options.snap = words.value<double>();
    else if (key == "max_deviation")
        options.max_deviation = words.value<double>();
    else if (key == "lock")
        options.lock = true;
    else if (key == "outside")
        options.outside =
            is_other(words.word(), "skip", "reject") ? core::Outside::Reject : core::Outside::Skip;
    else if (key == "on_crossing")
        options.on_crossing =
            is_other(words.word(), "new", "old") ? core::OnCrossing::Old : core::OnCrossing::New;
    else
        throw std::runtime_error(key + " is not known");
}

void read_point(Words& words, Path& path) {
    const double x = words.value<double>();
    path.points.push_back({x, words.value<double>()});
    if (words.more()) path.elevations.push_back(words.value<double>());
    if (!path.elevations.empty() && path.elevations.size() != path.points.size())
        throw std::runtime_error("some points of the path have an elevation and others have not");
}

void read_line(const std::string& line, Case& result) {
    if (line.starts_with('#')) {
        result.notes.push_back(line.substr(line.starts_with("# ") ? 2 : 1));
        return;
    }
    Words words(line);
    if (!words.more()) return;
    const std::string key = words.word();
    if (key == "vertex") {
        const double x = words.value<double>(), y = words.value<double>();
        result.mesh.vertices.push_back({x, y, words.value<double>()});
    } else if (key == "triangle") {
        const auto a = words.value<std::uint32_t>(), b = words.value<std::uint32_t>();
        result.mesh.triangles.push_back({a, b, words.value<std::uint32_t>()});
    } else if (key == "constraint") {
        const auto a = words.value<std::uint32_t>();
        result.mesh.constraints.push_back({a, words.value<std::uint32_t>()});
    } else if (key == "request") {
        result.requests.emplace_back();
        result.requests.back().options.improve = improve_of(words.word());
    } else if (key == "shape") {
        last(result.requests, "request").shapes.emplace_back();
    } else if (key == "path") {
        auto& paths = last(last(result.requests, "request").shapes, "shape").paths;
        paths.emplace_back();
        paths.back().closed = is_other(words.word(), "open", "closed");
    } else if (key == "point") {
        auto& shape = last(last(result.requests, "request").shapes, "shape");
        read_point(words, last(shape.paths, "path"));
    } else {
        read_option(key, words, last(result.requests, "request").options);
    }
    if (words.more()) throw std::runtime_error("there is more in the line than belongs to it");
}

}  // namespace

void write_case(std::ostream& out, const Case& written) {
    for (const std::string& note : written.notes)
        out << (note.empty() ? "#" : "# ") << note << '\n';
    for (const auto& v : written.mesh.vertices)
        out << "vertex " << number(v.x) << ' ' << number(v.y) << ' ' << number(v.z) << '\n';
    for (const auto& [a, b, c] : written.mesh.triangles)
        out << "triangle " << a << ' ' << b << ' ' << c << '\n';
    for (const auto& [a, b] : written.mesh.constraints)
        out << "constraint " << a << ' ' << b << '\n';
    for (const Request& request : written.requests) {
        write_options(out, request.options);
        for (const auto& shape : request.shapes) {
            out << "shape\n";
            for (const Path& path : shape.paths)
                write_path(out, path);
        }
    }
}

std::string case_text(const Case& written) {
    std::ostringstream out;
    write_case(out, written);
    return out.str();
}

Case read_case(std::istream& in) {
    Case result;
    std::string line;
    for (std::size_t number = 1; std::getline(in, line); ++number) {
        try {
            read_line(line, result);
        } catch (const std::runtime_error& fault) {
            throw std::runtime_error("line " + std::to_string(number) + ": " + fault.what());
        }
    }
    return result;
}

Case read_case_file(const std::string& path) {
    std::ifstream in(path);
    if (!in) throw std::runtime_error("cannot read " + path);
    return read_case(in);
}

}  // namespace tinsmith::test
