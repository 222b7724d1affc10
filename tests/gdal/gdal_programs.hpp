// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

namespace tinsmith::testing {

/// A folder for files that GDAL's programs read and write, gone at the end.
class Workshop {
  public:
    Workshop() {
        static int count = 0;
        folder_ = std::filesystem::temp_directory_path() /
                  ("tinsmith-gdal-" + std::to_string(getpid()) + "-" + std::to_string(++count));
        std::filesystem::create_directories(folder_);
    }
    Workshop(const Workshop&) = delete;
    Workshop& operator=(const Workshop&) = delete;
    ~Workshop() { std::filesystem::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    void write(const std::string& name, const std::string& bytes) const {
        std::ofstream(path(name), std::ios::binary) << bytes;
    }
    std::string read(const std::string& name) const {
        std::ifstream in(path(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    /// Runs a command there and returns what it prints; it must succeed.
    std::string run(const std::string& command) const {
        const int status = std::system(
            ("cd '" + folder_.string() + "' && " + command + " > said.txt 2>&1").c_str());
        const std::string said = read("said.txt");
        EXPECT_EQ(status, 0) << command << "\n" << said;
        return said;
    }

  private:
    std::filesystem::path folder_;
};

}  // namespace tinsmith::testing
