// SPDX-License-Identifier: Apache-2.0
// The binary as a command: outputs, complaints and exit codes.
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tests/e2e/program.hpp"

namespace tinsmith::e2e {
namespace {

using nlohmann::json;

const std::string kData = std::string(TINSMITH_SOURCE_DIR) + "/tests/data/";

class Command : public testing::Test {
  protected:
    /// Runs to the end and keeps what was printed.
    int run(std::vector<std::string> arguments) {
        Program program(std::move(arguments), scratch.file("output"));
        const int code = program.wait(std::chrono::seconds(120)).value_or(-1);
        output = program.output();
        return code;
    }

    ScratchDirectory scratch;
    std::string output;
};

TEST_F(Command, TellsVersionAndHelp) {
    EXPECT_EQ(run({"--version"}), 0);
    EXPECT_EQ(output.substr(0, 9), "tinsmith ");
    EXPECT_EQ(run({"--help"}), 0);
    EXPECT_NE(output.find("tinsmith serve --demo"), std::string::npos);
    EXPECT_EQ(run({"serve", "--prot", "1"}), 2);
    EXPECT_NE(output.find("--prot"), std::string::npos);
}

TEST_F(Command, RefusesAFolderWithNoPageInIt) {
    EXPECT_EQ(run({"serve", "--port", "0", "--viewer", scratch.file("nowhere")}), 1);
    EXPECT_NE(output.find("--viewer: "), std::string::npos) << output;
}

TEST_F(Command, IntegratesRealTerrain) {
    const std::string glb = scratch.file("out.glb");
    const std::string report = scratch.file("report.json");
    ASSERT_EQ(run({"integrate", kData + "jacksboro.tif", kData + "lake.geojson", "-o", glb,
                   "--report", report}),
              0)
        << output;
    EXPECT_EQ(output, "") << "no bar where there is no terminal";
    EXPECT_EQ(content_of(glb).substr(0, 4), "glTF");
    const auto told = json::parse(content_of(report));
    EXPECT_EQ(told["polygons"][0]["id"], "p1");
    EXPECT_GT(told["totals"]["crossings"], 0);
}

TEST_F(Command, KnowsCsvByItsFirstLine) {
    EXPECT_EQ(run({"check", kData + "spot_heights.csv"}), 0) << output;
    const std::string bad = scratch.file("bad.csv");
    std::ofstream(bad) << "0 0 1\n10 0 2\n0 10 north\n";
    EXPECT_EQ(run({"check", bad}), 1);
    EXPECT_NE(output.find("Line 3, column 6: \"north\" is no number"), std::string::npos) << output;
}

TEST_F(Command, ShowsABarOnATerminal) {
    const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
    ASSERT_GE(terminal, 0);
    ASSERT_EQ(::grantpt(terminal), 0);
    ASSERT_EQ(::unlockpt(terminal), 0);
    std::string shown;
    {
        Program program({"integrate", kData + "jacksboro.tif", kData + "contour_3500.geojson", "-o",
                         scratch.file("out.glb")},
                        ::ptsname(terminal));
        // Ends: the terminal reports an error once the program, which alone has it open, is gone.
        std::array<char, 4096> buffer{};
        for (;;) {
            const auto size = ::read(terminal, buffer.data(), buffer.size());
            if (size <= 0) break;
            shown.append(buffer.data(), static_cast<std::size_t>(size));
        }
        EXPECT_EQ(program.wait(), 0);
    }
    ::close(terminal);
    std::set<int> percents;
    for (std::size_t at = shown.find("] "); at != shown.npos; at = shown.find("] ", at + 1))
        percents.insert(std::atoi(shown.c_str() + at + 2));
    EXPECT_GE(percents.size(), 15U) << shown;
    for (const char* stage :
         {"reading the terrain", "reading the polygons", "integrating", "writing"})
        EXPECT_NE(shown.find(stage), std::string::npos) << stage;
    EXPECT_TRUE(shown.ends_with("\r\033[K")) << "the bar is taken away";
}

TEST_F(Command, ComplainsInReadableLines) {
    const std::string bad = scratch.file("bad.geojson");
    write_content(bad, R"({"type": "Polygon", "coordinates": [[[1,2],[3,"x"]]]})");
    const std::string glb = scratch.file("out.glb");
    EXPECT_EQ(run({"integrate", kData + "jacksboro.tif", bad, "-o", glb}), 1);
    EXPECT_NE(output.find("/coordinates/0"), std::string::npos) << output;
    EXPECT_EQ(content_of(glb), "");
    EXPECT_EQ(run({"integrate", "nowhere.tif", bad, "-o", glb}), 1);
    EXPECT_NE(output.find("nowhere.tif: No such file"), std::string::npos) << output;
}

TEST_F(Command, WritesThroughLinksAndIntoDevices) {
    const std::string file = scratch.file("file.glb");
    const std::string link = scratch.file("link.glb");
    const std::string device = scratch.file("device.glb");
    write_content(file, "old");
    std::filesystem::create_symlink(file, link);
    std::filesystem::create_symlink("/dev/full", device);
    EXPECT_EQ(run({"integrate", kData + "jacksboro.tif", kData + "lake.geojson", "-o", link}), 0);
    EXPECT_TRUE(std::filesystem::is_symlink(link));
    EXPECT_EQ(content_of(file).substr(0, 4), "glTF");
    EXPECT_EQ(run({"integrate", kData + "jacksboro.tif", kData + "lake.geojson", "-o", device}), 1);
    EXPECT_NE(output.find("device.glb: No space left on device"), std::string::npos) << output;
    EXPECT_TRUE(std::filesystem::is_character_file(device)) << "the device is not replaced";
}

TEST_F(Command, JudgesOptionsBeforeItWorks) {
    const std::string glb = scratch.file("out.glb");
    EXPECT_EQ(run({"integrate", "nowhere.tif", "nowhere.json", "-o", glb, "--improve", "quick",
                   "--tolerance", "0"}),
              2);
    EXPECT_NE(output.find("improve"), std::string::npos) << output;
    EXPECT_NE(output.find("tolerance"), std::string::npos) << output;
    EXPECT_EQ(run({"integrate", "nowhere.tif", "nowhere.json", "-o", glb, "--report", glb}), 2);
    EXPECT_NE(output.find("one file"), std::string::npos) << output;
}

TEST_F(Command, TakesOptionsFromFlagsAndFile) {
    const std::string terrain = scratch.file("terrain.json");
    write_content(terrain, R"({"mesh": {"vertices": [[0,0,0],[10,0,1],[10,10,2],[0,10,3]],
                                        "triangles": [[0,1,2],[0,2,3]]}})");
    const std::string polygons = scratch.file("pad.json");
    write_content(polygons, R"({"type": "Polygon", "tinsmith": {"elevation": "own"},
        "coordinates": [[[2,1,5],[5,1,5],[5,4,5],[2,4,5],[2,1,5]]]})");
    const std::string report = scratch.file("report.json");
    const std::vector<std::string> start{
        "integrate", terrain, polygons, "-o", scratch.file("out.glb"), "--report", report};
    const auto with = [&start](std::vector<std::string> flags) {
        flags.insert(flags.begin(), start.begin(), start.end());
        return flags;
    };
    EXPECT_EQ(run(with({"--on-crossing", "old", "--lock", "true", "--snap", "0.01"})), 0) << output;
    EXPECT_GT(json::parse(content_of(report))["polygons"][0]["max_elevation_change"], 4.0);
    EXPECT_EQ(run(with({"--elevation", "drape"})), 1);
    EXPECT_NE(output.find("/tinsmith/elevation: CONTRADICTION"), std::string::npos) << output;
    EXPECT_EQ(run(with({"--improve", "bounded"})), 1);
    EXPECT_NE(output.find("improve=bounded needs max_deviation"), std::string::npos) << output;
    EXPECT_EQ(run(with({"--improve", "bounded", "--max-deviation", "0"})), 2);
    EXPECT_NE(output.find("max_deviation cannot be \"0\""), std::string::npos) << output;
}

TEST_F(Command, ChecksMeshes) {
    const std::string good = scratch.file("good.json");
    write_content(good, R"({"mesh": {"vertices": [[0,0,0],[1,0,0],[0,1,0]],
                                     "triangles": [[0,1,2]]}})");
    EXPECT_EQ(run({"check", good}), 0) << output;
    const std::string flat = scratch.file("flat.json");
    write_content(flat, R"({"mesh": {"vertices": [[0,0,0],[1,0,0],[2,0,0]],
                                     "triangles": [[0,1,2]]}})");
    EXPECT_EQ(run({"check", flat}), 1);
    EXPECT_NE(output.find("TRIANGLE_FLAT"), std::string::npos) << output;
}

}  // namespace
}  // namespace tinsmith::e2e
