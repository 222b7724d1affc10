// SPDX-License-Identifier: Apache-2.0
// The house's rules, held against every source file of the project, and the rules themselves held
// against planted faults: a check that cannot fail checks nothing.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/arch/source_rules.hpp"

namespace tinsmith::arch {
namespace {

namespace fs = std::filesystem;

std::vector<Source> project_sources() {
    const fs::path root = TINSMITH_SOURCE_DIR;
    std::vector<Source> sources;
    for (const char* folder : {"core", "api", "server", "tests"}) {
        for (auto entry = fs::recursive_directory_iterator(root / folder);
             entry != fs::recursive_directory_iterator(); ++entry) {
            if (entry->path().filename() == "node_modules") {
                entry.disable_recursion_pending();
                continue;
            }
            const auto extension = entry->path().extension();
            if (extension != ".cpp" && extension != ".hpp") continue;
            std::ostringstream text;
            text << std::ifstream(entry->path()).rdbuf();
            sources.push_back({fs::relative(entry->path(), root).generic_string(), text.str()});
        }
    }
    std::ranges::sort(sources, {}, &Source::path);
    return sources;
}

std::string listing(const std::vector<Violation>& violations) {
    std::string text;
    for (const Violation& v : violations)
        text += v.path + ":" + std::to_string(v.line) + ": " + v.what + "\n";
    return text;
}

TEST(Project, KeepsEveryRuleInEveryFile) {
    const auto sources = project_sources();
    ASSERT_GT(sources.size(), 10u) << "the sources were not found";
    std::vector<Violation> violations = check_all(sources);
    for (const Source& source : sources) {
        const auto more = check_file(source);
        violations.insert(violations.end(), more.begin(), more.end());
    }
    EXPECT_TRUE(violations.empty()) << listing(violations);
}

/// What the rules say of a file that is sound but for `body`.
std::string verdict(const std::string& path, const std::string& body) {
    const std::string guard = path.ends_with(".hpp") ? "#pragma once\n" : "";
    return listing(
        check_file({path, "// SPDX-License-Identifier: Apache-2.0\n" + guard + body + "\n"}));
}

TEST(Rules, PassASoundFile) {
    EXPECT_EQ(verdict("core/edit/trim.cpp", "#include \"core/edit/trim.hpp\"\n#include <vector>"),
              "");
    EXPECT_EQ(verdict("server/http/protocol.cpp", "#include <httplib.h>"), "");
    EXPECT_EQ(verdict("tests/unit/a_test.cpp", "#include \"server/router.hpp\""), "");
}

TEST(Rules, CatchAnIncludeAgainstTheOrder) {
    EXPECT_EQ(verdict("core/mesh/tin.cpp", "#include \"core/edit/trim.hpp\""),
              "core/mesh/tin.cpp:2: includes core/edit/trim.hpp against the order\n");
    EXPECT_NE(verdict("core/types/point.hpp", "#include \"core/predicates/orient.hpp\""), "");
    EXPECT_NE(verdict("core/edit/trim.cpp", "#include \"api/problem.hpp\""), "");
    EXPECT_NE(verdict("api/problem.cpp", "  #  include \"server/log.hpp\""), "");
    EXPECT_NE(verdict("server/main.cpp", "#include \"tests/support/grid.hpp\""), "");
}

TEST(Rules, CatchAPathThatIsNotFromTheRoot) {
    EXPECT_NE(verdict("core/mesh/tin.cpp", "#include \"tin.hpp\""), "");
    EXPECT_NE(verdict("core/mesh/tin.cpp", "#include \"../types/ids.hpp\""), "");
    EXPECT_NE(verdict("core/extras/tin.cpp", ""), "");
}

TEST(Rules, CatchWhatIsNotForCore) {
    for (const char* header : {"thread", "mutex", "chrono", "random", "iostream", "fstream",
                               "filesystem", "cstdlib", "atomic", "nlohmann/json.hpp"})
        EXPECT_NE(verdict("core/mesh/tin.cpp", "#include <" + std::string(header) + ">"), "")
            << header;
    EXPECT_NE(verdict("core/mesh/tin.cpp", "const float x = 0;"), "");
    EXPECT_EQ(verdict("core/mesh/tin.cpp", "// a float\nconst char* s = \"float\";"), "");
    EXPECT_EQ(verdict("api/formats/gltf.cpp", "const float x = 0;"), "");
}

TEST(Rules, CatchALibraryAwayFromHome) {
    EXPECT_NE(verdict("server/router.cpp", "#include <httplib.h>"), "");
    EXPECT_NE(verdict("api/formats/gltf.cpp", "#include <draco/mesh/mesh.h>"), "");
    EXPECT_NE(verdict("server/router.cpp", "#include <tiny_gltf.h>"), "");
    EXPECT_NE(verdict("api/formats/geojson.cpp", "#include <gdal_priv.h>"), "");
    EXPECT_NE(verdict("api/problem.hpp", "#include <nlohmann/json.hpp>"), "");
    EXPECT_NE(verdict("api/problem.cpp", "#include <spdlog/spdlog.h>"), "");
    EXPECT_NE(verdict("server/session.cpp", "#include <gtest/gtest.h>"), "");
    EXPECT_EQ(verdict("api/problem.cpp", "#include <nlohmann/json.hpp>"), "");
    EXPECT_NE(verdict("server/http/guard.hpp", "#include <httplib.h>"), "");
    EXPECT_EQ(verdict("server/http/library.hpp", "#pragma once\n#include <httplib.h>"), "");
}

TEST(Rules, CatchASecondHome) {
    const Source first{"api/formats/gltf_reader.cpp", "#include <tiny_gltf.h>\n"};
    const Source second{"api/formats/gltf_writer.cpp", "\n#include <tiny_gltf.h>\n"};
    EXPECT_TRUE(check_all({first}).empty());
    EXPECT_EQ(listing(check_all({first, second})),
              "api/formats/gltf_writer.cpp:2: tinygltf lives in "
              "api/formats/gltf_reader.cpp already\n");
}

TEST(Rules, CatchNamesAndForm) {
    EXPECT_NE(verdict("api/string_utils.cpp", ""), "");
    EXPECT_NE(verdict("server/helpers/log.cpp", ""), "");
    EXPECT_NE(verdict("server/log.cpp", "class SessionManager {};"), "");
    EXPECT_NE(verdict("server/log.cpp", "namespace utils {}"), "");
    EXPECT_NE(verdict("server/log.cpp", std::string(400, '\n')), "");
    EXPECT_EQ(listing(check_file({"server/log.hpp", "int x;\n"})),
              "server/log.hpp:1: does not begin with the licence line\n"
              "server/log.hpp:0: has no #pragma once\n");
}

TEST(CodeOnly, BlanksCommentsAndLiterals) {
    EXPECT_EQ(code_only("a /* b\nc */ d"), "a     \n     d");
    EXPECT_EQ(code_only("x = \"a\\\"b\"; // y"), "x =       ;     ");
    EXPECT_EQ(code_only("n = 1'000; f('\\''); g"), "n = 1'000; f(    ); g");
    EXPECT_EQ(code_only("R\"(a\"b)\" c"), "R        c");
}

}  // namespace
}  // namespace tinsmith::arch
