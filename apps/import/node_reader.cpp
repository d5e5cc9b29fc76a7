// Lets a script for Node.js read IFC, by web-ifc, and takes its place until it ends.
// SPDX-License-Identifier: MIT
#include "apps/import/node_reader.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include <fmt/core.h>

#include "sightline/tools/import/foreign/ifc_needs.h"
#include "sightline/tools/import/foreign/scene_stream.h"

namespace sightline::import {
namespace {

/// Whole memory of a JavaScript engine is counted as what it may write: it reserves far more addresses than it uses.
void limitData(uint64_t bytes) {
    rlimit now{};
    if (bytes == 0 || getrlimit(RLIMIT_DATA, &now) != 0) return;
    now.rlim_cur = now.rlim_max = std::min<rlim_t>(bytes, now.rlim_max);
    setrlimit(RLIMIT_DATA, &now);
}

[[noreturn]] void runScript(const std::vector<std::string>& words, uint64_t memory, int errors) {
    dup2(errors, STDERR_FILENO);
    limitData(memory);
    for (const char* name : {"NODE_OPTIONS", "NODE_PATH"})
        unsetenv(name);  // it runs what stands beside it, and that alone
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    execv(words[0].c_str(), arguments.data());
    _exit(127);
}

/// Reads to the end what the script says of its own death. True: it lacked memory.
bool lacksMemory(int errors) {
    std::string tail;
    bool out = false;
    std::array<char, 4096> block;
    for (;;) {
        const ssize_t got = read(errors, block.data(), block.size());
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return out;
        tail.append(block.data(), size_t(got));
        for (const char* words : {"out of memory", "Out of memory", "llocation fail", "bad_alloc"})
            out |= tail.find(words) != std::string::npos;
        if (tail.size() > block.size()) tail.erase(0, tail.size() - 64);
    }
}

[[noreturn]] void endAs(int status, bool lacks_memory) {
    if (lacks_memory) _exit(tools::kImportOutOfMemory);
    if (WIFSIGNALED(status)) {
        signal(WTERMSIG(status), SIG_DFL);
        raise(WTERMSIG(status));
    }
    _exit(WIFEXITED(status) ? WEXITSTATUS(status) : 1);
}

}  // namespace

std::string readWithNode(const std::string& file, const std::string& suffix, uint64_t memory) {
    const tools::IfcNeeds needs = tools::findIfcNeeds("/proc/self/exe");
    if (!needs.lacks.empty()) return needs.lacks;
    // With less the engine itself dies, each time in other words.
    constexpr uint64_t kLeast = uint64_t(256) << 20;
    if (memory != 0 && memory < kLeast) _exit(tools::kImportOutOfMemory);
    std::vector<std::string> words{needs.node};
    if (memory != 0) words.push_back(fmt::format("--max-old-space-size={}", std::max<uint64_t>(64, memory >> 20)));
    words.insert(words.end(), {needs.script, file, suffix});

    int errors[2];
    if (pipe2(errors, O_CLOEXEC) != 0) return fmt::format("Node.js cannot be started: {}", std::strerror(errno));
    const pid_t self = getpid(), child = fork();
    if (child < 0) return fmt::format("Node.js cannot be started: {}", std::strerror(errno));
    if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (getppid() != self) _exit(1);  // it ended before we could ask
        runScript(words, memory, errors[1]);
    }
    close(errors[1]);
    close(STDOUT_FILENO);  // so that who reads it sees the script's end
    const bool lacks_memory = lacksMemory(errors[0]);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {}
    endAs(status, lacks_memory);
}

}  // namespace sightline::import
