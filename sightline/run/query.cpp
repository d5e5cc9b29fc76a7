// What can be seen in a snapshot from a view: one front-to-back walk, frustum and occlusion.
// SPDX-License-Identifier: MIT
#include "sightline/run/query.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "sightline/run/bins.h"
#include "sightline/run/cluster_stage.h"
#include "sightline/run/explain.h"

namespace sightline {

struct Query::Impl {
    Impl(Memory* from, Jobs* hook) : memory(from), jobs(hook) {}

    static constexpr uint32_t kTaken = 4;  ///< in `mark`, beside the eyes: it stands in `both`

    /// The objects of the last answer.
    Array<Visible>& last() { return stereo ? both : walk.visible(); }
    void mergeEyes();
    void findScissors();
    std::span<const uint32_t> shownIf(bool remembers) const {
        return remembers ? shown.generations() : std::span<const uint32_t>();
    }

    Memory* const memory;
    Jobs* const jobs;
    Snapshot snapshot;                ///< of the last answer
    detail::BinnedWalk walk{memory};  ///< of the left eye, where there are two
    Owned<detail::BinnedWalk> right;  ///< made when first needed
    detail::ClusterStage clusters{memory};
    bool stereo = false;                   ///< the last answer was visibleStereo()'s
    Array<Visible> both{memory};           ///< what either eye sees
    Array<uint8_t> eyes{memory};           ///< per object of `both`
    mutable Array<uint8_t> other{memory};  ///< the right eye's reasons, while both are put together
    Array<Visible> before{memory};         ///< the answer before the last
    detail::LastShown shown{memory};       ///< of that answer, while one is made that hangs on it
    Array<ImageRect> scissors{memory};
    Array<SeenWindow> windows{memory};
    View view;  ///< of the last answer, of the left eye
    Array<float> depth_image{memory};
    Array<uint8_t> depth_covered{memory};
    Array<Visible> appeared{memory}, disappeared{memory};
    Array<uint32_t> mark{memory};  ///< per ObjectId::index: 1 + place in `before`, while changes() runs; else 0
};

Query::Query(Memory* memory, Jobs* jobs) : impl_(makeOwned<Impl>(memory, memory, jobs)) {}
Query::~Query() = default;
Query::Query(Query&&) noexcept = default;
Query& Query::operator=(Query&&) noexcept = default;

namespace {

uint64_t since(std::chrono::steady_clock::time_point start) {
    return static_cast<uint64_t>(
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - start).count());
}

/// Walks for one eye or for both, and takes the time: of both together each has its share.
void answer(std::span<detail::BinnedWalk* const> eyes, const Snapshot& now, std::span<const View* const> views,
            std::span<const uint32_t> shown, Jobs* jobs) {
    const auto start = std::chrono::steady_clock::now();
    uint32_t bins = 0;
    for (size_t eye = 0; eye < eyes.size(); ++eye) {
        eyes[eye]->begin(now, *views[eye], shown);
        bins += eyes[eye]->bins();
    }
    runJobs(jobs, bins, [&](uint32_t bin) {
        const uint32_t first = eyes[0]->bins();
        bin < first ? eyes[0]->run(bin) : eyes[1]->run(bin - first);
    });
    uint64_t busy = 0;
    for (detail::BinnedWalk* eye : eyes) {
        eye->finish();
        busy += eye->stats.nanoseconds;
    }
    const double share = static_cast<double>(since(start)) / static_cast<double>(std::max<uint64_t>(busy, 1));
    for (detail::BinnedWalk* eye : eyes)
        eye->timed(static_cast<uint64_t>(share * static_cast<double>(eye->stats.nanoseconds)));
}

}  // namespace

VisibleSet Query::visible(const Snapshot& now, const View& view) {
    Impl& impl = *impl_;
    std::swap(impl.last(), impl.before);
    impl.stereo = false;
    impl.snapshot = now;
    const bool remembers = detail::remembersShown(view);
    if (remembers) impl.shown.mark(impl.before);
    answer({{&impl.walk}}, now, {{&view}}, impl.shownIf(remembers), impl.jobs);
    if (remembers) impl.shown.unmark(impl.before);
    impl.clusters.run(now ? &now.state() : nullptr, view, impl.walk);
    impl.view = view;
    impl.findScissors();
    return {impl.walk.visible(), impl.walk.stats, impl.clusters.ranges(), impl.scissors};
}

StereoSet Query::visibleStereo(const Snapshot& now, const View& left, const View& right) {
    Impl& impl = *impl_;
    std::swap(impl.last(), impl.before);
    impl.stereo = true;
    impl.snapshot = now;
    if (!impl.right) impl.right = makeOwned<detail::BinnedWalk>(impl.memory, impl.memory);
    detail::BinnedWalk* const eyes[] = {&impl.walk, impl.right.get()};
    const View* const views[] = {&left, &right};
    const bool remembers = detail::remembersShown(left) || detail::remembersShown(right);
    if (remembers) impl.shown.mark(impl.before);
    const auto shown = impl.shownIf(remembers);
    if (impl.jobs) {
        answer(eyes, now, views, shown, impl.jobs);
    } else {
        for (size_t eye : {0, 1}) answer({&eyes[eye], 1}, now, {&views[eye], 1}, shown, nullptr);
    }
    if (remembers) impl.shown.unmark(impl.before);
    impl.mergeEyes();
    impl.view = left;
    return {impl.both, impl.eyes, impl.walk.stats, impl.right->stats};
}

/// The left eye's objects in their order; what the right eye sees alone stands behind what it sees before it.
void Query::Impl::mergeEyes() {
    uint32_t last = 0;
    for (const auto* set : {&walk.visible(), &right->visible()})
        for (const Visible& v : *set) last = std::max(last, v.id.index);
    if (mark.size() <= last) mark.resize(last + 1, 0);
    for (const Visible& v : walk.visible()) mark[v.id.index] = kLeftEye;
    for (const Visible& v : right->visible()) mark[v.id.index] |= kRightEye;
    both.clear();
    eyes.clear();
    const auto take = [&](const Visible& v) {
        both.push_back(v);
        eyes.push_back(static_cast<uint8_t>(mark[v.id.index]));
    };
    size_t at = 0;
    for (const Visible& v : right->visible()) {
        if (mark[v.id.index] == kRightEye) {
            take(v);
            continue;
        }
        // A shared one: the left eye's objects up to it, unless they stand here already.
        size_t end = at;
        if (mark[v.id.index] & kTaken) continue;
        do {
            take(walk.visible()[end]);
            mark[walk.visible()[end].id.index] |= kTaken;
        } while (walk.visible()[end++].id != v.id);
        at = end;
    }
    for (; at < walk.visible().size(); ++at) take(walk.visible()[at]);
    for (const Visible& v : both) mark[v.id.index] = 0;
}

/// In viewport pixels from the left and the top.
ImageRect imageOf(double left, double bottom, double right, double top, const View& view) {
    return {0.5 * view.width * (1.0 + left), 0.5 * view.height * (1.0 - top), 0.5 * view.width * (1.0 + right),
            0.5 * view.height * (1.0 - bottom)};
}

void Query::Impl::findScissors() {
    scissors.clear();
    const detail::Admission* const admission = walk.admission();
    if (!admission || !admission->uses(Stage::kPortals)) return;
    const double width = view.width, height = view.height;
    for (const Visible& v : walk.visible()) {
        const uint32_t place = snapshot.state().placeOf(v.id);
        const detail::WindowRect* window = place == PlacedBvh::kNone ? nullptr : admission->window(place);
        ImageRect rect{0, 0, width, height};
        if (window) {
            // The image may be shifted by the jitter; a thousandth of a pixel is for rounding.
            const double more = view.jitter + 1e-3;
            const ImageRect in = imageOf(static_cast<double>(window->left), static_cast<double>(window->bottom),
                                         static_cast<double>(window->right), static_cast<double>(window->top), view);
            rect = {std::clamp(std::floor(in.left - more), 0.0, width),
                    std::clamp(std::floor(in.top - more), 0.0, height),
                    std::clamp(std::ceil(in.right + more), 0.0, width),
                    std::clamp(std::ceil(in.bottom + more), 0.0, height)};
        }
        scissors.push_back(rect);
    }
}

std::span<const SeenWindow> Query::windows() {
    Impl& impl = *impl_;
    impl.windows.clear();
    const PortalFlood* const flood = impl.walk.cells().flood();
    if (!flood) return {};
    for (const SeenCell& seen : flood->cells())
        impl.windows.push_back(
            {seen.cell, imageOf(seen.left, seen.bottom, seen.right, seen.top, impl.view), seen.from, seen.portal});
    return impl.windows;
}

CellStats Query::cellStats() const {
    const detail::CellStages& cells = impl_->walk.cells();
    const PortalStats& stats = cells.portalStats();
    return {cells.flood() != nullptr, stats.cells, stats.portals, stats.whole, stats.too_deep, stats.work_spent};
}

VisibleChanges Query::changes() {
    Impl& impl = *impl_;
    impl.appeared.clear();
    impl.disappeared.clear();
    uint32_t last = 0;
    for (const auto* set : {&impl.before, &impl.last()})
        for (const Visible& v : *set) last = std::max(last, v.id.index);
    if (impl.mark.size() <= last) impl.mark.resize(last + 1, 0);
    for (size_t i = 0; i < impl.before.size(); ++i) impl.mark[impl.before[i].id.index] = static_cast<uint32_t>(i + 1);
    for (const Visible& v : impl.last()) {
        uint32_t& mark = impl.mark[v.id.index];
        if (mark > 0 && impl.before[mark - 1].id == v.id) mark = 0;
        else impl.appeared.push_back(v);
    }
    for (const Visible& v : impl.before) {
        uint32_t& mark = impl.mark[v.id.index];
        if (mark > 0) impl.disappeared.push_back(v);
        mark = 0;
    }
    return {impl.appeared, impl.disappeared};
}

void Query::reasons(std::span<uint8_t> reasons) const {
    const Impl& impl = *impl_;
    impl.walk.reasons(reasons);
    if (!impl.stereo) {
        if (impl.snapshot) impl.clusters.reasons(impl.snapshot.state(), reasons);
        return;
    }
    impl.other.resize(reasons.size());
    impl.right->reasons(impl.other);
    constexpr uint8_t kOutside = 255;
    for (size_t i = 0; i < reasons.size(); ++i) {
        const uint8_t a = reasons[i], b = impl.other[i];
        if (a == 0 || b == 0) reasons[i] = 0;
        else reasons[i] = a == kOutside ? b : b == kOutside ? a : std::max(a, b);
    }
}

void Query::reasons(std::span<uint8_t> reasons, uint8_t eye) const {
    const Impl& impl = *impl_;
    if (impl.stereo) (eye == kRightEye ? *impl.right : impl.walk).reasons(reasons);
    else this->reasons(reasons);
}

Explanation Query::explain(const Snapshot& now, const View& view, ObjectId id) const {
    return Explainer(now, view, impl_->last(), impl_->memory).explain(id);
}

Query::DepthImage Query::depthImage(bool resolve_seams) {
    Impl& impl = *impl_;
    const size_t pixels = size_t{impl.walk.width()} * impl.walk.height();
    impl.depth_image.resize(pixels);
    impl.depth_covered.resize(pixels);
    impl.walk.depthImage(resolve_seams ? Seams::kResolve : Seams::kLeave, impl.depth_image, impl.depth_covered);
    return {impl.walk.width(), impl.walk.height(), impl.walk.screen().perspective, impl.depth_image,
            impl.depth_covered};
}

}  // namespace sightline
