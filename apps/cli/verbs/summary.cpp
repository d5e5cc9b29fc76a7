// What a run says to a reader: totals of a path, verdicts of its frames, why its slowest and its loosest are so.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/summary.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <vector>

#include <fmt/core.h>

#include "apps/cli/shell/progress.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/cull_path.h"
#include "apps/cli/verbs/explain_object.h"
#include "apps/cli/verbs/setting_options.h"
#include "sightline/tools/report/readable.h"
#include "sightline/tools/scene/one_line.h"

namespace sightline::cli {
using namespace tools;
namespace {

/// One of the kinds of work that a query does.
struct Work {
    const char* name;
    double (*of)(const FrameResult&);
};

constexpr Work kWork[] = {
    {"nodes of the hierarchy", [](const FrameResult& f) { return static_cast<double>(f.stats.nodes_visited); }},
    {"occluder triangles", [](const FrameResult& f) { return static_cast<double>(f.stats.occluder_triangles); }},
    {"pixels on seams", [](const FrameResult& f) { return static_cast<double>(f.stats.seam_pixels); }},
    {"objects kept", [](const FrameResult& f) { return static_cast<double>(f.objects_visible); }}};

/// What the frame did more of than the others.
std::string slowNote(const CullRun& run, const FrameResult& frame) {
    std::vector<double> times;
    for (const FrameResult& other : run.frames) times.push_back(other.query_microseconds);
    const double usual = medianOf(times);
    std::vector<std::pair<double, std::string>> parts;  // by how many times as much
    for (const Work& work : kWork) {
        std::vector<double> values;
        for (const FrameResult& other : run.frames) values.push_back(work.of(other));
        const double middle = medianOf(values), here = work.of(frame);
        if (here == 0 && middle == 0) continue;
        const double ratio = here / (middle > 0 ? middle : 1);
        parts.emplace_back(ratio,
                           fmt::format("{} {} ({:.1f} times)", grouped(static_cast<uint64_t>(here)), work.name, ratio));
    }
    std::stable_sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::string text = fmt::format("{} us, the median frame {} us.",
                                   grouped(static_cast<uint64_t>(std::llround(frame.query_microseconds))),
                                   grouped(static_cast<uint64_t>(std::llround(usual))));
    if (parts.empty() || parts.front().first < 1.05)
        return text +
               " Only the clock differs: no count of its work is larger than the path's median by a twentieth. The "
               "machine was "
               "busy, or memory was cold.";
    text += " Beside the medians of the path";
    for (size_t i = 0; i < parts.size(); ++i) text += (i ? ", " : ": ") + parts[i].second;
    return text + ".";
}

/// In which group an object belongs that was kept and not seen; smaller groups of doubt first.
std::string groupOf(const Explanation& why) {
    const VisibleReason& reason = why.visible;
    switch (reason.because) {
        case KeptBecause::kOpenPixel:
            break;
        case KeptBecause::kViewNotUsable:
            return "the view's matrices cannot be used";
        case KeptBecause::kBoundsNotUsable:
            return "bounds that are empty, not finite or too far away";
        case KeptBecause::kHoldsEye:
            return "the eye is inside their boxes";
        case KeptBecause::kNearPlane:
            return "their boxes reach across the near plane";
        case KeptBecause::kNotProjectable:
            return "their boxes cannot be projected without too much rounding";
        case KeptBecause::kStageOff:
            return "a stage that would look at them is off";
        case KeptBecause::kBudgetSpent:
            return "the budget of occluder triangles was spent before what would hide them was drawn";
    }
    if (reason.covered) return "what covers them is not in front of the nearest point of their boxes";
    if (2 * reason.open_pixels < reason.pixels) return "their boxes reach past what hides them";
    return "what hides them, if anything does, covers few whole pixels of their boxes";
}

/// Why the frame keeps what no witness saw.
std::vector<std::string> looseNotes(const Scene& scene, const RunOptions& options, std::optional<LoadedWorld> world,
                                    const CullRun& run, const FrameResult& frame) {
    // So many are explained, of more every so-manyth; fewer in large scenes, where each takes longer.
    const size_t most = std::clamp<size_t>(3'000'000 / std::max<size_t>(scene.objects.size(), 1), 20, 300);
    const std::vector<uint32_t>& unseen = frame.verification->kept_unseen;
    std::vector<std::string> notes;
    notes.push_back(fmt::format("{} of {} kept objects were seen by no witness.", grouped(unseen.size()),
                                grouped(frame.objects_visible)));
    if (unseen.empty()) return notes;
    const AskedScene asked = world ? AskedScene(scene, std::move(*world)) : AskedScene(scene, options);
    View view = viewOf(frame.camera, options);
    view.width = run.width;
    view.height = run.height;
    Explainer explainer(asked.now, view, options.settings);
    std::map<std::string, std::vector<uint32_t>> groups;
    const size_t step = (unseen.size() + most - 1) / most;
    size_t asked_for = 0;
    Progress progress("explaining", "objects", (unseen.size() + step - 1) / step);
    for (size_t i = 0; i < unseen.size() && !interrupted(); i += step, ++asked_for) {
        const Explanation why = explainer.explain(asked.loaded.ids[unseen[i]], {false, false});
        if (why.verdict == Verdict::kVisible) groups[groupOf(why)].push_back(unseen[i]);
        progress.step();
    }
    std::vector<std::pair<size_t, std::string>> lines;
    for (const auto& [reason, objects] : groups) {
        std::string line =
            fmt::format("{}: {}; as {}", counted(objects.size(), "object"), reason, titleOf(scene, objects.front()));
        if (objects.size() > 1) line += " and " + titleOf(scene, objects[1]);
        lines.emplace_back(objects.size(), line + ".");
    }
    std::stable_sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    if (step > 1) notes.push_back(fmt::format("Of these, {} were asked why they were kept:", grouped(asked_for)));
    for (const auto& [count, line] : lines) notes.push_back(line);
    return notes;
}

double overEstimateOf(const FrameResult& frame) {
    return static_cast<double>(frame.visible.size()) / static_cast<double>(frame.verification->exactly_visible);
}

double percentOf(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

/// 1234567 as "1.23 M".
std::string rounded(double number) {
    if (number >= 1e9) return fmt::format("{:.2f} G", number * 1e-9);
    if (number >= 1e6) return fmt::format("{:.2f} M", number * 1e-6);
    if (number >= 1e4) return fmt::format("{:.1f} k", number * 1e-3);
    return fmt::format("{}", readable(number));
}

/// "1.234", or that nothing is visible.
std::string fixedRatio(double ratio) {
    return std::isfinite(ratio) ? fmt::format("{:.3f}", ratio) : "without a measure";
}

double medianQuery(const CullRun& run) {
    std::vector<double> times;
    for (const FrameResult& frame : run.frames) times.push_back(frame.query_microseconds);
    return medianOf(std::move(times));
}

/// What is culled is judged drawn object by drawn object: of several that share a key, each is an instance.
bool countsInstances(const CullRun& run) { return run.instances != run.objects; }

/// "49 culled instances"; over several frames each cull counts.
std::string culledText(uint64_t count, const CullRun& run, size_t frames) {
    const char* const unit = countsInstances(run) ? "instance" : "object";
    if (frames == 1) return grouped(count) + " culled " + unit + "s";
    return fmt::format("{} of {} over {} frames", counted(count, "cull"),
                       counted(countsInstances(run) ? run.instances : run.objects, unit), frames);
}

/// What the exact proofs say, if there are any.
void addProofs(std::string& text, const Verification& sum, const CullRun& run, size_t judged) {
    if (!sum.proofs) return;
    const ProofCounts& proofs = *sum.proofs;
    const uint64_t culled = proofs.culled_hidden + proofs.culled_undecided + sum.false_instances;
    if (culled > 0)
        text += fmt::format(
            "proved       {} of {} hidden, by exact arithmetic{}{}\n", grouped(proofs.culled_hidden),
            culledText(culled, run, judged), run.stereo > 0 ? "; each eye counts" : "",
            proofs.culled_undecided > 0 ? fmt::format("; {} undecided", grouped(proofs.culled_undecided)) : "");
    if (proofs.kept_hidden + proofs.kept_undecided > 0)
        text +=
            fmt::format("kept         {} although hidden, by exact arithmetic: no error, but work for the renderer{}\n",
                        grouped(proofs.kept_hidden),
                        proofs.kept_undecided > 0 ? fmt::format("; {} undecided", grouped(proofs.kept_undecided)) : "");
}

void addSums(std::string& text, const Verification& sum, const CullRun& run) {
    const size_t judged = judgedFrames(run);
    const std::string by = fmt::format("by {} rays and {} id samples", rounded(static_cast<double>(sum.rays)),
                                       rounded(static_cast<double>(sum.id_samples)));
    if (sum.culled_instances == 0)
        text += fmt::format("verified     nothing: no {} was culled, so there was nothing to judge\n",
                            countsInstances(run) ? "instance" : "object");
    else
        text +=
            fmt::format("verified     {} of {} {} visible, {}\n", grouped(sum.false_instances),
                        culledText(sum.culled_instances, run, judged), sum.false_instances == 1 ? "was" : "were", by);
    text += fmt::format("over-estimate {}: {} reported, {} exactly visible, over {}\n", fixedRatio(sum.overEstimate()),
                        counted(sum.reported, "object"), grouped(sum.exactly_visible), counted(judged, "frame"));
    addProofs(text, sum, run, judged);
    if (sum.lossy_seen > 0)
        text += fmt::format(
            "not proved   {} objects that were culled by distance, contribution, budget or depth were seen: so "
            "they were asked to\n",
            grouped(sum.lossy_seen));
    if (judged < run.frames.size())
        text += fmt::format("unverified   {} of {} frames\n", run.frames.size() - judged, run.frames.size());
}

/// What one setting switched off of another: a line each.
void addOff(std::string& text, const CullRun& run) {
    const uint32_t of_tool = run.settings.stateless ? offBit(Off::kMemoryByStateless) : 0;  // --remember is asked for
    for (const OffRow& row : kOffRows) {
        const auto is_off = [&](const FrameResult& frame) { return (frame.stats.off & offBit(row.off)) != 0; };
        const auto count = static_cast<size_t>(std::count_if(run.frames.begin(), run.frames.end(), is_off));
        if (count == 0 || offBit(row.off) & of_tool) continue;
        text += fmt::format(
            "switched off {}{}\n", row.words,
            count < run.frames.size() ? fmt::format(" (in {} of {} frames)", count, run.frames.size()) : "");
    }
}

void addChanges(std::string& text, const CullRun& run) {
    if (const auto changes = sumChanges(run))
        text += fmt::format("changed      {:>10} pixels   {:7.4f} %: what was culled although it may be visible\n",
                            grouped(changes->changed),
                            percentOf(static_cast<double>(changes->changed), static_cast<double>(changes->pixels)));
}

/// What the stage of clusters left of the triangles of kept objects.
void addClusters(std::string& text, const CullRun& run) {
    ClusterRow sum;
    for (const FrameResult& frame : run.frames) {
        if (!frame.clusters) continue;
        sum.tested += frame.clusters->tested;
        sum.back += frame.clusters->back;
        sum.outside += frame.clusters->outside;
        sum.hidden += frame.clusters->hidden;
        sum.whole += frame.clusters->whole;
        sum.drawn += frame.clusters->drawn;
        sum.draws += frame.clusters->draws;
    }
    if (sum.tested == 0) return;
    const auto all = static_cast<double>(sum.tested), frames = static_cast<double>(run.frames.size());
    text +=
        fmt::format("clusters     {:>10} tested   {:.1f} % seen from the back, {:.1f} % outside, {:.1f} % hidden\n",
                    rounded(all / frames), percentOf(static_cast<double>(sum.back), all),
                    percentOf(static_cast<double>(sum.outside), all), percentOf(static_cast<double>(sum.hidden), all));
    text += fmt::format("of these     {:>10} triangles {:.3f} % of those objects', in {} draws\n",
                        rounded(static_cast<double>(sum.drawn) / frames),
                        percentOf(static_cast<double>(sum.drawn), static_cast<double>(sum.whole)),
                        rounded(static_cast<double>(sum.draws) / frames));
}

/// What levels of detail save, and by how much they may err.
void addLods(std::string& text, const CullRun& run) {
    if (!(run.settings.stages & stageBit(Stage::kLod))) return;
    double finest = 0, drawn = 0, cost = 0;
    size_t exceeded = 0;
    for (const FrameResult& frame : run.frames) {
        finest += static_cast<double>(frame.stats.lod_finest);
        drawn += static_cast<double>(frame.stats.lod_triangles);
        cost += static_cast<double>(frame.stats.lod_cost);
        exceeded += frame.stats.lod_exceeded;
    }
    const auto frames = static_cast<double>(run.frames.size());
    text += fmt::format("levels       {:>10} triangles {:.3f} % of the finest levels'", rounded(drawn / frames),
                        percentOf(drawn, finest));
    if (run.settings.budget == 0)
        text += fmt::format("; they err by {} px at most, in a corner {}", readable(run.settings.lod_error, 6),
                            readable(run.settings.lod_error * run.corner_stretch, 3));
    text += '\n';
    if (run.settings.budget == 0) return;
    text += fmt::format("budget       {:>10.3f} ms of {} ms modelled", 1e-6 * cost / frames,
                        readable(run.settings.budget, 6));
    if (exceeded > 0) text += fmt::format("; exceeded in {}", counted(exceeded, "frame"));
    text += '\n';
}

/// What a query that remembers did without drawing.
void addMemory(std::string& text, const CullRun& run) {
    if (run.settings.stateless || run.frames.empty() || !(run.settings.stages & stageBit(Stage::kOcclusion))) return;
    uint64_t undrawn = 0, proved = 0, unasked = 0;
    for (const FrameResult& frame : run.frames) {
        undrawn += frame.stats.occluder_triangles == 0;
        proved += frame.stats.proved;
        unasked += frame.stats.unasked;
    }
    const auto frames = static_cast<double>(run.frames.size());
    text += fmt::format("remembered   {:>10} of {} without drawing; a frame {} certificates held, {} kept unasked\n",
                        undrawn, counted(run.frames.size(), "frame"), rounded(static_cast<double>(proved) / frames),
                        rounded(static_cast<double>(unasked) / frames));
}

}  // namespace

void noteFrames(const Scene& scene, const RunOptions& options, std::optional<LoadedWorld> world, CullRun& run) {
    FrameResult *slowest = nullptr, *loosest = nullptr;
    for (FrameResult& frame : run.frames) {
        if (!slowest || frame.query_microseconds > slowest->query_microseconds) slowest = &frame;
        if (!frame.verification || frame.verification->exactly_visible == 0) continue;
        if (!loosest || overEstimateOf(frame) > overEstimateOf(*loosest)) loosest = &frame;
    }
    if (slowest && run.frames.size() > 1) slowest->notes.push_back("Slowest: " + slowNote(run, *slowest));
    if (!loosest) return;
    const std::vector<std::string> notes = looseNotes(scene, options, std::move(world), run, *loosest);
    for (size_t i = 0; i < notes.size(); ++i) loosest->notes.push_back((i ? "" : "Loosest: ") + notes[i]);
}

void printSummary(std::FILE* out, const CullRun& run) {
    const auto frames = static_cast<double>(run.frames.size());
    const bool instances = countsInstances(run);
    const auto all = static_cast<double>(instances ? run.instances : run.objects);
    double visible = 0, drawn = 0, triangles = 0, time = 0, slowest = 0;
    double culled[kStageCount] = {}, took[kStageCount] = {};
    bool budget_spent = false;
    for (const FrameResult& frame : run.frames) {
        visible += static_cast<double>(frame.visible.size());
        drawn += static_cast<double>(frame.objects_visible);
        triangles += static_cast<double>(frame.triangles);
        time += frame.query_microseconds;
        slowest = std::max(slowest, frame.query_microseconds);
        budget_spent |= frame.stats.budget_spent;
        for (int stage = 0; stage < kStageCount; ++stage) {
            const StageRow& row = frame.stages[stage];
            culled[stage] += static_cast<double>(instances ? row.instances : row.culled);
            took[stage] += row.microseconds;
        }
    }
    std::string text;
    text +=
        fmt::format("{}: {}{}, {}; {} of {}x{}, means over the frames\n", oneLine(run.scene),
                    counted(run.objects, "object"), instances ? " drawn as " + counted(run.instances, "instance") : "",
                    counted(run.triangles, "triangle"), counted(run.frames.size(), "frame"), run.width, run.height);
    text += fmt::format("visible      {:>10} {:<8} {:7.3f} %\n", rounded(visible / frames),
                        visible == frames ? "object" : "objects",
                        percentOf(visible / frames, static_cast<double>(run.objects)));
    if (instances)
        text +=
            fmt::format("             {:>10} {:<8} {:6.3f} %; culls below are of instances\n", rounded(drawn / frames),
                        drawn == frames ? "instance" : "instances", percentOf(drawn / frames, all));
    for (const Stage stage : kStageOrder) {
        if (!(countedStages(run.settings.stages) & stageBit(stage))) continue;
        const int at = static_cast<int>(stage);
        // What the second look finds is timed with the stage of occlusion.
        if (stage == Stage::kFacing && culled[at] == 0) continue;
        text += fmt::format("{:<12} {:>10} culled   {:7.3f} %", kStageNames[at], rounded(culled[at] / frames),
                            percentOf(culled[at] / frames, all));
        text += stage == Stage::kFacing ? "  their faces in the view look away\n"
                                        : fmt::format("  {:9.1f} us\n", took[at] / frames);
    }
    text += fmt::format("triangles    {:>10} submitted {:6.3f} % of the scene's\n", rounded(triangles / frames),
                        percentOf(triangles / frames, static_cast<double>(run.triangles)));
    addClusters(text, run);
    addLods(text, run);
    text += fmt::format("query        {:>10.1f} us mean, {:.1f} us median, {:.1f} us at most\n", time / frames,
                        medianQuery(run), slowest);
    addMemory(text, run);
    addOff(text, run);
    if (const std::string own = ownDefaults(run.settings); !own.empty())
        text += fmt::format("defaults     unlike the library's: {}\n", own);
    if (budget_spent) text += fmt::format("the work budget was spent in some frames: more was kept than need be\n");
    addChanges(text, run);
    if (const auto sum = sumVerification(run)) addSums(text, *sum, run);
    tell(out, text);
}

void printVerdicts(std::FILE* out, const CullRun& run) {
    std::string text;
    for (size_t i = 0; i < run.frames.size(); ++i) {
        const FrameResult& frame = run.frames[i];
        if (!frame.verification) continue;
        const VerificationRow& row = *frame.verification;
        Verification one;
        one.reported = frame.visible.size();
        one.exactly_visible = row.exactly_visible;
        const std::string verdict = row.false_culls > 0                      ? paint(out, Tone::kBad, "WRONG")
                                    : frame.objects_visible == run.instances ? "nothing culled"
                                                                             : paint(out, Tone::kGood, "sound");
        text += fmt::format("frame {:>4}: {}, {} false culls, {} reported, {} exactly visible, over-estimate {}\n", i,
                            verdict, row.false_culls, frame.visible.size(), row.exactly_visible,
                            fixedRatio(one.overEstimate()));
    }
    addOff(text, run);
    addChanges(text, run);
    if (const auto sum = sumVerification(run)) addSums(text, *sum, run);
    tell(out, text);
}

std::string replayOfRun(const RunOptions& options, bool verify) {
    std::string command = "sightline cull " + options.scene.words();
    const PathChoice& choice = options.choice;
    if (!choice.file.empty()) command += " --cameras " + quoted(choice.file);
    if (!options.eye.empty()) command += " --eye " + options.eye;
    if (!options.look.empty()) command += " --look " + options.look;
    if (!options.path.empty()) command += " --path " + options.path;
    if (choice.walk.frames > 0) command += fmt::format(" --frames {}", choice.walk.frames);
    if (choice.seeded) command += fmt::format(" --seed {}", choice.walk.seed);
    if (choice.walk.fps != WalkSettings().fps) command += fmt::format(" --fps {}", choice.walk.fps);
    if (choice.speed_given) command += fmt::format(" --speed {}", choice.walk.speed);
    command += fmt::format(" --size {}x{}", options.width, options.height);
    const auto list = [&](const char* option, const std::vector<std::string>& names) {
        if (!names.empty()) command += fmt::format(" {} {}", option, joined(names, ","));
    };
    list("--use", options.use);
    list("--skip", options.skip);
    command += settingWords(options.settings) + sectionOptionsOf(options.sections) +
               visibilityOptionsOf(options.visibility) + clusterOptionsOf(options.cluster_test);
    if (options.jitter != View().jitter) command += fmt::format(" --jitter {}", options.jitter);
    if (options.stereo > 0) command += fmt::format(" --stereo {}", options.stereo);
    if (!options.settings.stateless) command += " --remember";
    if (options.propose) command += " --propose";
    if (options.taught) command += " --taught";
    if (verify) command += fmt::format(" --verify --rays {}{}", options.rays, options.no_proofs ? " --no-proofs" : "");
    return command;
}

}  // namespace sightline::cli
