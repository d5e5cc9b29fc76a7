// Every pair of settings: both work, or the answer says which of them is switched off; and no pair makes it unsound.
// SPDX-License-Identifier: MIT
#include "sightline/query/query.h"

#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/geom/off.h"
#include "sightline/prepare/facing/draw_clusters.h"
#include "tests/support/rooms.h"

namespace sightline::test {
namespace modes {
namespace {

/// What a walk is asked.
struct Asked {
    QuerySettings settings;
    View view;  ///< of each step, but for where it stands: what a mode changes of it
    bool parallel = false, two_eyes = false;
};

/// What the answers of a walk did together.
struct Done {
    QueryStats sum;        ///< all counters
    uint32_t off_all = 0;  ///< flags of some answer
    uint64_t frames = 0, drawn = 0, frames_in_parts = 0;

    uint64_t culled(Stage stage) const { return sum.of(stage).culled; }
};

/// A setting, or a declaration of the view, that somebody may switch on.
struct Mode {
    const char* name;
    void (*on)(Asked&);
    uint64_t (*effect)(const Done&);  ///< more than 0: it did something; null: no counter tells
    bool judged = true;               ///< nothing that is seen may be culled, but by stages that are not conservative
};

ViewPlanes farPlane() {
    ViewPlanes planes;
    planes.add({0, 1, 0, 1000});
    return planes;
}

const Mode kModes[] = {
    {"certificates", [](Asked& a) { a.settings.proofs = true; }, [](const Done& d) { return d.sum.proved; }},
    {"unasked answers", [](Asked& a) { a.settings.unasked_answers = 15; }, [](const Done& d) { return d.sum.unasked; }},
    {"bins", [](Asked& a) { a.settings.bins = 4; }, [](const Done& d) { return d.frames_in_parts; }},
    {"clusters", [](Asked& a) { a.settings.stages |= stageBit(Stage::kClusters); },
     [](const Done& d) { return d.sum.clusters_back; }},
    {"occlusion of clusters", [](Asked& a) { a.settings.stages |= stageBit(Stage::kClusters); },
     [](const Done& d) { return d.sum.clusters_hidden; }},
    {"stateless", [](Asked& a) { a.settings.stateless = true; },
     [](const Done& d) { return uint64_t{d.sum.proved + d.sum.unasked == 0}; }},
    {"distance", [](Asked& a) { a.settings.max_distance = 7; },
     [](const Done& d) { return d.culled(Stage::kDistance); }},
    {"contribution", [](Asked& a) { a.settings.contribution = 8; },
     [](const Done& d) { return d.culled(Stage::kContribution); }},
    {"hysteresis", [](Asked& a) { a.settings.hysteresis = 0.5; }, nullptr},
    {"volumes", [](Asked& a) { a.settings.stages |= stageBit(Stage::kVolumes); },
     [](const Done& d) { return d.culled(Stage::kVolumes); }},
    {"masked", [](Asked& a) { a.settings.masked = true; }, nullptr},
    {"close gaps", [](Asked& a) { a.settings.close_gaps = 1.0 / 16; }, nullptr, false},
    {"no faces", [](Asked& a) { a.settings.faces = false; },
     [](const Done& d) { return uint64_t{d.sum.faces_tested == 0}; }},
    {"no second look", [](Asked& a) { a.settings.second_look = false; },
     [](const Done& d) { return uint64_t{d.sum.second_looks == 0}; }},
    {"few occluders", [](Asked& a) { a.settings.occluder_triangles = 40; },
     [](const Done& d) { return uint64_t{d.sum.budget_spent}; }},
    {"levels of detail", [](Asked& a) { a.settings.lod_error = 8; },
     [](const Done& d) { return d.sum.lod_triangles + d.culled(Stage::kLod); }},
    {"hard budget",
     [](Asked& a) {
         a.settings.budget = 0.02;
         a.settings.hard_budget = true;
         a.settings.cost_object = 1000;
     },
     [](const Done& d) { return d.culled(Stage::kLod); }},
    {"clocks", [](Asked& a) { a.settings.time_stages = true; },
     [](const Done& d) { return d.sum.of(Stage::kFrustum).nanoseconds; }},
    {"jitter", [](Asked& a) { a.view.jitter = 3; }, nullptr},
    // Planes that have all inside: they cut nothing off, and ask all that planes ask.
    {"sections", [](Asked& a) { a.view.sections = farPlane(); }, nullptr},
    {"window", [](Asked& a) { a.view.window = farPlane(); }, nullptr},
    {"eye radius", [](Asked& a) { a.view.eye_radius = 0.01; }, nullptr},
    {"parallel view", [](Asked& a) { a.parallel = true; }, nullptr},
    {"two eyes", [](Asked& a) { a.two_eyes = true; }, nullptr},
    {"no frustum", [](Asked& a) { a.settings.stages &= ~stageBit(Stage::kFrustum); }, nullptr},
    {"no occlusion", [](Asked& a) { a.settings.stages &= ~stageBit(Stage::kOcclusion); }, nullptr},
};

/// The pairs of which the first switches the second off, and what the answer says. Other effects are there in pairs.
struct Excludes {
    const char *first, *second;
    Off says;
};
const Excludes kExcludes[] = {
    {"stateless", "certificates", Off::kMemoryByStateless},
    {"stateless", "unasked answers", Off::kMemoryByStateless},
    {"parallel view", "certificates", Off::kCertificatesByView},
    {"parallel view", "unasked answers", Off::kCertificatesByView},
    {"no frustum", "certificates", Off::kCertificatesByStages},
    {"no frustum", "bins", Off::kBinsByStages},
    {"no frustum", "window", Off::kWindowByStages},
    {"no occlusion", "bins", Off::kBinsByStages},
    {"two eyes", "clusters", Off::kClustersByTwoEyes},
    {"two eyes", "occlusion of clusters", Off::kClustersByTwoEyes},
    {"two eyes", "hard budget", Off::kHardBudgetByTwoEyes},
    {"eye radius", "certificates", Off::kStagesByEyeRadius},
    {"eye radius", "unasked answers", Off::kStagesByEyeRadius},
    {"eye radius", "bins", Off::kStagesByEyeRadius},
    {"eye radius", "clusters", Off::kStagesByEyeRadius},
    {"eye radius", "occlusion of clusters", Off::kStagesByEyeRadius},
    {"eye radius", "contribution", Off::kStagesByEyeRadius},
    {"eye radius", "volumes", Off::kStagesByEyeRadius},
    {"eye radius", "few occluders", Off::kStagesByEyeRadius},
    {"eye radius", "levels of detail", Off::kStagesByEyeRadius},
    {"eye radius", "hard budget", Off::kStagesByEyeRadius},
};
/// The stage that makes the second one's answers is off: nothing is left to do, and nothing to say.
const Excludes kNeeds[] = {
    {"no occlusion", "certificates", {}},  {"no occlusion", "unasked answers", {}},
    {"no occlusion", "few occluders", {}}, {"no occlusion", "occlusion of clusters", {}},
    {"no frustum", "clocks", {}},          {"eye radius", "clocks", {}},
};

template <class List>
const Excludes* findPair(const List& list, const Mode& first, const Mode& second) {
    for (const Excludes& pair : list)
        if (std::string(pair.first) == first.name && std::string(pair.second) == second.name) return &pair;
    return nullptr;
}

/// Counts the tasks that a query offers.
class Parts final : public Jobs {
public:
    uint32_t last = 0;
    void run(uint32_t count, Task task, void* context) override {
        last = count;
        for (uint32_t i = 0; i < count; ++i) task(context, i);
    }
};

/// Rooms, with things that have levels, and some mounds that have clusters.
struct ModesWorld : Rooms {
    ModesWorld() : Rooms(1, true) {
        const LodLevel levels[] = {{0, 12, 8}, {0.02, 6, 8}};
        const LodsId lods = world.addLods(levels);
        Random random(7);
        for (int i = 0; i < 60; ++i) {
            const glm::dvec3 p{random.uniform(1, 22), random.uniform(0.2, 1.5), random.uniform(1, 22)};
            glm::dmat4 t(1.0);
            for (int axis = 0; axis < 3; ++axis) t[axis][axis] = random.uniform(0.2, 0.6);
            t[3] = glm::dvec4(p, 1);
            addWith(t, cube, false, {}, lods);
        }
        const auto triangles = static_cast<uint32_t>(other.indices.size() / 3);
        const MeshPart part{0, triangles, false};
        DrawClusterSettings settings;
        settings.merge.triangles = 8;
        const ClustersId clusters = world.addClusters(prepareDrawClusters(other.view(), {&part, 1}, settings));
        const OccluderId mound = world.addOccluder(prepareOccluder(other.view(), {}, other_double_sided));
        for (int i = 0; i < 60; ++i) {
            glm::dmat4 t(1.0);
            for (int axis = 0; axis < 3; ++axis) t[axis][axis] = random.uniform(1, axis == 1 ? 1.5 : 5);
            t[3] = glm::dvec4{random.uniform(0.3, 20), random.uniform(0.1, 1.5), random.uniform(0.3, 20), 1};
            addWith(t, mound, true, clusters, {});
        }
    }
    void addWith(const glm::dmat4& transform, OccluderId of, bool is_mound, ClustersId clusters, LodsId lods) {
        ObjectDef def;
        def.bounds = {glm::dvec3(0.0), glm::dvec3(1.0)};
        def.transform = transform;
        def.key = transforms.size();
        def.occluder = def.shape = of;
        def.clusters = clusters;
        def.lods = lods;
        def.limits.factor = lods == LodsId() ? 1 : 1000;  // worth more under a budget
        is_other.push_back(is_mound);
        transforms.push_back(transform);
        hides.push_back(true);
        ids.push_back(world.add(def));
    }
};

constexpr int kFrames = 14;

/// A walk, with what an exact z-buffer saw of some of its frames.
struct Walk {
    std::vector<View> views;
    std::vector<std::vector<uint8_t>> seen;  ///< of every fourth view

    Walk(const ModesWorld& rooms, bool parallel) {
        for (int frame = 0; frame < kFrames; ++frame) {
            View view = viewFrom({9.3 + 0.01 * frame, 1.4, 9.1}, {0.8, -0.12, 0.55}, {80, 320, 180, 0.05});
            if (parallel) view.projection = orthographic(4, 16.0 / 9, 0.05, 60);
            views.push_back(view);
            seen.push_back(frame % 4 == 3 ? rooms.seen(view, 1) : std::vector<uint8_t>());
        }
    }
};

Done walk(const ModesWorld& rooms, const Snapshot& now, const Walk& of, const Asked& asked, bool judged,
          const std::string& what) {
    Done done;
    Parts parts;
    Query query(defaultMemory(), &parts);
    for (int frame = 0; frame < kFrames; ++frame) {
        View view = of.views[static_cast<size_t>(frame)];
        view.jitter = asked.view.jitter;
        view.sections = asked.view.sections;
        view.window = asked.view.window;
        view.eye_radius = asked.view.eye_radius;
        std::vector<uint8_t> kept(rooms.ids.size(), 0);
        QueryStats stats;
        parts.last = 0;
        if (asked.two_eyes) {
            const StereoSet set = query.visibleStereo(now, view, shiftedEye(view, 0.06), asked.settings);
            for (const Visible& v : set.objects) kept[v.key] = 1;
            stats = set.left;
            stats.off |= set.right.off;
        } else {
            const VisibleSet set = query.visible(now, view, asked.settings);
            for (const Visible& v : set.objects) kept[v.key] = 1;
            stats = set.stats;
            EXPECT_EQ(accountedFor(stats), stats.objects) << what;
        }
        // What works in one answer and not in the next says so in that.
        const bool drawn = stats.occluder_triangles > 0;
        const bool occludes = (stagesInUse(view, asked.settings) & stageBit(Stage::kOcclusion)) != 0;
        if (occludes && !drawn && stats.proved > 0) {
            EXPECT_EQ(asked.settings.bins > 1, (stats.off & offBit(Off::kBinsByCertificates)) != 0) << what;
            EXPECT_EQ(asked.settings.close_gaps > 0, (stats.off & offBit(Off::kGapsByCertificates)) != 0) << what;
            const bool clusters = (asked.settings.stages & stageBit(Stage::kClusters)) && !asked.two_eyes;
            EXPECT_EQ(clusters, (stats.off & offBit(Off::kClusterLookByCertificates)) != 0) << what;
        } else if (drawn) {
            EXPECT_EQ(stats.off & (offBit(Off::kGapsByCertificates) | offBit(Off::kClusterLookByCertificates)), 0u)
                << what;
            // Certificates did not do in the middle of an answer: it was drawn, by one thread. Of two eyes, one may be.
            EXPECT_TRUE(!(stats.off & offBit(Off::kBinsByCertificates)) || parts.last < 4 || asked.two_eyes) << what;
        }
        const uint32_t eyes = asked.two_eyes ? 2 : 1;
        done.frames_in_parts += parts.last > eyes;
        ++done.frames;
        done.drawn += drawn;
        done.sum.addWork(stats);
        for (int stage = 0; stage < kStageCount; ++stage) done.sum.stages[stage].culled += stats.stages[stage].culled;
        done.off_all |= stats.off;
        const std::vector<uint8_t>& seen = of.seen[static_cast<size_t>(frame)];
        const uint32_t lossy = stagesInUse(view, asked.settings) & kLossyStages;
        if (!judged || seen.empty()) continue;
        std::vector<uint8_t> reasons(rooms.ids.size());
        query.reasons(reasons);
        for (size_t i = 0; i < seen.size(); ++i) {
            const bool may_be = reasons[i] > 0 && reasons[i] <= kStageCount && (lossy >> (reasons[i] - 1) & 1);
            EXPECT_TRUE(kept[i] || !seen[i] || may_be)
                << what << ", frame " << frame << ": object " << i << " is seen, but culled as " << int(reasons[i]);
        }
    }
    return done;
}

/// The base: the default, without the stages and looks that a mode adds.
Asked base() {
    Asked asked;
    asked.settings.stages &= ~stageBit(Stage::kClusters);
    return asked;
}

TEST(Modes, OfAllPairsBothWorkOrTheAnswerSaysWhichIsOff) {
    ModesWorld rooms;
    const Snapshot now = rooms.world.commit();
    const Walk perspective(rooms, false), parallel(rooms, true);
    const auto run = [&](std::initializer_list<const Mode*> modes) {
        Asked asked = base();
        bool judged = true;
        std::string what;
        for (const Mode* mode : modes) {
            mode->on(asked);
            judged = judged && mode->judged;
            what += (what.empty() ? "" : " + ") + std::string(mode->name);
        }
        return walk(rooms, now, asked.parallel ? parallel : perspective, asked, judged, what);
    };
    std::vector<uint64_t> alone;
    for (const Mode& mode : kModes) {
        alone.push_back(mode.effect ? mode.effect(run({&mode})) : 0);
        EXPECT_TRUE(!mode.effect || alone.back() > 0) << mode.name << " does nothing in this walk";
    }
    uint64_t pairs = 0, measured = 0, off = 0;
    for (size_t i = 0; i < std::size(kModes); ++i)
        for (size_t k = i + 1; k < std::size(kModes); ++k) {
            const Done done = run({&kModes[i], &kModes[k]});
            ++pairs;
            for (const auto& [first, second] : {std::pair(&kModes[i], &kModes[k]), std::pair(&kModes[k], &kModes[i])}) {
                const std::string what = std::string(first->name) + " + " + second->name;
                const uint64_t effect = second->effect ? second->effect(done) : 0;
                if (const Excludes* const pair = findPair(kExcludes, *first, *second)) {
                    EXPECT_NE(done.off_all & offBit(pair->says), 0u) << what << ": nothing is said";
                    if (second->effect && !std::string_view(second->name).starts_with("bins")) {
                        EXPECT_EQ(effect, 0u) << what;
                    }
                    ++off;
                } else if (findPair(kNeeds, *first, *second)) {
                    EXPECT_EQ(effect, 0u) << what << " need not be in the list";
                } else if (second->effect) {
                    EXPECT_GT(effect, 0u) << what << ": the second one does nothing, and nothing says so";
                    ++measured;
                }
            }
        }
    RecordProperty("pairs", std::to_string(pairs));
    RecordProperty("measured", std::to_string(measured));
    RecordProperty("off", std::to_string(off));
    EXPECT_GT(measured, 100u);
}

/// The rows of the table stand in the order of their bits, each with a name and a sentence of its own.
TEST(Modes, EachFlagHasItsSentence) {
    uint32_t bit = 1;
    for (const OffRow& row : kOffRows) {
        EXPECT_EQ(offBit(row.off), bit);
        bit <<= 1;
        EXPECT_NE(std::string(row.words).find(": "), std::string::npos) << row.name;
        for (const OffRow& other : kOffRows)
            EXPECT_EQ(std::string(row.name) == other.name || std::string(row.words) == other.words, &row == &other);
    }
    std::stringstream docs;
    docs << std::ifstream(SIGHTLINE_DOCS_DIR "/integration.md").rdbuf();
    for (const OffRow& row : kOffRows)
        EXPECT_NE(docs.str().find("| `" + std::string(row.name) + "` | " + row.words), std::string::npos) << row.name;
    QueryStats one, other;
    one.off = 1;
    other.off = 2;
    one.addWork(other);
    EXPECT_EQ(one.off, 3u);
}

/// Neither certificates nor the stage of volumes work in a world without volumes, and the answer says so where one is on.
TEST(Modes, AWorldWithoutVolumesSaysSo) {
    for (const bool volumes : {true, false}) {
        WorldDef def;
        def.volumes = volumes;
        World world = World::create(def);
        const TestMesh wall = boxMesh({-20, -20, -6}, {20, 20, -5});
        const auto add = [&](const glm::dvec3& at, OccluderId occluder) {
            ObjectDef object;
            object.bounds = {at - glm::dvec3(0.5), at + glm::dvec3(0.5)};
            if (occluder != OccluderId()) object.bounds = {{-20, -20, -6}, {20, 20, -5}};
            object.occluder = occluder;
            world.add(object);
        };
        const Snapshot empty = world.commit();
        add({}, world.addOccluder(prepareOccluder(wall.view())));
        for (int i = 0; i < 50; ++i) add({0.2 * i - 5, 0, -20 - i}, {});
        const Snapshot now = world.commit();
        const auto asked = [&](const QuerySettings& settings, const Snapshot& of) {
            Query query;
            QueryStats sum;
            for (int i = 0; i < 8; ++i)
                sum.addWork(query.visible(of, viewFrom({0.01 * i, 0, 0}, {0, 0, -1}, {60, 320, 180}), settings).stats);
            return sum;
        };
        const uint32_t bit = offBit(Off::kCertificatesByWorld);
        const QueryStats walk = asked({}, now), without = asked({.stateless = true}, now);
        EXPECT_EQ((walk.off & bit) != 0, !volumes);
        if (!volumes) { EXPECT_EQ(walk.proved, 0u); }
        EXPECT_EQ(without.off & bit, 0u);
        EXPECT_EQ(asked({}, empty).off & bit, 0u);
        QuerySettings of_volumes{.stateless = true};
        of_volumes.stages |= stageBit(Stage::kVolumes);
        EXPECT_EQ((asked(of_volumes, now).off & bit) != 0, !volumes);
    }
}

/// One object with clusters leaves certificates to all others, and strips do.
TEST(Modes, CertificatesGoOnBesideClustersAndBins) {
    ModesWorld rooms;
    const Snapshot now = rooms.world.commit();
    const Walk of(rooms, false);
    Asked plain = base(), clusters = base(), bins = base();
    clusters.settings.stages |= stageBit(Stage::kClusters);
    bins.settings.bins = 2;
    const Done without = walk(rooms, now, of, plain, true, "plain");
    ASSERT_LT(without.drawn, without.frames);
    const Done with_clusters = walk(rooms, now, of, clusters, true, "clusters"),
               with_bins = walk(rooms, now, of, bins, true, "bins");
    EXPECT_EQ(with_clusters.drawn, without.drawn);
    EXPECT_EQ(with_clusters.sum.proved, without.sum.proved);
    EXPECT_LT(with_bins.drawn, with_bins.frames);
    EXPECT_GT(2 * with_bins.sum.proved, without.sum.proved);
    EXPECT_GT(with_bins.frames_in_parts, 0u) << "what is drawn is shared out";
}

/// Of strips a cluster is hidden if each that it meets hides it: the same clusters as of the whole image, or nearly.
TEST(Modes, ClustersAreHeldAgainstAllStrips) {
    ModesWorld rooms;
    const Snapshot now = rooms.world.commit();
    const Walk of(rooms, false);
    Asked whole = base(), strips = base();
    whole.settings.stages |= stageBit(Stage::kClusters);
    whole.settings.stateless = strips.settings.stateless = true;
    strips.settings = whole.settings;
    strips.settings.bins = 4;
    const uint64_t hidden = walk(rooms, now, of, whole, true, "whole").sum.clusters_hidden,
                   in_strips = walk(rooms, now, of, strips, true, "strips").sum.clusters_hidden;
    EXPECT_GT(hidden, 10u);
    EXPECT_GT(in_strips, hidden / 2);
}

}  // namespace
}  // namespace modes
}  // namespace sightline::test
