// What can be seen in a snapshot from a view: the objects, what of them to draw, and what the answer cost.
// SPDX-License-Identifier: MIT
#include "sightline/query/query.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/frame/stopwatch.h"
#include "sightline/query/answer.h"
#include "sightline/query/explain/explain.h"

namespace sightline {

struct Query::Impl {
    Impl(Memory* from, Jobs* hook) : memory(from), jobs(hook) {}

    static constexpr uint32_t kTaken = 4;  ///< in `mark`, beside the eyes: it stands in `both`

    /// The objects of the last answer.
    Array<Visible>& last() { return stereo ? both : left.visible(); }
    void takeUp(bool pair);
    void ask(std::span<detail::Answer* const> eyes, const Snapshot& now, std::span<const View* const> views,
             const QuerySettings& settings);
    void mergeEyes();
    void noteOffOfTwo();
    void findScissors();

    Memory* const memory;
    Jobs* const jobs;
    detail::Answer left{memory};           ///< the only one, where there are not two eyes
    Owned<detail::Answer> right;           ///< made when first needed
    bool stereo = false;                   ///< the last answer was visibleStereo()'s
    Array<Visible> both{memory};           ///< what either eye sees
    Array<uint8_t> eyes{memory};           ///< per object of `both`
    mutable Array<uint8_t> other{memory};  ///< the right eye's reasons, while both are put together
    Array<Visible> before{memory};         ///< the answer before the last
    detail::LastShown shown{memory};       ///< of that answer, while one is made that depends on it
    Array<ObjectId> proposed{memory};      ///< by propose()
    Array<ImageRect> scissors{memory};
    Array<SeenWindow> windows{memory};
    Array<float> depth_image{memory};
    Array<uint8_t> depth_covered{memory};
    Array<Visible> appeared{memory}, disappeared{memory};
    Array<uint32_t> mark{
        memory};  ///< per ObjectId::index, 0 between calls: for changes(), 1 + index into `before`; for
                  ///< mergeEyes(), the eyes that see it, and kTaken
};

Query::Query(Memory* memory, Jobs* jobs) : impl_(makeOwned<Impl>(memory, memory, jobs)) {}
Query::~Query() = default;
Query::Query(Query&&) noexcept = default;
Query& Query::operator=(Query&&) noexcept = default;

/// The last answer becomes the one before.
void Query::Impl::takeUp(bool pair) {
    std::swap(last(), before);
    stereo = pair;
}

/// Answers for some eyes: takes up each view, runs all parts of all eyes on any threads, and puts the parts of each eye
/// together. The eyes share the elapsed time in proportion to their work.
void Query::Impl::ask(std::span<detail::Answer* const> eyes_asked, const Snapshot& now,
                      std::span<const View* const> views, const QuerySettings& settings) {
    SIGHTLINE_DEBUG_ASSERT(eyes_asked.size() == views.size() && (views.size() == 1 || views.size() == 2));
    const detail::Stopwatch watch;
    const auto remembered = shown.generations();
    uint32_t parts = 0;
    for (size_t eye = 0; eye < eyes_asked.size(); ++eye) {
        const bool remembers = detail::remembersShown(*views[eye], settings);
        eyes_asked[eye]->begin(now, *views[eye], settings, remembers ? remembered : std::span<const uint32_t>(),
                               proposed);
        parts += eyes_asked[eye]->parts();
    }
    runJobs(jobs, parts, [&](uint32_t part) {
        const uint32_t first = eyes_asked[0]->parts();
        part < first ? eyes_asked[0]->run(part) : eyes_asked[1]->run(part - first);
    });
    uint64_t busy = 0;
    for (detail::Answer* eye : eyes_asked) {
        eye->finish();
        busy += eye->stats.nanoseconds;
    }
    const double share = static_cast<double>(watch.nanoseconds()) / static_cast<double>(std::max<uint64_t>(busy, 1));
    for (detail::Answer* eye : eyes_asked)
        eye->timed(static_cast<uint64_t>(share * static_cast<double>(eye->stats.nanoseconds)));
}

void Query::propose(std::span<const ObjectId> hidden) { impl_->proposed.assign(hidden.begin(), hidden.end()); }

void Query::learn(Query& teacher) {
    if (&teacher == this) return;
    impl_->left.learn(teacher.impl_->left);
    if (impl_->right && teacher.impl_->right) impl_->right->learn(*teacher.impl_->right);
}

VisibleSet Query::visible(const Snapshot& now, const View& view, const QuerySettings& settings) {
    Impl& impl = *impl_;
    impl.takeUp(false);
    if (impl.right) impl.right->forget();
    impl.shown.mark(impl.before, detail::remembersShown(view, settings));
    detail::Answer* const eye = &impl.left;
    const View* const from = &view;
    impl.ask({&eye, 1}, now, {&from, 1}, settings);
    impl.shown.unmark(impl.before);
    impl.left.refine();
    impl.findScissors();
    return {impl.left.visible(),
            impl.left.stats,
            impl.left.clusters().ranges(),
            impl.left.lods().lods().first(impl.left.lods().lods().empty() ? 0 : impl.left.visible().size()),
            impl.scissors,
            impl.left.frame().problem};
}

StereoSet Query::visibleStereo(const Snapshot& now, const View& left, const View& right,
                               const QuerySettings& settings) {
    Impl& impl = *impl_;
    impl.takeUp(true);
    if (!impl.right) impl.right = makeOwned<detail::Answer>(impl.memory, impl.memory);
    detail::Answer* const eyes[] = {&impl.left, impl.right.get()};
    const View* const views[] = {&left, &right};
    impl.shown.mark(impl.before, detail::remembersShown(left, settings) || detail::remembersShown(right, settings));
    if (impl.jobs) impl.ask(eyes, now, views, settings);
    else
        for (size_t eye : {0, 1}) impl.ask({&eyes[eye], 1}, now, {&views[eye], 1}, settings);
    impl.shown.unmark(impl.before);
    impl.mergeEyes();
    impl.noteOffOfTwo();
    const detail::Frame* const frames[] = {&impl.left.frame(), &impl.right->frame()};
    if (frames[0]->uses(Stage::kLod) && frames[1]->uses(Stage::kLod))
        impl.left.lods().run(frames, impl.both, impl.left.stats);
    return {impl.both,
            impl.eyes,
            impl.left.stats,
            impl.right->stats,
            impl.left.lods().lods(),
            impl.left.frame().problem,
            impl.right->frame().problem};
}

/// Puts both answers together: the left eye's objects in their order. An object that the right eye sees alone follows
/// the objects that the right eye sees before it.
void Query::Impl::mergeEyes() {
    uint32_t last = 0;
    for (const auto* set : {&left.visible(), &right->visible()})
        for (const Visible& v : *set) last = std::max(last, v.id.index);
    if (mark.size() <= last) mark.resize(last + 1, 0);
    for (const Visible& v : left.visible()) {
        SIGHTLINE_DEBUG_ASSERT(mark[v.id.index] == 0);
        mark[v.id.index] = kLeftEye;
    }
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
            SIGHTLINE_DEBUG_ASSERT(end < left.visible().size());
            take(left.visible()[end]);
            mark[left.visible()[end].id.index] |= kTaken;
        } while (left.visible()[end++].id != v.id);
        at = end;
    }
    for (; at < left.visible().size(); ++at) take(left.visible()[at]);
    for (const Visible& v : both) mark[v.id.index] = 0;
    SIGHTLINE_DEBUG_ASSERT(both.size() == eyes.size());
}

void Query::Impl::noteOffOfTwo() {
    for (detail::Answer* eye : {&left, right.get()}) {
        const detail::Frame& frame = eye->frame();
        if (!frame.world || !frame.usable) continue;
        if (frame.uses(Stage::kClusters) && frame.world->clusters.size() > 1)
            eye->stats.off =
                (eye->stats.off & ~offBit(Off::kClusterLookByCertificates)) | offBit(Off::kClustersByTwoEyes);
        if (frame.uses(Stage::kLod) && frame.settings.budget > 0.0 && frame.settings.hard_budget)
            eye->stats.off |= offBit(Off::kHardBudgetByTwoEyes);
    }
}

namespace {

/// In viewport pixels from the left and the top.
ImageRect imageOf(double left, double bottom, double right, double top, const View& view) {
    return {0.5 * view.width * (1.0 + left), 0.5 * view.height * (1.0 - top), 0.5 * view.width * (1.0 + right),
            0.5 * view.height * (1.0 - bottom)};
}

}  // namespace

void Query::Impl::findScissors() {
    scissors.clear();
    const detail::Frame& frame = left.frame();
    if (!frame.candidates || !frame.uses(Stage::kPortals)) return;
    const View& view = frame.view;
    const double width = view.width, height = view.height;
    for (const Visible& v : left.visible()) {
        const uint32_t place = frame.world->placeOf(v.id);
        const detail::WindowRect* window = place == PlacedBvh::kNone ? nullptr : frame.candidates->window(place);
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
    const PortalFlood* const flood = impl.left.cells().flood();
    if (!flood) return {};
    for (const SeenCell& seen : flood->cells())
        impl.windows.push_back({seen.cell,
                                imageOf(seen.left, seen.bottom, seen.right, seen.top, impl.left.frame().view),
                                seen.from, seen.portal});
    return impl.windows;
}

CellStats Query::cellStats() const {
    const detail::CellMemory& cells = impl_->left.cells();
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
    for (size_t i = 0; i < impl.before.size(); ++i) {
        SIGHTLINE_DEBUG_ASSERT(impl.mark[impl.before[i].id.index] == 0);
        impl.mark[impl.before[i].id.index] = static_cast<uint32_t>(i + 1);
    }
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
    impl.left.reasons(reasons);
    if (!impl.stereo) {
        if (!impl.left.frame().world) return;
        impl.left.lods().reasons(*impl.left.frame().world, reasons);
        impl.left.clusters().reasons(*impl.left.frame().world, reasons);
        return;
    }
    impl.other.resize(reasons.size());
    impl.right->reasons(impl.other);
    constexpr uint8_t kOutside = 255;
    for (size_t i = 0; i < reasons.size(); ++i) {
        const uint8_t a = reasons[i], b = impl.other[i];
        if (a == 0 || b == 0) reasons[i] = 0;
        else reasons[i] = a == kOutside ? b : b == kOutside ? a : detail::finerReason(a, b);
    }
}

void Query::reasons(std::span<uint8_t> reasons, uint8_t eye) const {
    const Impl& impl = *impl_;
    if (impl.stereo) (eye == kRightEye ? *impl.right : impl.left).reasons(reasons);
    else this->reasons(reasons);
}

Query::Asked Query::asked() const {
    const detail::Frame& frame = impl_->left.frame();
    return {frame.snapshot, frame.view, frame.settings};
}

Explanation Query::explain(const Snapshot& now, const View& view, ObjectId id, const QuerySettings& settings) const {
    Explanation why = Explainer(now, view, settings, impl_->last(), impl_->memory).explain(id);
    why.unasked = impl_->left.wasUnasked(id) || (impl_->stereo && impl_->right->wasUnasked(id));
    if (!impl_->left.certificateOf(id, why.certificate) || why.verdict != Verdict::kVisible) return why;
    // Drawing keeps what the last answer proved to be hidden.
    if (why.certificate.empty()) {
        const bool away = impl_->left.reasonOf(id) == Stage::kFacing;
        why.verdict = away ? Verdict::kFacesAway : Verdict::kOutsideFrustum;
        why.frustum.by_triangles = !away;
        return why;
    }
    why.verdict = Verdict::kOccluded;
    for (const Visible& hider : why.certificate) why.occlusion.hiders.push_back({hider.id, hider.key, 0});
    return why;
}

bool Query::certificateOf(ObjectId id, Array<Visible>& hiders) const {
    hiders.clear();
    return impl_->left.certificateOf(id, hiders);
}

bool Query::certificateOf(ObjectId id, Array<HiderOutline>& outlines, Array<glm::dvec3>& corners) const {
    outlines.clear();
    corners.clear();
    return impl_->left.certificateOf(id, outlines, corners);
}

Query::DepthImage Query::depthImage(bool resolve_seams) {
    Impl& impl = *impl_;
    detail::Answer& eye = impl.left;
    const size_t pixels = size_t{eye.width()} * eye.height();
    impl.depth_image.resize(pixels);
    impl.depth_covered.resize(pixels);
    eye.depthImage(resolve_seams ? Seams::kResolve : Seams::kLeave, impl.depth_image, impl.depth_covered);
    return {eye.width(), eye.height(), eye.frame().screen.perspective, impl.depth_image, impl.depth_covered};
}

}  // namespace sightline
