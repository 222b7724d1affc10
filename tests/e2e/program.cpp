// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/program.hpp"

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/e2e/wire.hpp"

namespace tinsmith::e2e {

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kPoll = std::chrono::milliseconds(10);

/// Waits for a condition by asking again and again, but not for ever.
template <typename Condition>
bool becomes_true(Condition condition, std::chrono::seconds longest) {
    const auto deadline = Clock::now() + longest;
    while (!condition()) {
        if (Clock::now() > deadline) return false;
        std::this_thread::sleep_for(kPoll);
    }
    return true;
}

[[noreturn]] void become(const std::vector<std::string>& arguments, int output) {
    std::vector<char*> argv;
    const char* other = std::getenv("TINSMITH_PROGRAM");
    std::string program = other != nullptr ? other : TINSMITH_BINARY;
    argv.push_back(program.data());
    std::vector<std::string> copies = arguments;
    for (std::string& argument : copies)
        argv.push_back(argument.data());
    argv.push_back(nullptr);
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    ::execv(program.c_str(), argv.data());
    ::_exit(127);
}

}  // namespace

ScratchDirectory::ScratchDirectory() {
    std::string pattern = (std::filesystem::temp_directory_path() / "tinsmith.XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
}

ScratchDirectory::~ScratchDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::string content_of(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

void write_content(const std::string& path, const std::string& content) {
    std::ofstream(path, std::ios::binary) << content;
}

Program::Program(std::vector<std::string> arguments, const std::string& output) : output_(output) {
    const int file = ::open(output.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0600);
    pid_ = ::fork();
    if (pid_ == 0) become(arguments, file);
    ::close(file);
}

Program::~Program() {
    if (!is_running()) return;
    send_signal(SIGKILL);
    collect(0);
}

void Program::send_signal(int signal) const {
    if (pid_ > 0 && !exit_code_) ::kill(pid_, signal);
}

void Program::collect(int options) {
    int status = 0;
    if (exit_code_ || ::waitpid(pid_, &status, options) != pid_) return;
    exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool Program::is_running() {
    collect(WNOHANG);
    return !exit_code_;
}

std::optional<int> Program::wait(std::chrono::seconds longest) {
    becomes_true([this] { return !is_running(); }, longest);
    return exit_code_;
}

std::string complaints_in(const std::string& log) {
    std::string complaints;
    std::size_t start = 0;
    for (std::size_t end = 0; (end = log.find('\n', start)) != std::string::npos; start = end + 1) {
        const std::string line = log.substr(start, end - start);
        // Sanitizers write lines of their own.
        const auto event = nlohmann::json::parse(line, nullptr, false);
        const bool is_event = event.is_object() && event.contains("level");
        if (!is_event || (event["level"] != "info" && event["level"] != "debug"))
            complaints += line + "\n";
    }
    return complaints;
}

ServerUnderTest::ServerUnderTest(std::vector<std::string> arguments) {
    const std::string port_file = scratch_.file("port");
    arguments.insert(arguments.begin(), {"serve", "--port", "0", "--port-file", port_file});
    program_.emplace(std::move(arguments), scratch_.file("log"));
    becomes_true(
        [this, &port_file] {
            return std::filesystem::exists(port_file) || !program_->is_running();
        },
        std::chrono::seconds(60));
    port_ = std::atoi(content_of(port_file).c_str());
    const bool is_healthy =
        port_ != 0 && becomes_true([this] { return ask(port_, "GET", "/readyz").status == 200; },
                                   std::chrono::seconds(10));
    if (!is_healthy) port_ = 0;
}

std::string ServerUnderTest::stop() {
    std::string complaints;
    program_->send_signal(SIGTERM);
    const auto code = program_->wait();
    if (code != 0) {
        complaints += code ? "exit code " + std::to_string(*code) + "\n" : "does not stop\n";
    }
    return complaints + complaints_in(program_->output());
}

}  // namespace tinsmith::e2e
