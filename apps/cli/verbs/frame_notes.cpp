// Why the slowest frame of a run is slow, and why the loosest keeps what nobody sees: lines for a reader.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/frame_notes.h"

#include <algorithm>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/explain_object.h"

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
    std::string text = fmt::format("{:.0f} us, the median frame {:.0f} us. Beside the medians of the path",
                                   frame.query_microseconds, usual);
    for (size_t i = 0; i < parts.size(); ++i) text += (i ? ", " : ": ") + parts[i].second;
    if (parts.empty() || parts.front().first < 1.05)
        text += ". It did no more than others: the machine was busy, or memory was cold";
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
    constexpr size_t kMost = 300;  // explained: of more, every so-manyth
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
    const size_t step = (unseen.size() + kMost - 1) / kMost;
    size_t asked_for = 0;
    for (size_t i = 0; i < unseen.size() && !interrupted(); i += step, ++asked_for) {
        const Explanation why = explainer.explain(asked.loaded.ids[unseen[i]], {false, false});
        if (why.verdict == Verdict::kVisible) groups[groupOf(why)].push_back(unseen[i]);
    }
    std::vector<std::pair<size_t, std::string>> lines;
    for (const auto& [reason, objects] : groups) {
        std::string line = fmt::format("{} object{}: {}; as {}", grouped(objects.size()),
                                       objects.size() == 1 ? "" : "s", reason, titleOf(scene, objects.front()));
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

}  // namespace sightline::cli
