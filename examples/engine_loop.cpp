// An engine's loop: objects that move, a door, parts of the world that come and go, and a query that threads share.
// SPDX-License-Identifier: MIT
//
// The game thread changes the world and commits; the render thread asks the snapshot before, meanwhile. Nothing is locked.
#include <array>
#include <cmath>
#include <cstdio>
#include <deque>
#include <map>
#include <thread>
#include <vector>

#include <sightline/sightline.h>

namespace {
using namespace sightline;

constexpr int kFrames = 240, kBlock = 40;  // a block of the city is so many units wide

/// The unit cube that all houses are made of.
const std::vector<glm::vec3> kCorners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                         {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
const std::vector<uint32_t> kFaces = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                      2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};

glm::dmat4 placed(const glm::dvec3& low, const glm::dvec3& size) {
    glm::dmat4 transform(1.0);
    for (int axis = 0; axis < 3; ++axis) transform[axis][axis] = size[axis];
    transform[3] = glm::dvec4(low, 1.0);
    return transform;
}

/// What the game thread owns.
class Game {
public:
    Game() : cube_(world_.addOccluder(prepareOccluder({kCorners, kFaces}))) {
        for (int i = 0; i < 300; ++i) cars_.push_back(add(placed({0, 0, 0}, {2, 1.5, 4}), false));
    }

    /// One tick: blocks near the player stream in, those far away go; cars drive; the snapshot is for the render thread.
    Snapshot tick(int frame, const glm::dvec3& player) {
        const int middle = static_cast<int>(std::floor(player.z / kBlock));
        for (int block = middle - 4; block <= middle + 4; ++block)
            if (!blocks_.count(block)) loadBlock(block);
        for (auto block = blocks_.begin(); block != blocks_.end();)
            if (std::abs(block->first - middle) > 5) {
                for (const ObjectId id : block->second) world_.remove(id);
                block = blocks_.erase(block);
            } else {
                ++block;
            }
        for (size_t i = 0; i < cars_.size(); ++i) {
            const double lane = i % 2 ? 4 : -6,
                         at = player.z + 300 - std::fmod(7.0 * static_cast<double>(i) + frame, 600.0);
            world_.move(cars_[i], placed({lane, 0, at}, {2, 1.5, 4}));
        }
        return world_.commit();
    }

    uint32_t objects() const { return world_.objectCount(); }

private:
    /// Two rows of houses along the street at x = 0, and yards behind them.
    void loadBlock(int block) {
        std::vector<ObjectId>& ids = blocks_[block];
        for (int house = 0; house < 4; ++house)
            for (const double side : {-1.0, 1.0}) {
                const double z = kBlock * block + 10.0 * house, height = 8 + (7 * house + 3 * std::abs(block)) % 9;
                ids.push_back(add(placed({side > 0 ? 10 : -22, 0, z}, {12, height, 9.5}), true));
                for (int thing = 0; thing < 10; ++thing)
                    ids.push_back(add(placed({side * (26 + thing), 0, z + 0.8 * thing}, {0.5, 1, 0.5}), false));
            }
    }
    ObjectId add(const glm::dmat4& transform, bool hides) {
        ObjectDef def;
        def.bounds = {glm::dvec3(0), glm::dvec3(1)};
        def.transform = transform;
        def.key = next_key_++;
        def.occluder = hides ? cube_ : OccluderId();
        def.shape = cube_;
        return world_.add(def);
    }

    World world_;
    OccluderId cube_;
    std::vector<ObjectId> cars_;
    std::map<int, std::vector<ObjectId>> blocks_;
    uint64_t next_key_ = 0;
};

View viewOf(const glm::dvec3& eye) {
    View view;
    view.view = lookAt(eye, eye + glm::dvec3(0, 0, -1), {0, 1, 0});
    view.projection = perspective(1.1, 16.0 / 9.0, 0.1);
    return view;
}

}  // namespace

int main() {
    Game game;
    ThreadPool threads(2);                   // an engine offers its own by the same hook: class Jobs
    Query query(defaultMemory(), &threads);  // kept from frame to frame
    QuerySettings settings;
    settings.bins = 2;  // strips that the threads share when a view is drawn; certificates need none

    uint64_t drawn = 0, in_view = 0, appeared = 0, left = 0;
    const auto draw = [&](uint64_t) { ++drawn; };  // the renderer's
    glm::dvec3 player(0, 1.7, 0);
    Snapshot now = game.tick(0, player);
    for (int frame = 1; frame <= kFrames; ++frame) {
        const View view = viewOf(player);
        const glm::dvec3 next = player - glm::dvec3(0, 0, 0.5);
        Snapshot ahead;
        std::thread update([&] { ahead = game.tick(frame, next); });  // the next frame's world, while this one is asked

        const VisibleSet set = query.visible(now, view, settings);
        const VisibleChanges changes = query.changes();
        for (const Visible& object : set.objects) draw(object.key);
        appeared += changes.appeared.size();  // upload what comes into sight
        left += changes.disappeared.size();
        in_view += set.objects.size() + set.stats.of(Stage::kOcclusion).culled;

        update.join();
        now = ahead;  // the old snapshot goes when its last copy does
        player = next;
    }
    std::printf(
        "%d frames, %u objects at the end: %.1f drawn a frame, of %.1f in the frustum; %llu came into sight, %llu left "
        "it\n",
        kFrames, game.objects(), static_cast<double>(drawn) / kFrames, static_cast<double>(in_view) / kFrames,
        static_cast<unsigned long long>(appeared), static_cast<unsigned long long>(left));
    return drawn > 0 && 4 * drawn < 3 * in_view && appeared > left ? 0 : 1;
}
