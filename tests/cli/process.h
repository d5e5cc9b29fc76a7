// Starts the built tool beside the test, to send it signals.
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/cli/tool.h"

namespace sightline {

/// One running tool; killed at the end of its life, should it still run.
class Process {
public:
    /// Runs it in a directory, with its output in the files .out and .err there.
    Process(const std::filesystem::path& directory, const std::vector<std::string>& arguments) {
        pid_ = ::fork();
        if (pid_ == 0) {
            become(directory, arguments, true);
            ::_exit(127);
        }
    }
    ~Process() {
        if (pid_ <= 0) return;
        ::kill(pid_, SIGKILL);
        ::waitpid(pid_, nullptr, 0);
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    void send(int signal) const { ::kill(pid_, signal); }

    /// True once it catches a signal.
    bool hears(int signal) const {
        std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
        for (std::string word; status >> word;)
            if (word == "SigCgt:" && status >> word) return std::stoull(word, nullptr, 16) >> (signal - 1) & 1;
        return false;
    }

    /// Waits for its end. Minus the signal that ended it, if one did.
    int join() {
        int status = 0;
        ::waitpid(pid_, &status, 0);
        pid_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }

    /// Whether this machine gives out terminals: a change of root without /dev/pts does not.
    static bool hasTerminals() {
        int terminal = -1, other = -1;
        if (::openpty(&terminal, &other, nullptr, nullptr, nullptr) != 0) return false;
        ::close(terminal);
        ::close(other);
        return true;
    }

    /// What it writes on a terminal of its own, standard error included, until it ends.
    static std::string onTerminal(const std::filesystem::path& directory, const std::vector<std::string>& arguments) {
        int terminal = -1;
        const pid_t pid = ::forkpty(&terminal, nullptr, nullptr, nullptr);
        if (pid == 0) {
            become(directory, arguments, false);
            ::_exit(127);
        }
        std::string text;
        char bytes[4096];
        for (ssize_t count = 0; (count = ::read(terminal, bytes, sizeof bytes)) > 0;)
            text.append(bytes, static_cast<size_t>(count));
        ::waitpid(pid, nullptr, 0);
        ::close(terminal);
        return text;
    }

private:
    static void become(const std::filesystem::path& directory, const std::vector<std::string>& arguments, bool files) {
        if (::chdir(directory.c_str()) != 0) return;
        ::signal(SIGINT, SIG_DFL);  // whoever runs the tests in the background has it ignored
        if (files) {
            constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC;
            ::dup2(::open(".out", kFlags, 0600), STDOUT_FILENO);
            ::dup2(::open(".err", kFlags, 0600), STDERR_FILENO);
        }
        std::vector<char*> words = {const_cast<char*>(SIGHTLINE_TOOL)};
        for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
        words.push_back(nullptr);
        ::execv(SIGHTLINE_TOOL, words.data());
    }

    pid_t pid_ = -1;
};

/// Looks again and again until something holds; false if it does not within a minute.
template <class Condition>
bool eventually(const Condition& holds) {
    for (int i = 0; i < 6000; ++i) {
        if (holds()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

}  // namespace sightline
