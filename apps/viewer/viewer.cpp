// The viewer without its window: what the user did goes in, a picture comes out.
// SPDX-License-Identifier: MIT
#include "apps/viewer/viewer.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "apps/viewer/inks.h"
#include "sightline/tools/report/output_file.h"
#include "sightline/query/record/frame_recorder.h"
#include "sightline/tools/report/pictures/scene_look.h"
#include "sightline/tools/scene/scene_core.h"

namespace sightline::viewer {
using namespace tools;
namespace {

constexpr glm::dvec3 kSun(0.4, 0.8, 0.45);  // as the shading has it
constexpr size_t kMostBoxes = 40000;        // of culled objects
constexpr uint32_t kMostGhosts = 4000;      // objects that are drawn see-through
constexpr size_t kTimes = 240;              // frames that times are kept of
constexpr size_t kLeastRecorded = 10;       // frames: a shorter recording was a slip
constexpr double kPathFps = 30;             // of a path that is recorded or shown
constexpr uint32_t kAskedOfAll = 3;         // times that all ways are asked about a view: each remembers the one before
constexpr double kPaintSeconds = 12;        // that all pieces take to be painted

/// Pressed since the last frame.
bool pressedNow(const Input& now, const Input& last, uint16_t key) { return now.holds(key) && !last.holds(key); }

/// But for the time, and nothing held.
bool sameInput(const Input& a, const Input& b) {
    return a.mouse_x == b.mouse_x && a.mouse_y == b.mouse_y && a.wheel == 0 && a.text.empty() &&
           std::none_of(std::begin(a.keys), std::end(a.keys), [](bool held) { return held; }) &&
           std::none_of(std::begin(a.buttons), std::end(a.buttons), [](bool held) { return held; }) &&
           std::equal(std::begin(a.keys), std::end(a.keys), b.keys) &&
           std::equal(std::begin(a.buttons), std::end(a.buttons), b.buttons);
}

}  // namespace

Viewer::Viewer(const Scene& scene, LoadedWorld world, const QuerySettings& settings, ViewerSettings viewer)
    : scene_(scene), culler_(scene, std::move(world), settings), begun_(settings), settings_(std::move(viewer)) {
    bounds_ = coreOf(scene).bounds;
    size_ = diagonalOf(bounds_);
    if (!settings_.path.frames.empty()) eye.take(settings_.path.frames.front());
    culling = eye;
}

Viewer::~Viewer() = default;

Result<std::unique_ptr<Viewer>> Viewer::create(const Scene& scene, LoadedWorld world, const QuerySettings& settings,
                                               ViewerSettings viewer) {
    std::unique_ptr<Viewer> made(new Viewer(scene, std::move(world), settings, std::move(viewer)));
    if (const Status ready = made->prepare(); !ready) return ready.error();
    return made;
}

Status Viewer::prepare() {
    Result<SceneDrawer> drawer =
        SceneDrawer::create(scene_, [this](uint32_t mesh) { return culler_.clusterOrder(mesh); });
    if (!drawer) return drawer.error();
    drawer_.emplace(std::move(*drawer));
    for (std::optional<LineDrawer>* lines : {&lines_, &culled_lines_}) {
        Result<LineDrawer> made = LineDrawer::create();
        if (!made) return made.error();
        lines->emplace(std::move(*made));
    }
    Result<Gui> gui = Gui::create();
    if (!gui) return gui.error();
    gui_ = std::move(*gui);
    return success();
}

void Viewer::goTo(size_t frame) {
    if (settings_.path.frames.empty()) return;
    path_frame_ = std::min(frame, settings_.path.frames.size() - 1);
    eye.take(settings_.path.frames[path_frame_]);
    if (!state.frozen) culling = eye;
}

/// Those that were asked for, and the user's own.
ViewPlanes Viewer::sections() const {
    ViewPlanes planes = settings_.sections;
    if (!state.section) return planes;
    glm::dvec3 up = state.section_ahead;
    if (state.section_axis < 3) {
        up = glm::dvec3(0.0);
        up[state.section_axis] = 1;
    }
    double low = 0, high = 0;  // of the scene, along it
    for (int axis = 0; axis < 3; ++axis) {
        const double a = up[axis] * bounds_.min[axis], b = up[axis] * bounds_.max[axis];
        low += std::min(a, b);
        high += std::max(a, b);
    }
    const double at = glm::mix(low, high, static_cast<double>(state.section_at));
    const double sign = state.section_keeps_upper ? 1 : -1;
    planes.add(glm::dvec4(sign * up, -sign * at));
    return planes;
}

View Viewer::viewOf(const FlyCamera& camera, const ViewPlanes& sections) const {
    View view = camera.view(std::max(width_, 1u), std::max(height_, 1u));
    view.sections = sections;
    view.jitter = settings_.jitter;
    return view;
}

/// Depth reaches over the scene and what is drawn around it, for a parallel view has to be told.
GlView Viewer::glViewOf(const View& view) const {
    std::vector<glm::vec3> corners;
    DrawItem reach;
    const glm::dvec3 middle = bounds_.empty() ? glm::dvec3(0.0) : bounds_.center();
    for (int i = 0; i < 8; ++i)
        corners.push_back(static_cast<float>(size_) * glm::vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    reach.mesh.positions = corners;
    reach.transform[3] = glm::dvec4(middle, 1.0);
    return makeGlView(view, {&reach, 1});
}

/// Flies, looks and turns around what was chosen.
void Viewer::steer(const Input& input) {
    const double seconds = std::min(input.seconds, 0.1);
    const bool keys = !gui_.wantsKeys(), mouse = !gui_.wantsMouse();
    if (mouse && input.wheel != 0) state.speed = std::clamp(state.speed * std::pow(1.2f, input.wheel), 0.01f, 100.0f);
    if (keys && !input.control) {
        const double step =
            seconds * 0.1 * std::min(size_, 60.0) * static_cast<double>(state.speed) * (input.shift ? 4 : 1);
        const auto way = [&](uint16_t ahead, uint16_t back) { return step * (input.holds(ahead) - input.holds(back)); };
        eye.fly({way('D', 'A'), way('E', 'Q'), way('W', 'S')});
        const double turn = 1.5 * seconds;
        eye.look(turn * (input.holds(kRight) - input.holds(kLeft)), turn * (input.holds(kUp) - input.holds(kDown)));
    }
    const double right = static_cast<double>(input.mouse_x - last_.mouse_x),
                 down = static_cast<double>(input.mouse_y - last_.mouse_y);
    const bool held = (input.buttons[0] && last_.buttons[0]) || (input.buttons[1] && last_.buttons[1]) ||
                      (input.buttons[2] && last_.buttons[2]);
    if (!mouse || !held || (right == 0 && down == 0)) return;
    dragged_ = true;
    const double per_pixel = glm::radians(eye.fov_y_degrees) / std::max(height_, 1u);
    if (input.buttons[2] || input.alt) {
        const Box3d& around =
            state.chosen && culler_.boundsOf(*state.chosen).finite() ? culler_.boundsOf(*state.chosen) : bounds_;
        eye.orbit(around.center(), -3 * per_pixel * right, 3 * per_pixel * down);
    } else {
        eye.look(2 * per_pixel * right, -2 * per_pixel * down);
    }
}

void Viewer::pressed(const Input& input) {
    if (gui_.wantsKeys() || input.control) return;
    const auto now = [&](uint16_t key) { return pressedNow(input, last_, key); };
    if (now('F')) state.frozen = !state.frozen;
    if (now('C')) state.culled_as = static_cast<CulledAs>((static_cast<int>(state.culled_as) + 1) % 3);
    if (now('V')) state.colour_by = static_cast<ColourBy>((static_cast<int>(state.colour_by) + 1) % kColourings);
    if (now('X')) state.x_ray = !state.x_ray;
    if (now('I')) state.isolate = !state.isolate && state.chosen.has_value();
    if (now('H')) state.panels = !state.panels;
    if (now('P') && !state.recording) state.playing = !state.playing;
    if (now('R')) state.recording = !state.recording;
    if (now('Z') && state.chosen) lookAtChosen();
    if (now(kHome)) eye.frame(bounds_.center(), 0.5 * size_, aspect());
    if (now(kF12)) state.wants_picture = true;
    if (now(kEscape)) {
        if (state.chosen) choose(std::nullopt);
        else leave();
    } else if (!input.holds(kEscape) && (std::find(input.keys, input.keys + kKeys, true) != input.keys + kKeys ||
                                         input.buttons[0] || input.buttons[1] || input.buttons[2])) {
        may_end_ = false;
    }
}

/// Escape asks twice before the viewer ends.
void Viewer::leave() {
    state.wants_to_close = may_end_;
    may_end_ = true;
    if (!state.wants_to_close) state.said = "Esc once more ends";
}

/// Shows the panels, and does what they are asked for.
void Viewer::drawPanels() {
    const size_t left_out = state.culled_as == CulledAs::kBoxes ? boxes_left_out_ : ghosts_left_out_;
    const PanelFacts facts{scene_,
                           settings_.path,
                           path_frame_,
                           width_,
                           height_,
                           triangles_,
                           left_out,
                           size_,
                           eye.eye(),
                           eye.forward(),
                           settings_.cells.has_value(),
                           begun_,
                           settings_.times,
                           frame_milliseconds_,
                           query_microseconds_,
                           ways_.get(),
                           ways_problem_,
                           painter_.get(),
                           bsp_problem_,
                           clusters_ ? &*clusters_ : nullptr,
                           clusters_ ? clusters_->back(cullingView()) : 0};
    const PanelWishes wishes = sightline::viewer::drawPanels(facts, state, culler_, places_);
    if (wishes.go_to) goTo(*wishes.go_to);
    if (wishes.let_go) choose(std::nullopt);
    if (wishes.choose) choose(*wishes.choose);
    if (wishes.explain) explainChosen();
    if (wishes.look_at_chosen) lookAtChosen();
    if (wishes.save_path) {
        const std::string name = freeFileName(settings_.path_stem, ".json");
        const Status written = writeFileAside(name, cameraPathJson(settings_.path));
        state.said =
            written ? fmt::format("{} frames in {}", settings_.path.frames.size(), name) : written.error().message;
    }
    if (wishes.save_frame) saveFrame();
}

/// The last answer as a file; of a frozen camera what that one was told.
void Viewer::saveFrame() {
    const std::string name = freeFileName(settings_.frame_stem, ".frame");
    const Result<FrameRecording> recording = recordFrame(culler_.query());
    if (!recording) {
        state.said = recording.error().message;
        return;
    }
    const Array<char> bytes = recordingBytes(*recording);
    const Status written = writeFileAside(name, {bytes.data(), bytes.size()});
    state.said =
        written ? fmt::format("the frame is in {}: sightline replay {} --verify", name, name) : written.error().message;
}

void Viewer::lookAtChosen() {
    const Box3d& box = culler_.boundsOf(*state.chosen);
    if (box.finite()) eye.frame(box.center(), 0.6 * diagonalOf(box), aspect());
}

/// Records, or shows what is there. What was recorded takes the path's place when the recording ends.
void Viewer::playPath() {
    if (state.recording) state.playing = false;
    else if (!recorded_.frames.empty()) keepRecording();
    const bool works = state.recording || state.playing;
    if (works && !path_works_) {
        path_time_ = 0;
        if (state.playing && path_frame_ + 1 >= settings_.path.frames.size()) goTo(0);
    }
    path_works_ = works;
    if (!works) return;
    path_time_ += std::min(last_.seconds, 0.5);
    for (; path_time_ >= 1 / kPathFps; path_time_ -= 1 / kPathFps) {
        if (state.recording) {
            recorded_.frames.push_back(eye.cameraFrame());
        } else if (path_frame_ + 1 < settings_.path.frames.size()) {
            goTo(path_frame_ + 1);
        } else {
            state.playing = path_works_ = false;
            return;
        }
    }
}

void Viewer::keepRecording() {
    if (recorded_.frames.size() >= kLeastRecorded) {
        settings_.path = recorded_;
        path_frame_ = recorded_.frames.size() - 1;
        state.said = fmt::format("{} frames recorded", recorded_.frames.size());
    }
    recorded_.frames.clear();
}

bool Viewer::isShown(uint32_t object) const {
    if (!state.isolate || !state.chosen) return true;
    return object == *state.chosen || std::find(state.hiders.begin(), state.hiders.end(), object) != state.hiders.end();
}

void Viewer::drawObjects() {
    for (const uint32_t object : culler_.visible()) {
        if (!isShown(object)) continue;
        Paint paint;
        if (state.colour_by != ColourBy::kMaterials) paint.tinted = 1;
        if (state.colour_by == ColourBy::kObjects) {
            const uint64_t mixed = (scene_.objects[object].key + 1) * 0x9e3779b97f4a7c15ull;
            for (int i = 0; i < 3; ++i)
                paint.tint[i] = 0.25f + 0.6f * static_cast<float>(mixed >> (8 + 16 * i) & 0xff) / 255;
        } else if (state.colour_by == ColourBy::kAnswer) {
            paint.tint = kVisible;
        } else if (state.colour_by == ColourBy::kLevels) {
            paint.tint = levelColour(culler_.levelOf(object));
        }
        if (state.x_ray) paint.opacity = 0.25f;
        if (state.chosen == object) {
            paint.tint = kChosen;
            paint.tinted = 0.8f;
            paint.opacity = 1;
        } else if (std::find(state.hiders.begin(), state.hiders.end(), object) != state.hiders.end()) {
            paint.tint = kHider;
            paint.tinted = 0.8f;
        }
        drawer_->draw(object, paint, culler_.levelOf(object), culler_.rangesOf(object));
    }
}

/// Asks all ways about the culling camera's view.
void Viewer::askWays() {
    ways_problem_.clear();
    const View view = cullingView();
    if (view.sections.count > 0) {
        ways_problem_ = "not with a section";
        return;
    }
    if (!ways_) {
        Result<std::unique_ptr<SideBySide>> made = SideBySide::create(culler_);
        if (made) ways_ = std::move(*made);
        else ways_problem_ = made.error().message;
    }
    if (!ways_) return;
    if (const Status asked = ways_->ask(view); !asked) ways_problem_ = asked.error().message;
}

/// @returns false if there is no tree to paint by
bool Viewer::paintBsp(const View& view, const GlView& gl_view) {
    if (!painter_ && bsp_problem_.empty()) {
        Result<std::unique_ptr<BspPainter>> made = BspPainter::create(scene_);
        if (made) painter_ = std::move(*made);
        else bsp_problem_ = made.error().message;
    }
    state.bsp = painter_ != nullptr;
    if (!painter_) return false;
    painter_->draw(view, gl_view, static_cast<double>(state.bsp_part));
    return true;
}

/// Whether an object that was culled is shown as what it is.
bool Viewer::isCulled(uint32_t object) {
    const uint8_t reason = culler_.reasons()[object];
    return reason != 0 && reason <= kStageCount && isShown(object);
}

/// What was culled and is drawn as a ghost.
void Viewer::listGhosts() {
    ghosts_.clear();
    ghosts_left_out_ = 0;
    if ((!state.frozen && !state.x_ray) || state.culled_as != CulledAs::kGhosts) return;
    for (uint32_t object = 0; object < scene_.objects.size(); ++object) {
        if (!isCulled(object) || state.chosen == object) continue;
        if (ghosts_.size() < kMostGhosts) ghosts_.push_back(object);
        else ++ghosts_left_out_;
    }
}

/// What was culled: while the culling camera is left, or as one sees through walls.
void Viewer::drawCulled(const GlView& view) {
    const std::span<const uint8_t> reasons = culler_.reasons();
    if (state.chosen && reasons[*state.chosen] != 0) drawer_->draw(*state.chosen, {kChosen, 0.8f, 0.6f});
    if (state.casters)
        for (const uint32_t object : culler_.casters(kSun))
            if (isCulled(object)) drawer_->draw(object, {kCaster, 1.0f, 0.35f});
    for (const uint32_t object : ghosts_) drawer_->draw(object, {stageColour(reasons[object] - 1), 1.0f, 0.18f});
    if ((!state.frozen && !state.x_ray) || state.culled_as != CulledAs::kBoxes) return;
    if (culled_boxes_stale_) {
        culled_lines_->clear();
        boxes_left_out_ = 0;
        for (uint32_t object = 0; object < reasons.size(); ++object) {
            if (reasons[object] == 0 || reasons[object] > kStageCount || !culler_.boundsOf(object).finite()) continue;
            if (culled_lines_->count() >= 12 * kMostBoxes) ++boxes_left_out_;
            else culled_lines_->box(culler_.boundsOf(object), stageColour(reasons[object] - 1));
        }
        culled_boxes_stale_ = false;
    }
    if (!state.isolate) culled_lines_->draw(view, 0.12f);
}

void Viewer::choose(std::optional<uint32_t> object) {
    state.chosen = object;
    state.why.clear();
    state.hiders.clear();
    state.outlines.clear();
    if (!object) state.isolate = false;
    else explainChosen();
}

void Viewer::explainChosen() {
    ObjectWhy why = culler_.why(*state.chosen);
    state.why = std::move(why.text);
    state.why_is_old = false;
    state.hiders = std::move(why.hiders);
    state.outlines = std::move(why.outlines);
}

/// The nearest of some objects at a pixel, without those that clicks chose there before.
std::optional<uint32_t> Viewer::nearestAt(std::span<const uint32_t> objects, int32_t column, int32_t row) {
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    for (const uint32_t object : objects)
        if (std::find(picked_.begin(), picked_.end(), object) == picked_.end())
            drawer_->drawNumber(object, culler_.levelOf(object), culler_.rangesOf(object));
    uint8_t bytes[4] = {};
    glReadPixels(column, row, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, bytes);
    const uint32_t number = bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<uint32_t>(bytes[3]) << 24;
    return number == 0 ? std::nullopt : std::optional(number - 1);
}

/// Chooses what is at a pixel: of what is solid the nearest, then of what is faint; through x-ray the other way round. Further
/// clicks at that place choose what is behind.
Status Viewer::pick(const View& view, float x, float y) {
    if (Status ready = pick_image_.resize(width_, height_, false); !ready) return ready;
    pick_image_.begin();
    glDepthMask(GL_TRUE);
    setDepth(true);
    glClearColor(0, 0, 0, 0);
    drawer_->beginNumbers(glViewOf(view), view.sections.all());
    const auto column = static_cast<GLint>(x), row = static_cast<GLint>(height_) - 1 - static_cast<GLint>(y);
    glEnable(GL_SCISSOR_TEST);
    glScissor(column, row, 1, 1);
    std::vector<uint32_t> solid, faint(ghosts_);
    for (const uint32_t object : culler_.visible())
        if (isShown(object)) solid.push_back(object);
    if (state.casters)
        for (const uint32_t object : culler_.casters(kSun))
            if (isCulled(object)) faint.push_back(object);
    if (state.chosen && culler_.reasons()[*state.chosen] != 0) faint.push_back(*state.chosen);
    if (state.x_ray) std::swap(solid, faint);
    if (picked_from_ != view.view || glm::distance(picked_at_, glm::vec2(x, y)) > 3) picked_.clear();
    picked_from_ = view.view;
    picked_at_ = {x, y};
    std::optional<uint32_t> found;
    for (bool again = true; again;) {
        found = nearestAt(solid, column, row);
        if (!found) found = nearestAt(faint, column, row);
        again = !found && !picked_.empty();  // behind the last one the first is chosen again
        if (again) picked_.clear();
    }
    glDisable(GL_SCISSOR_TEST);
    if (found) picked_.push_back(*found);
    choose(found);
    return checkGl("choosing an object");
}

Status Viewer::frame(const Input& input, uint32_t width, uint32_t height) {
    width_ = width;
    height_ = height;
    if (Status ready = image_.resize(width, height, true); !ready) return ready;
    places_.clear();
    gui_.begin(input, width, height, settings_.scale);
    if (state.panels) drawPanels();
    pressed(input);
    steer(input);
    const bool released = last_.buttons[0] && !input.buttons[0];
    if (input.buttons[0] && !last_.buttons[0]) pressed_in_world_ = !gui_.wantsMouse();
    const bool click = released && pressed_in_world_ && !dragged_ && !gui_.wantsMouse();
    if (!input.buttons[0] && !input.buttons[1] && !input.buttons[2]) dragged_ = false;
    rests_ = sameInput(input, last_) && !state.playing && !state.recording;
    last_ = input;
    playPath();
    if (!state.frozen) {
        culling = eye;
        culling_sections_ = sections();
    }

    answer_changed_ = culler_.ask(cullingView());
    culled_boxes_stale_ = culled_boxes_stale_ || answer_changed_;
    if (answer_changed_ || !state.ways) ways_asked_ = 0;
    if (state.ways && ways_asked_ < kAskedOfAll) {
        askWays();
        ++ways_asked_;
    }
    if (state.bsp && state.bsp_plays) {
        state.bsp_part += static_cast<float>(std::min(input.seconds, 0.1) / kPaintSeconds);
        state.bsp_plays = state.bsp_part < 1;
        state.bsp_part = std::min(state.bsp_part, 1.0f);
    }
    if (!state.chosen || !state.clusters) clusters_.reset();
    rests_ = rests_ && !answer_changed_ && !(state.ways && ways_asked_ < kAskedOfAll) && !state.bsp_plays;
    // While the camera moves what is said of the chosen object is of an earlier view; when it rests it is asked again.
    if (state.chosen && (state.why.empty() || (state.why_is_old && !answer_changed_))) explainChosen();
    state.why_is_old = state.why_is_old || answer_changed_;
    const View view = viewOf(eye, sections());
    const GlView gl_view = glViewOf(view);
    image_.begin();
    setDepth(true);
    glClearColor(kBackground.r, kBackground.g, kBackground.b, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    drawer_->begin(gl_view, view.sections.all());
    if (state.bsp && paintBsp(view, gl_view)) {
        triangles_ = painter_->triangles();
    } else {
        drawObjects();
        triangles_ = drawer_->triangles();
    }
    listGhosts();
    if (state.frozen || state.x_ray || state.casters || state.chosen) drawCulled(gl_view);
    drawLines(gl_view);
    image_.resolve();
    gui_.draw();
    if (click)
        if (Status done = pick(view, input.mouse_x, input.mouse_y); !done) return done;

    const auto keep = [](std::vector<float>& times, double value) {
        if (times.size() >= kTimes) times.erase(times.begin());
        times.push_back(static_cast<float>(value));
    };
    keep(frame_milliseconds_, 1e3 * input.seconds);
    keep(query_microseconds_, answer_changed_ ? 1e-3 * static_cast<double>(culler_.stats().nanoseconds) : 0.0);
    return checkGl("drawing a frame");
}

}  // namespace sightline::viewer
