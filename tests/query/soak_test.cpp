// Everything at once: threads ask many views of snapshots while the world moves, grows, shrinks, and takes up cells.
// SPDX-License-Identifier: MIT
//
// SIGHTLINE_LONG_TESTS=1 makes it a million objects, 64 views, 16 threads and ten minutes.
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include "sightline/cells/cell_space_build.h"
#include "sightline/query/shadow_query.h"
#include "sightline/query/sight_query.h"
#include "tests/support/made_world.h"
#include "tests/support/memory.h"

namespace sightline::test {
namespace {

struct Size {
    size_t objects, threads, views, seconds;
};

Size sizeOfTest() {
    const bool all = testsAreLong();
    return all ? Size{1000000, 16, 64, 600} : Size{4000, 4, 8, 4};
}

/// What stood where when a snapshot was made, by key; an empty box: nothing did.
struct Moment {
    Snapshot now;
    std::vector<Box3d> boxes;
};

/// A world of boxes of which every one hides, changed by one thread.
class Changing {
public:
    Changing(size_t objects, Memory* memory) : world_(World::create({.memory = memory})), random_(1) {
        reach_ = 2 * std::sqrt(static_cast<double>(objects));
        cube_ = world_.addOccluder(prepareOccluder(boxMesh().view()));
        CellSpaceBuilder build;
        (void)build.addCell("all", Box3d{glm::dvec3(-2 * reach_), glm::dvec3(2 * reach_)});
        space_ = build.take();
        for (size_t i = 0; i < objects; ++i) add();
    }

    /// Some creep, some are elsewhere, some go and come; now and then there are cells, or none.
    std::shared_ptr<const Moment> next() {
        const size_t some = boxes_.size() / 100 + 1;
        for (size_t i = 0; i < some; ++i) {
            const size_t key = random_.below(boxes_.size());
            if (boxes_[key].empty()) continue;
            const glm::dvec3 size = boxes_[key].size();
            const glm::dvec3 low = i % 2 ? boxes_[key].min + randomVector(random_, 0.1) : place();
            boxes_[key] = {low, low + size};
            world_.move(ids_[key], placed(boxes_[key]));
        }
        for (size_t i = 0; i < some / 4 + 1; ++i) {
            const size_t key = random_.below(boxes_.size());
            if (boxes_[key].empty()) {
                put(key);
            } else {
                world_.remove(ids_[key]);
                boxes_[key] = {};
            }
        }
        const uint64_t cells = random_.below(8);
        if (cells == 0) world_.detach();
        if (cells == 1 && !world_.attach(space_)) ADD_FAILURE() << "the cells are not taken";
        return std::make_shared<Moment>(Moment{world_.commit(), boxes_});
    }
    double reach() const { return reach_; }

private:
    glm::dvec3 place() { return randomVector(random_, {reach_, 2, reach_}); }
    static glm::dmat4 placed(const Box3d& box) {
        glm::dmat4 transform(1.0);
        for (int axis = 0; axis < 3; ++axis) transform[axis][axis] = box.size()[axis];
        transform[3] = glm::dvec4(box.min, 1.0);
        return transform;
    }
    void add() {
        boxes_.emplace_back();
        ids_.emplace_back();
        put(boxes_.size() - 1);
    }
    void put(size_t key) {
        const glm::dvec3 low = place(), size = randomIn(random_, {glm::dvec3(0.2), glm::dvec3(3)});
        boxes_[key] = {low, low + size};
        ObjectDef def;
        def.bounds = {glm::dvec3(0.0), glm::dvec3(1.0)};
        def.transform = placed(boxes_[key]);
        def.key = key;
        def.occluder = def.shape = cube_;
        ids_[key] = world_.add(def);
    }

    World world_;
    Random random_;
    double reach_ = 0;
    OccluderId cube_;
    CellSpace space_;
    std::vector<Box3d> boxes_;
    std::vector<ObjectId> ids_;
};

/// Where a ray enters a box, in parts of it; infinite if it does not.
double entry(const Box3d& box, const glm::dvec3& from, const glm::dvec3& along) {
    double low = 0, high = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (box.min[axis] - from[axis]) / along[axis], b = (box.max[axis] - from[axis]) / along[axis];
        low = std::max(low, std::min(a, b));
        high = std::min(high, std::max(a, b));
    }
    return low < high ? low : std::numeric_limits<double>::infinity();
}

/// Shoots at objects and holds the answer to what is met first. O(objects) a ray.
/// @returns rays that told something
int judge(const Moment& moment, const View& view, const std::vector<uint8_t>& kept, Random& random, int rays) {
    const glm::dvec3 eye = eyePosition(view);
    int told = 0;
    for (int ray = 0; ray < rays; ++ray) {
        const Box3d& aim = moment.boxes[random.below(moment.boxes.size())];
        if (aim.empty()) continue;
        const glm::dvec3 along = randomIn(random, aim) - eye;
        size_t first = 0;
        double least = std::numeric_limits<double>::infinity(), second = least;
        for (size_t key = 0; key < moment.boxes.size(); ++key) {
            if (moment.boxes[key].empty()) continue;
            const double at = entry(moment.boxes[key], eye, along);
            if (at < least) {
                second = least;
                least = at;
                first = key;
            } else {
                second = std::min(second, at);
            }
        }
        // Around the eye, and where two begin at once, a ray tells nothing.
        if (!(least > 0) || !std::isfinite(least) || second - least < 1e-9) continue;
        const glm::dvec4 clip = view.projection * view.view * glm::dvec4(eye + least * along, 1.0);
        if (std::abs(clip.x) > clip.w || std::abs(clip.y) > clip.w || clip.z < -clip.w) continue;
        EXPECT_TRUE(kept[first]) << "object " << first << " is seen, and was culled";
        ++told;
    }
    return told;
}

TEST(Soak, ManyThreadsAskWhileTheWorldChanges) {
    const Size size = sizeOfTest();
    CountingMemory memory;
    size_t began = 0, most = 0, ended = 0;  // bytes of the world with one snapshot, with many, and with one again
    std::atomic<uint64_t> answers{0}, judged{0};
    {
        Changing changing(size.objects, &memory);
        std::mutex mutex;
        std::shared_ptr<const Moment> latest = changing.next();
        began = memory.bytes;
        std::atomic<bool> done{false};
        std::vector<std::thread> threads;
        for (size_t t = 0; t < size.threads; ++t)
            threads.emplace_back([&, t] {
                Random random(100 + t);
                std::vector<Query> queries(std::max<size_t>(size.views / size.threads, 1));
                SightQuery sight;
                std::vector<glm::dvec3> eyes;
                for (size_t i = 0; i < queries.size(); ++i)
                    eyes.push_back(randomVector(random, {0.5 * changing.reach(), 1, 0.5 * changing.reach()}));
                while (!done) {
                    std::shared_ptr<const Moment> moment;
                    {
                        const std::lock_guard lock(mutex);
                        moment = latest;
                    }
                    for (size_t i = 0; i < queries.size(); ++i) {
                        eyes[i] += randomVector(random, random.below(50) ? 0.05 : 5.0);
                        const View view = viewFrom(eyes[i], randomVector(random, {1, 0.3, 1}));
                        const VisibleSet set = queries[i].visible(moment->now, view);
                        judged += static_cast<uint64_t>(judge(*moment, view, keptOf(set, moment->boxes.size()), random,
                                                              size.objects > 100000 ? 4 : 40));
                        if (testing::Test::HasFailure()) done = true;
                        ++answers;
                    }
                    const SightLine line = sight.look(moment->now, eyes[0], eyes[0] + randomVector(random, 5.0));
                    EXPECT_FALSE(line.blocked && moment->boxes[line.by.key].empty());
                }
            });
        const auto start = std::chrono::steady_clock::now();
        const auto seconds = [&] {
            return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        };
        const auto whole = static_cast<double>(size.seconds);
        while (seconds() < whole && !done) {
            std::shared_ptr<const Moment> next = changing.next();
            {
                const std::lock_guard lock(mutex);
                latest.swap(next);
            }
            most = std::max<size_t>(most, memory.bytes);
        }
        done = true;
        for (std::thread& thread : threads) thread.join();
        ended = memory.bytes;
    }
    EXPECT_GT(answers, 20u);
    EXPECT_GT(judged, answers / 4) << "rays that told something";
    EXPECT_LT(static_cast<double>(ended), 2 * static_cast<double>(began)) << "memory grows";
    EXPECT_EQ(memory.bytes, 0u) << "all of it goes back";
    std::printf(
        "%zu objects, %zu threads: %llu answers in %zu s, %llu rays; the world took %.1f MB at first, %.1f with all "
        "snapshots that were asked, %.1f at the end\n",
        size.objects, size.threads, static_cast<unsigned long long>(answers), size.seconds,
        static_cast<unsigned long long>(judged), static_cast<double>(began) / 1e6, static_cast<double>(most) / 1e6,
        static_cast<double>(ended) / 1e6);
}

}  // namespace
}  // namespace sightline::test
