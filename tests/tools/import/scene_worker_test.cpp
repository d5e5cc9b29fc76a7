// Whatever becomes of the process that reads, the one that asked goes on with a scene or one line.
// SPDX-License-Identifier: MIT
#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <sstream>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "foreign_files.h"
#include "foreign_reading.h"
#include "scene_stream_samples.h"
#include "sightline/base/random.h"
#include "sightline/base/sanitized.h"
#include "sightline/tools/import/foreign/foreign.h"

namespace sightline {
using namespace tools;
namespace {

using namespace test;

class SceneWorker : public SceneFiles {
protected:
    void SetUp() override {
        SceneFiles::SetUp();
        file_ = write("scene.obj", objText(twoBoxes()));
    }
    void expectRefusedBy(const std::string& lines, const std::string& words) {
        settings_.worker = script("worker", lines);
        expectRefused(file_, words);
    }
    std::string file_;
};

size_t openFiles() {
    size_t count = 0;
    DIR* const list = opendir("/proc/self/fd");
    while (readdir(list)) ++count;
    closedir(list);
    return count;
}

TEST_F(SceneWorker, AGoodStreamIsAScene) {
    write("stream", streamOf(sampleScene()));
    settings_.worker = script("worker", "cat " + path("stream"));
    const Result<Scene> scene = load(file_);
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    EXPECT_EQ(scene->objects.size(), 3u);
}

TEST_F(SceneWorker, ScenesFarFromTheOriginAreNotedOnce) {
    const auto notesOf = [&](const Scene& scene, double scale) {
        write("stream", streamOf(scene));
        settings_.worker = script("worker", "cat " + path("stream"));
        settings_.scale = scale;
        std::vector<std::string> notes;
        settings_.note = [&](const std::string& words) { notes.push_back(words); };
        EXPECT_TRUE(load(file_).ok());
        std::erase_if(notes, [](const std::string& words) { return words.find("32-bit") == std::string::npos; });
        return notes;
    };
    EXPECT_TRUE(notesOf(sampleScene(), 1).empty());
    Scene far = sampleScene();
    for (SceneObject& object : far.objects) object.transform[3].x = 5.4e6;
    const std::vector<std::string> notes = notesOf(far, 1);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes[0], file_ +
                            ": points may be off by up to 322 mm: coordinates reach 5400 km, and this format is "
                            "read in 32-bit numbers. Move the model near the origin, or export it as glTF");
    EXPECT_TRUE(notesOf(far, 1e-3).empty()) << "5.4 km, in millimetres";
    // A place takes vertices back to the origin, and not their digits.
    Scene back = sampleScene();
    for (Mesh& mesh : back.meshes)
        for (glm::vec3& position : mesh.positions) position.z += 2e7f;
    for (SceneObject& object : back.objects) object.transform[3].z = -2e7;
    EXPECT_EQ(notesOf(back, 1).size(), 1u);
}

TEST_F(SceneWorker, MayHangAfterItsEndOrIgnoreRequests) {
    write("stream", streamOf(sampleScene()));
    settings_.worker = script("worker", "trap '' TERM INT HUP; cat " + path("stream") + "; sleep 1000");
    EXPECT_TRUE(load(file_).ok());
}

TEST_F(SceneWorker, CrashesAreOneLine) {
    expectRefusedBy("kill -SEGV $$", "the reader crashed on it (Segmentation fault)");
    expectRefusedBy("kill -ABRT $$", "the reader crashed on it (Aborted)");
    expectRefusedBy("kill -KILL $$", "its reader was killed");
    expectRefusedBy("exit 3", "its reader ended without a word (exit code 3)");
    expectRefusedBy("exit 12", "needs more memory than 2 GiB (--import-memory)");
    expectRefusedBy("kill -XCPU $$", "took longer than 60 s");
    // With what was read then, where the reader has told.
    std::string begun;
    SceneStreamWriter writer(
        [&](const void* bytes, size_t size) { begun.append(static_cast<const char*>(bytes), size); });
    writer.part("IfcWall #12");
    write("begun", begun);
    const std::string tell = "cat " + path("begun") + "; ";
    expectRefusedBy(tell + "kill -SEGV $$", "(Segmentation fault), at IfcWall #12: leave that out of the file");
    expectRefusedBy(tell + "kill -XCPU $$", "took longer than 60 s to read (--import-time), at IfcWall #12");
    expectRefusedBy(tell + "exit 12", "needs more memory than 2 GiB (--import-memory), at IfcWall #12");
    expectRefusedBy(tell + "exit 3", "(exit code 3), at IfcWall #12: leave that out");
}

TEST_F(SceneWorker, SlowOnesAreEndedWithAllThatTheyStarted) {
    settings_.time_limit = 0.3;
    const std::string mark = path("alive");
    expectRefusedBy("(sleep 2; touch " + mark + ") & sleep 1000", "took longer than 0.3 s to read (--import-time)");
    expectRefusedBy("exec 1>&-; sleep 1000", "took longer than 0.3 s");
    expectRefusedBy("while :; do printf x; done", "no scene");
    std::this_thread::sleep_for(std::chrono::milliseconds(2500));
    EXPECT_FALSE(std::filesystem::exists(mark));
}

TEST_F(SceneWorker, GarbageAndCutStreamsAreOneLine) {
    expectRefusedBy("echo this is no stream of a scene", "its reader sent what is no scene");
    expectRefusedBy("head -c 10000000 /dev/zero", "its reader sent what is no scene");
    expectRefusedBy("cat /dev/urandom", "its reader sent what is no scene");
    const std::string whole = streamOf(sampleScene());
    write("stream", whole.substr(0, whole.size() - 5));
    expectRefusedBy("cat " + path("stream"), "its reader ended without a word (exit code 0)");
    settings_.memory_limit = 100;
    write("stream", whole);
    expectRefusedBy("cat " + path("stream"), "needs more memory than 100 bytes");
}

TEST_F(SceneWorker, MissingOrNoProgramsAreNamed) {
    settings_.worker = path("nowhere");
    expectRefused(file_, "cannot be started: No such file or directory");
    settings_.worker = write("text", "no program");
    expectRefused(file_, "cannot be started");
}

TEST_F(SceneWorker, TheEnvironmentNamesItUnlessTheSettingsDo) {
    write("stream", streamOf(sampleScene()));
    setenv("SIGHTLINE_IMPORT", script("from_environment", "cat " + path("stream")).c_str(), 1);
    const std::string named = settings_.worker;
    settings_.worker = "";
    EXPECT_EQ(findImportWorker(settings_), path("from_environment"));
    EXPECT_TRUE(load(file_).ok());
    settings_.worker = path("other");
    EXPECT_EQ(findImportWorker(settings_), path("other"));
    unsetenv("SIGHTLINE_IMPORT");
}

TEST_F(SceneWorker, LeavesNoFilesOpenAndNoChildrenBehind) {
    settings_.worker = script("worker", "kill -SEGV $$");
    load(file_).ok();
    const size_t before = openFiles();
    for (int i = 0; i < 20; ++i) EXPECT_FALSE(load(file_).ok());
    EXPECT_EQ(openFiles(), before);
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a child is left";
}

TEST_F(SceneWorker, InheritsNothingButItsFolder) {
    const int open_file = ::open(file_.c_str(), O_RDONLY);  // without close-on-exec, as libraries do
    ASSERT_GE(open_file, 0);
    write("stream", streamOf(sampleScene()));
    settings_.worker = script("worker", "ls -l /proc/$$/fd >" + path("files") + "; cat " + path("stream"));
    EXPECT_TRUE(load(file_).ok());
    ::close(open_file);
    std::stringstream files;
    files << std::ifstream(path("files")).rdbuf();
    EXPECT_NE(files.str().find("worker"), std::string::npos) << files.str();  // the script itself
    EXPECT_EQ(files.str().find("scene.obj"), std::string::npos) << files.str();
}

#ifdef SIGHTLINE_IMPORT_PROGRAM

TEST_F(SceneWorker, SeveralThreadsLoadAtOnce) {
    std::vector<std::thread> threads;
    std::atomic<int> good = 0;
    for (int t = 0; t < 8; ++t)
        threads.emplace_back([&] {
            for (int i = 0; i < 4; ++i) good += load(file_).ok();
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(good, 32);
}

/// One polygon of so many teeth that cutting it takes long, and nothing is written meanwhile.
std::string longWork() {
    constexpr int kTeeth = 60000;
    std::string text, face = "f";
    for (int i = 0; i < kTeeth; ++i) text.append("v ").append(std::to_string(i)).append(i % 2 ? " 1 0\n" : " 2 0\n");
    text += "v 60000 0 0\nv 0 0 0\n";
    for (int i = kTeeth + 2; i > 0; --i) face.append(" ").append(std::to_string(i));
    return text + face + "\n";
}

bool runs(pid_t process) {
    std::string state;
    std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
    return stat >> state >> state >> state && state != "Z";
}

TEST_F(SceneWorker, EndsWithTheProcessThatAskedForIt) {
#ifdef __SANITIZE_THREAD__
    GTEST_SKIP() << "its sanitizer allows no threads in a forked process";
#endif
    const std::string file = write("long.obj", longWork());
    const std::string worker = script("slow", "echo $$ >" + path("pid") + "; exec " SIGHTLINE_IMPORT_PROGRAM " \"$@\"");
    const auto readPid = [&] {
        pid_t process = 0;
        std::ifstream(path("pid")) >> process;
        return process;
    };
    const pid_t parent = fork();
    if (parent == 0) {
        settings_.worker = worker;
        std::thread([&] { load(file).ok(); }).detach();
        while (readPid() == 0 || !runs(readPid())) usleep(1000);
        usleep(300000);
        _exit(runs(readPid()) ? 0 : 1);
    }
    int status = 0;
    waitpid(parent, &status, 0);
    EXPECT_EQ(status, 0) << "the work is too short for this test";
    for (int i = 0; i < 300 && runs(readPid()); ++i) usleep(10000);
    EXPECT_FALSE(runs(readPid()));
    kill(readPid(), SIGKILL);
}

TEST_F(SceneWorker, ReadsNothingForWhoIsNotItsParent) {
    const std::string call =
        std::string(SIGHTLINE_IMPORT_PROGRAM) + " --parent 1 --format obj -- " + file_ + " | wc -c >" + path("size");
    ASSERT_EQ(std::system(call.c_str()), 0);
    size_t size = 1;
    std::ifstream(path("size")) >> size;
    EXPECT_EQ(size, 0u);
}

TEST_F(SceneWorker, TheProcessorsTimeIsLimitedToo) {
    const std::string file = write("long.obj", longWork());
    settings_.time_limit = 1;
    expectRefused(file, "took longer than 1 s to read (--import-time)");
}

TEST_F(SceneWorker, MemoryIsLimited) {
    if (kSanitized) GTEST_SKIP() << "sanitizers reserve all of the address space";
    std::string text;
    for (int i = 0; i < 300000; ++i) text += "v " + std::to_string(i) + " 0 0\n";
    for (int i = 1; i + 2 <= 300000; ++i)
        text += "f " + std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 2) + "\n";
    const std::string file = write("large.obj", text);
    settings_.memory_limit = uint64_t(64) << 20;
    expectRefused(file, "needs more memory than 64 MiB (--import-memory)");
    settings_.memory_limit = uint64_t(2) << 30;
    EXPECT_TRUE(load(file).ok());
}

TEST_F(SceneWorker, TellsHowFarItIs) {
    size_t last = 0, total = 0;
    settings_.progress = [&](size_t done, size_t all) {
        EXPECT_GE(done, last);
        EXPECT_LE(done, all);
        last = done;
        total = all;
    };
    ASSERT_TRUE(load(file_).ok());
    EXPECT_GT(total, 0u);
    EXPECT_EQ(last, total);
}

TEST_F(SceneWorker, AnswersWhateverIsDoneToAFile) {
    settings_.time_limit = 1;
    settings_.memory_limit = uint64_t(1) << 30;
    std::vector<ForeignFile> files = foreignFiles(twoBoxes());
    files.push_back({"wall.ifc", ifcText("IFC2X3")});
    int scenes = 0, lines = 0;
    for (const ForeignFile& file : files)
        for (uint64_t seed = 0; seed < 15; ++seed) {
            SCOPED_TRACE(file.name + ", seed " + std::to_string(seed));
            Random random(seed);
            std::string bytes = file.bytes;
            for (uint64_t n = 1 + random.below(4); n-- > 0;) {
                const size_t at = random.below(bytes.size());
                switch (random.below(4)) {
                    case 0:
                        bytes[at] = static_cast<char>(random.below(256));
                        break;
                    case 1:
                        bytes[at] ^= static_cast<char>(1 << random.below(8));
                        break;
                    case 2:
                        bytes.erase(at, 1 + random.below(40));
                        break;
                    case 3:
                        bytes.insert(at, bytes.substr(random.below(bytes.size()), random.below(60)));
                        break;
                }
                if (bytes.empty()) bytes.push_back('?');
            }
            const std::string name = write(file.name, bytes);
            const Result<Scene> scene = load(name);
            EXPECT_EQ(scene.ok() ? sceneFault(*scene) : messageFault(scene.error(), name), "");
            ++(scene.ok() ? scenes : lines);
        }
    RecordProperty("scenes", scenes);
    RecordProperty("lines", lines);
    EXPECT_GT(scenes, 20);
    EXPECT_GT(lines, 20);
}

#endif

}  // namespace
}  // namespace sightline
