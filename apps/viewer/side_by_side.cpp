// One view culled in five ways, side by side: what each keeps, what it misses, and what it takes.
// SPDX-License-Identifier: MIT
#include "apps/viewer/side_by_side.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include <epoxy/gl.h>
#include <fmt/core.h>

#include "apps/gl/queries.h"
#include "apps/gl/two_pass.h"
#include "sightline/cull/queries/occlusion_queries.h"
#include "sightline/tools/report/pictures/render_list.h"
#include "sightline/tree/world_bvh.h"

namespace sightline::viewer {
using namespace tools;
namespace {

template <class Work>
double millisecondsOf(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void sortOnce(std::vector<uint32_t>& numbers) {
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}  // namespace

/// What the ways of the GL draw, and by what.
struct SideBySide::OnGl {
    OnGl(GlContext in, const Scene& scene) : context(std::move(in)), list(scene) {}

    GlContext context;
    RenderList list;
    WorldBvh tree;  ///< over its items
    OcclusionQueries queries;
    std::optional<GlQueryDevice> device;
    std::optional<GlTwoPass> passes;

    std::span<const DrawItem> items() const { return list.list().items(); }
};

SideBySide::SideBySide(const Culler& culler) : culler_(culler) {}
SideBySide::~SideBySide() = default;

Result<std::unique_ptr<SideBySide>> SideBySide::create(const Culler& culler) {
    std::unique_ptr<SideBySide> made(new SideBySide(culler));
    if (const Status ready = made->prepare(); !ready) return ready.error();
    return made;
}

Status SideBySide::prepare() {
    Result<GlContext> context = GlContext::current();
    if (!context) return context.error();
    gl_ = std::make_unique<OnGl>(std::move(*context), culler_.scene());
    std::vector<Box3d> boxes;
    std::vector<uint32_t> numbers;
    for (const DrawItem& item : gl_->items()) {
        numbers.push_back(static_cast<uint32_t>(boxes.size()));
        boxes.push_back(culler_.boundsOf(item.id));
    }
    gl_->tree.build(boxes, numbers);
    Result<GlQueryDevice> device = GlQueryDevice::create(gl_->context, gl_->items(), GlQueryKind::kAny);
    if (!device) return device.error();
    gl_->device.emplace(std::move(*device));
    Result<GlTwoPass> passes = GlTwoPass::create(gl_->context, gl_->items(), makeCullParts(gl_->items()));
    if (!passes) return passes.error();
    gl_->passes.emplace(std::move(*passes));
    return success();
}

void SideBySide::askQuery(Way way, const View& view, const QuerySettings& settings) {
    Query& query = way == Way::kCertificates ? remembering_ : way == Way::kProposals ? proposed_to_ : drawing_;
    QuerySettings asked = settings;
    asked.time_stages = false;
    asked.stateless = way == Way::kTiles;
    asked.proofs = way != Way::kTiles;
    const VisibleSet set = query.visible(culler_.now(), view, asked);
    WayAnswer& answer = answerOf(way);
    answer.kept.clear();
    for (const Visible& visible : set.objects) answer.kept.push_back(culler_.objectOf(visible.id));
    sortOnce(answer.kept);
    answer.milliseconds = 1e-6 * static_cast<double>(set.stats.nanoseconds);
    answer.note = set.stats.occluder_triangles > 0 ? fmt::format("{} triangles drawn", set.stats.occluder_triangles)
                                                   : fmt::format("{} proofs, nothing drawn", set.stats.proved);
}

/// The image that all ways are held against.
Status SideBySide::drawAll(const View& view) {
    if (Status begun = gl_->device->beginFrame(view); !begun) return begun;
    std::vector<uint32_t> all(gl_->items().size());
    for (uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    gl_->device->draw(all);
    if (Status done = gl_->device->endFrame(); !done) return done;
    const Result<std::vector<uint32_t>> shown = gl_->device->readItems();
    if (!shown) return shown.error();
    seen_.clear();
    uint32_t last = GlQueryDevice::kNone;
    for (const uint32_t item : *shown) {
        if (item == last) continue;
        last = item;
        if (item != GlQueryDevice::kNone) seen_.push_back(gl_->items()[item].id);
    }
    sortOnce(seen_);
    return success();
}

Status SideBySide::askQueries(const View& view) {
    WayAnswer& answer = answerOf(Way::kQueries);
    answer.kept.clear();
    OcclusionQuerySettings settings;
    settings.rounding.depth_step = 0;  // the device's depth is a float
    Status done = success();
    answer.milliseconds = millisecondsOf([&] {
        if (done = gl_->device->beginFrame(view); !done) return;
        for (const uint32_t item : gl_->queries.draw(gl_->tree.now(), view, *gl_->device, settings))
            answer.kept.push_back(gl_->items()[item].id);
        done = gl_->device->endFrame();
    });
    sortOnce(answer.kept);
    const OcclusionQueryStats& stats = gl_->queries.stats();
    answer.note = fmt::format("{} questions, {} waits", stats.questions, stats.waits);
    return done;
}

Status SideBySide::askPyramid(const View& view) {
    WayAnswer& answer = answerOf(Way::kPyramid);
    answer.kept.clear();
    Status done = success();
    answer.milliseconds = millisecondsOf([&] { done = gl_->passes->draw(view); });
    if (!done) return done;
    const Result<GlTwoPass::Drawn> drawn = gl_->passes->readDrawn();
    if (!drawn) return drawn.error();
    size_t late = 0;
    for (size_t i = 0; i < drawn->early.size(); ++i) {  // a part is an item
        late += drawn->late[i] != 0;
        if ((drawn->early[i] | drawn->late[i]) != 0) answer.kept.push_back(gl_->items()[i].id);
    }
    sortOnce(answer.kept);
    answer.note = fmt::format("{} appeared late", late);
    return success();
}

/// What was kept or proposed before, and the last image did not show.
void SideBySide::proposeUnseen() {
    const std::vector<uint32_t>& kept = answerOf(Way::kProposals).kept;
    proposed_.insert(proposed_.end(), kept.begin(), kept.end());
    sortOnce(proposed_);
    std::erase_if(proposed_, [&](uint32_t object) { return std::binary_search(seen_.begin(), seen_.end(), object); });
    std::vector<ObjectId> ids;
    for (const uint32_t object : proposed_) ids.push_back(culler_.idOf(object));
    proposed_to_.propose(ids);
}

Status SideBySide::ask(const View& view) {
    proposeUnseen();
    for (const Way way : {Way::kCertificates, Way::kProposals, Way::kTiles}) askQuery(way, view, culler_.settings);
    for (GLenum i = 0; i < 8; ++i) glDisable(GL_CLIP_DISTANCE0 + i);
    for (const auto step : {&SideBySide::askQueries, &SideBySide::askPyramid, &SideBySide::drawAll})
        if (Status done = (this->*step)(view); !done) return done;
    for (WayAnswer& answer : answers_) {
        answer.missed = 0;
        for (const uint32_t object : seen_)
            answer.missed += !std::binary_search(answer.kept.begin(), answer.kept.end(), object);
    }
    return success();
}

}  // namespace sightline::viewer
