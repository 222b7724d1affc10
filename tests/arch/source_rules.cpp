// SPDX-License-Identifier: Apache-2.0
#include "tests/arch/source_rules.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <regex>
#include <sstream>

namespace tinsmith::arch {
namespace {

constexpr std::size_t kMostLines = 400;

/// A folder may include itself and what stands before it.
constexpr std::array<std::string_view, 8> kOrder = {
    "core/types",   "core/predicates", "core/mesh", "core/integrate",
    "core/regions", "core/edit",       "api",       "server"};

/// What core may take from the standard library: no input or output, no clock, no chance, no
/// thread.
constexpr std::string_view kCoreHeaders =
    " algorithm array bit bitset cassert cfenv cfloat charconv climits cmath compare concepts"
    " cstddef cstdint cstring deque functional initializer_list iterator limits list map memory"
    " new numbers numeric optional queue ranges set source_location span stack string string_view"
    " tuple type_traits unordered_map unordered_set utility variant vector version ";

/// Where a third-party library may be included. Tests are outside of this: they see all.
struct Home {
    std::string_view library;
    const char* headers;  ///< regular expression for the name between the angle brackets
    const char* files;    ///< regular expression for the files that may include it
    bool one_file_only;
};
const std::array<Home, 17> kHomes = {{
    {"cpp-httplib", R"((cpp-httplib/)?httplib\.h)", R"(server/http/(library\.hpp|protocol\.cpp))",
     false},
    {"Draco", R"(draco/.*)", R"(api/formats/draco[a-z_]*\.cpp)", false},
    {"tinygltf", R"((tinygltf/)?tiny_gltf\.h)", R"(api/formats/gltf[a-z_]*\.cpp)", true},
    {"GDAL", R"((gdal/)?(gdal|ogr|cpl)[a-z_]*\.h)",
     R"(api/formats/(geotiff|gdal|raster)[a-z_]*\.cpp)", false},
    {"PROJ", R"(proj(_[a-z]+)?\.h)", R"(api/projection\.cpp)", true},
    {"meshoptimizer", R"(meshoptimizer\.h)", R"(api/formats/meshopt[a-z_]*\.cpp)", false},
    {"pugixml", R"(pugixml\.hpp)", R"(api/formats/landxml_[a-z_]*\.cpp)", false},
    {"GEOS", R"(geos(_c|/.*)?\.h)", R"(api/ring_offset\.cpp)", true},
    {"nlohmann-json", R"(nlohmann/.*)", R"((api|server)/.*\.cpp)", false},
    {"CLI11", R"(CLI/.*)", R"(server/.*\.cpp)", false},
    {"spdlog", R"((spdlog|fmt)/.*)", R"(server/.*\.cpp)", false},
    {"prometheus-cpp", R"(prometheus/.*)", R"(server/([a-z_]+/)*[a-z_]*metrics[a-z_/]*\.cpp)",
     false},
    {"OpenSSL", R"(openssl/.*)", R"(server/digest\.cpp)", true},
    {"zlib", R"(zlib\.h)", R"(api/formats/deflated\.cpp|server/gzip\.cpp)", false},
    {"SQLite", R"(sqlite3\.h)", R"(server/store/database\.cpp)", true},
    {"the system's memory", R"(sys/mman\.h)", R"(core/mesh/large_blocks\.cpp)", true},
    {"GoogleTest", R"((gtest|gmock)/.*)", R"(tests/.*)", false},
}};

struct Include {
    std::size_t line;
    std::string name;
    bool quoted;
};

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

std::vector<Include> includes_of(const std::string& text) {
    static const std::regex kPattern(R"re(^\s*#\s*include\s*([<"])([^>"]*)[>"].*)re");
    std::vector<Include> includes;
    const auto lines = lines_of(text);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        std::smatch match;
        if (std::regex_match(lines[i], match, kPattern))
            includes.push_back({i + 1, match[2], match[1] == "\""});
    }
    return includes;
}

bool is_under(std::string_view path, std::string_view folder) {
    return path.size() > folder.size() && path.starts_with(folder) && path[folder.size()] == '/';
}

/// The place of a path in kOrder, or nothing when its folder is not in the order.
std::optional<std::size_t> rank(std::string_view path) {
    for (std::size_t i = 0; i < kOrder.size(); ++i) {
        if (is_under(path, kOrder[i])) return i;
    }
    return std::nullopt;
}

bool is_core_header(const std::string& name) {
    return kCoreHeaders.find(" " + name + " ") != std::string_view::npos;
}
/// Whether the library lives there, or in just that file.
bool is_home_of(const std::string& path, const std::string& header, bool alone = true) {
    return std::any_of(kHomes.begin(), kHomes.end(), [&](const Home& home) {
        return (home.one_file_only || !alone) &&
               std::regex_match(header, std::regex(home.headers)) &&
               std::regex_match(path, std::regex(home.files));
    });
}
bool is_header(std::string_view path) {
    return path.ends_with(".hpp");
}
bool is_test(std::string_view path) {
    return is_under(path, "tests");
}

class FileCheck {
  public:
    explicit FileCheck(const Source& source) : source_(source) {}

    std::vector<Violation> run() {
        check_place();
        for (const Include& include : includes_of(source_.text)) {
            if (include.quoted) {
                check_own_include(include);
            } else {
                check_foreign_include(include);
            }
        }
        check_words();
        check_form();
        return std::move(violations_);
    }

  private:
    void report(std::size_t line, std::string what) {
        violations_.push_back({source_.path, line, std::move(what)});
    }

    void check_place() {
        if (!is_test(source_.path) && !rank(source_.path))
            report(0, "is in no folder of the order core, api, server");
    }

    void check_own_include(const Include& include) {
        if (is_test(include.name)) {
            if (!is_test(source_.path)) report(include.line, "includes the tests");
            return;
        }
        const auto theirs = rank(include.name);
        if (!theirs) {
            report(include.line, "\"" + include.name + "\" is no path from the project's root");
            return;
        }
        const auto ours = rank(source_.path);
        if (ours && *theirs > *ours)
            report(include.line, "includes " + include.name + " against the order");
    }

    void check_foreign_include(const Include& include) {
        if (is_test(source_.path)) return;
        if (is_under(source_.path, "core") && !is_core_header(include.name) &&
            !is_home_of(source_.path, include.name)) {
            report(include.line, "<" + include.name + "> is not for core");
            return;
        }
        if (is_header(source_.path) && include.name.find_first_of("./") != std::string::npos &&
            !is_home_of(source_.path, include.name, false))
            report(include.line, "<" + include.name + "> is not for a header");
        for (const Home& home : kHomes) {
            if (std::regex_match(include.name, std::regex(home.headers)) &&
                !std::regex_match(source_.path, std::regex(home.files)))
                report(include.line, std::string(home.library) + " lives elsewhere");
        }
    }

    void check_words() {
        static const std::regex kNarrow(R"(\bfloat\b)");
        static const std::regex kVagueType(
            R"(\b(class|struct|namespace)\s+\w*(utils?|helpers?|common|manager)\b)",
            std::regex::icase);
        static const std::regex kVaguePath(R"((^|[/_])(utils?|helpers?|common|manager)([/_.]|$))");
        if (std::regex_search(source_.path, kVaguePath)) report(0, "has a name that says nothing");
        const auto lines = lines_of(code_only(source_.text));
        for (std::size_t i = 0; i < lines.size(); ++i) {
            if (is_under(source_.path, "core") && std::regex_search(lines[i], kNarrow))
                report(i + 1, "float in core");
            if (std::regex_search(lines[i], kVagueType))
                report(i + 1, "declares a name that says nothing");
        }
    }

    void check_form() {
        const auto lines = lines_of(source_.text);
        if (lines.empty() || lines.front() != "// SPDX-License-Identifier: Apache-2.0")
            report(1, "does not begin with the licence line");
        if (is_header(source_.path) && source_.text.find("\n#pragma once\n") == std::string::npos)
            report(0, "has no #pragma once");
        if (lines.size() > kMostLines) report(0, "is longer than 400 lines");
    }

    const Source& source_;
    std::vector<Violation> violations_;
};

/// Where a literal that begins at `start` ends: the position after its last character.
std::size_t literal_end(std::string_view text, std::size_t start) {
    const char quote = text[start];
    std::size_t i = start + 1;
    while (i < text.size() && text[i] != quote && text[i] != '\n')
        i += text[i] == '\\' ? 2U : 1U;
    return std::min(i + 1, text.size());
}

/// The same for a raw literal whose opening quote is at `start`.
std::size_t raw_literal_end(std::string_view text, std::size_t start) {
    const std::size_t open = text.find('(', start);
    if (open == std::string_view::npos) return text.size();
    const std::string close = ")" + std::string(text.substr(start + 1, open - start - 1)) + "\"";
    const std::size_t end = text.find(close, open);
    return end == std::string_view::npos ? text.size() : end + close.size();
}

bool is_digit_separator(std::string_view text, std::size_t i) {
    return i > 0 && text[i] == '\'' && std::isxdigit(static_cast<unsigned char>(text[i - 1])) != 0;
}

}  // namespace

std::string code_only(std::string_view text) {
    std::string code(text);
    std::size_t i = 0;
    while (i < text.size()) {
        std::size_t end = i;
        if (text.substr(i, 2) == "//") {
            end = std::min(text.find('\n', i), text.size());
        } else if (text.substr(i, 2) == "/*") {
            const std::size_t close = text.find("*/", i + 2);
            end = close == std::string_view::npos ? text.size() : close + 2;
        } else if (text[i] == '"' && i > 0 && text[i - 1] == 'R') {
            end = raw_literal_end(text, i);
        } else if (text[i] == '"' || (text[i] == '\'' && !is_digit_separator(text, i))) {
            end = literal_end(text, i);
        }
        for (std::size_t k = i; k < end; ++k) {
            if (code[k] != '\n') code[k] = ' ';
        }
        i = std::max(end, i + 1);
    }
    return code;
}

std::vector<Violation> check_file(const Source& source) {
    return FileCheck(source).run();
}

std::vector<Violation> check_all(const std::vector<Source>& sources) {
    std::vector<Violation> violations;
    std::map<std::string_view, std::string> home_of;
    for (const Source& source : sources) {
        if (is_test(source.path)) continue;
        for (const Include& include : includes_of(source.text)) {
            for (const Home& home : kHomes) {
                if (!home.one_file_only ||
                    !std::regex_match(include.name, std::regex(home.headers)))
                    continue;
                const auto [entry, first] = home_of.try_emplace(home.library, source.path);
                if (!first && entry->second != source.path)
                    violations.push_back(
                        {source.path, include.line,
                         std::string(home.library) + " lives in " + entry->second + " already"});
            }
        }
    }
    return violations;
}

}  // namespace tinsmith::arch
