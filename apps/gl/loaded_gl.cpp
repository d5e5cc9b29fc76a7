// Mesa's software GL as a subject: more pixels, more vertices, more bytes or more calls, and no more of the rest.
// SPDX-License-Identifier: MIT
#include "apps/gl/loaded_gl.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include "apps/gl/gl_view.h"
#include "apps/gl/meshes.h"
#include "apps/gl/objects.h"

namespace sightline {
using namespace studies;
using namespace tools;
namespace {

constexpr GLuint kOneForAll = 1u << 30;  // instances that one element of an attribute is for
constexpr double kLargestImage = 8192;   // [pixels]

// Instances behind the first lie outside of the view, and are computed all the same.
constexpr const char* kLoadedVertexShader = R"(#version 450 core
layout(location = 0) in vec3 position;
layout(location = 1) in mat4 to_clip;
void main() {
    vec4 place = to_clip * vec4(position, 1.0);
    gl_Position = gl_InstanceID == 0 ? place : vec4(2.0 + 1e-30 * place.x, 2.0, 2.0, 1.0);
}
)";

constexpr const char* kLoadedFragmentShader = R"(#version 450 core
layout(location = 0) out vec4 shown;
void main() { shown = vec4(fract(64.0 * gl_FragCoord.z), 0.5, 0.25, 1.0); }
)";

uint32_t wholeTimes(double factor) { return static_cast<uint32_t>(std::max(1.0, std::round(factor))); }

View loadedView(View view, double fill) {
    const auto side = [&](uint32_t pixels) {
        return static_cast<uint32_t>(std::clamp(std::round(pixels * std::sqrt(fill)), 1.0, kLargestImage));
    };
    view.width = side(view.width);
    view.height = side(view.height);
    return view;
}

struct LoadedMesh : GlMesh {
    uint32_t vertices = 0;
};

GlName makeDynamicBuffer() {
    GLuint name = 0;
    glCreateBuffers(1, &name);
    return {name, [](uint32_t old) { glDeleteBuffers(1, &old); }};
}

/// A query of the GL that may not be there.
class GlCounter {
public:
    explicit GlCounter(GLenum target, bool there = true) : target_(target) {
        if (!there) return;
        GLuint name = 0;
        glGenQueries(1, &name);  // Mesa's glCreateQueries() refuses the targets of pipeline statistics
        query_ = {name, [](uint32_t old) { glDeleteQueries(1, &old); }};
    }
    void begin() {
        if (query_.get() == 0) return;
        glBeginQuery(target_, query_.get());
        begun_ = true;
    }
    void end() const {
        if (begun_) glEndQuery(target_);
    }
    /// Waits for it.
    std::optional<uint64_t> value() const {
        if (!begun_) return std::nullopt;
        GLuint64 value = 0;
        glGetQueryObjectui64v(query_.get(), GL_QUERY_RESULT, &value);
        return value;
    }

private:
    GLenum target_;
    GlName query_;
    bool begun_ = false;
};

}  // namespace

struct LoadedGl::State {
    State(const GlContext& in, const LoadedGlSettings& with) : context(in), settings(with) {}
    ~State() { context.makeCurrent(); }

    const GlContext& context;
    LoadedGlSettings settings;
    GlName vertices, indices, transforms, scratch, array, program;
    std::map<std::pair<uint32_t, uint32_t>, GlTarget> targets;  ///< by size
    std::vector<glm::vec3> positions;                           ///< of all meshes, to be uploaded again
    std::vector<LoadedMesh> meshes;
    std::unordered_map<uint32_t, uint32_t> mesh_of;  ///< by DrawItem::id
    uint32_t degenerate = 0;                         ///< index of a triangle that is a point
    std::vector<glm::mat4> to_clip;
    std::vector<uint32_t> drawn;  ///< per item of the frame: its mesh
    std::vector<uint8_t> clockwise;
    size_t transforms_size = 0, scratch_size = 0;
    uint64_t bytes = 0;
    std::optional<GlCounter> elapsed;
    Status status = success();

    void upload(std::span<const DrawItem> items);
    void prepare(std::span<const DrawItem> items, const GlView& view);
    void carry(double times);
    GlTarget* targetOf(const View& view);
    void begin(const GlTarget& target) const;
    void submitAll(uint32_t instances, bool of_points) const;
    /// @param counters  of the draw calls alone
    void drawFrame(const View& view, const SubmitFrame& submit, const StageLoads& loads,
                   std::span<GlCounter* const> counters = {});
    void keep(const Status& done) {
        if (status && !done) status = done;
    }
};

void LoadedGl::State::upload(std::span<const DrawItem> items) {
    std::vector<uint32_t> all;
    GlMeshNumbers known;
    for (const DrawItem& item : items) {
        const uint32_t number = known.of(item);
        mesh_of.emplace(item.id, number);
        if (number < meshes.size()) continue;
        meshes.push_back({appendGlMesh(item, positions, all), static_cast<uint32_t>(item.mesh.positions.size())});
    }
    degenerate = static_cast<uint32_t>(all.size());
    all.insert(all.end(), {0, 0, 0});
    if (positions.empty()) positions.emplace_back(0.0f);
    vertices = makeDynamicBuffer();
    glNamedBufferData(vertices.get(), static_cast<GLsizeiptr>(positions.size() * sizeof(glm::vec3)), positions.data(),
                      settings.stream ? GL_STREAM_DRAW : GL_STATIC_DRAW);
    indices = makeGlBuffer(std::as_bytes(std::span(all)));
    transforms = makeDynamicBuffer();
    scratch = makeDynamicBuffer();
    array = makeGlVertexArray();
    glVertexArrayElementBuffer(array.get(), indices.get());
    glVertexArrayVertexBuffer(array.get(), 0, vertices.get(), 0, sizeof(glm::vec3));
    glEnableVertexArrayAttrib(array.get(), 0);
    glVertexArrayAttribFormat(array.get(), 0, 3, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(array.get(), 0, 0);
    for (GLuint column = 0; column < 4; ++column) {
        glEnableVertexArrayAttrib(array.get(), 1 + column);
        glVertexArrayAttribFormat(array.get(), 1 + column, 4, GL_FLOAT, GL_FALSE,
                                  column * static_cast<GLuint>(sizeof(glm::vec4)));
        glVertexArrayAttribBinding(array.get(), 1 + column, 1);
    }
    glVertexArrayBindingDivisor(array.get(), 1, kOneForAll);
}

void LoadedGl::State::prepare(std::span<const DrawItem> items, const GlView& view) {
    to_clip.clear();
    drawn.clear();
    clockwise.clear();
    for (const DrawItem& item : items) {
        const auto mesh = mesh_of.find(item.id);
        if (mesh == mesh_of.end()) continue;
        to_clip.emplace_back(view.objectToClip(meshes[mesh->second].placed(item.transform)));
        drawn.push_back(mesh->second);
        clockwise.push_back(view.frontIsClockwise(item.transform));
    }
}

void LoadedGl::State::carry(double times) {
    const size_t needed = to_clip.size() * sizeof(glm::mat4);
    if (needed == 0) return;
    if (transforms_size < needed) {
        transforms_size = 2 * needed;
        glNamedBufferData(transforms.get(), static_cast<GLsizeiptr>(transforms_size), nullptr, GL_STREAM_DRAW);
        glVertexArrayVertexBuffer(array.get(), 1, transforms.get(), 0, sizeof(glm::mat4));
    }
    size_t largest = needed;
    for (const uint32_t mesh : drawn)
        if (settings.stream) largest = std::max(largest, meshes[mesh].vertices * sizeof(glm::vec3));
    if (scratch_size < largest) {
        scratch_size = largest;
        glNamedBufferData(scratch.get(), static_cast<GLsizeiptr>(scratch_size), nullptr, GL_STREAM_DRAW);
    }
    uint64_t once = needed;
    for (const uint32_t mesh : drawn)
        if (settings.stream) once += meshes[mesh].vertices * sizeof(glm::vec3);
    const auto wanted = static_cast<uint64_t>(std::max(times, 1.0) * static_cast<double>(once));
    bytes = 0;
    // The first pass goes where it is used, all others to where nobody looks.
    const auto put = [&](GLuint buffer, size_t offset, const void* from, size_t count) {
        const bool first = bytes < once;
        count = static_cast<size_t>(std::min<uint64_t>(count, wanted - bytes));
        if (count == 0) return;
        glNamedBufferSubData(first ? buffer : scratch.get(), static_cast<GLintptr>(first ? offset : 0),
                             static_cast<GLsizeiptr>(count), from);
        bytes += count;
    };
    while (bytes < wanted) {
        put(transforms.get(), 0, to_clip.data(), needed);
        if (!settings.stream) continue;
        for (const uint32_t mesh : drawn)
            put(vertices.get(), meshes[mesh].base_vertex * sizeof(glm::vec3), &positions[meshes[mesh].base_vertex],
                meshes[mesh].vertices * sizeof(glm::vec3));
    }
}

GlTarget* LoadedGl::State::targetOf(const View& view) {
    const std::pair<uint32_t, uint32_t> size{view.width, view.height};
    if (const auto found = targets.find(size); found != targets.end()) return &found->second;
    Result<GlTarget> made = GlTarget::create(GL_RGBA8, view.width, view.height);
    if (!made) {
        keep(made.error());
        return nullptr;
    }
    return &targets.emplace(size, std::move(*made)).first->second;
}

void LoadedGl::State::begin(const GlTarget& target) const {
    const GLfloat nowhere = 0.0f, black[4] = {0, 0, 0, 0};
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.get());
    glViewport(0, 0, static_cast<GLsizei>(target.width), static_cast<GLsizei>(target.height));
    glDepthMask(GL_TRUE);
    glClearBufferfv(GL_DEPTH, 0, &nowhere);
    glClearBufferfv(GL_COLOR, 0, black);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glCullFace(GL_BACK);
    glUseProgram(program.get());
    glBindVertexArray(array.get());
}

void LoadedGl::State::submitAll(uint32_t instances, bool of_points) const {
    const GlRange point{degenerate, 3};
    for (size_t i = 0; i < drawn.size(); ++i) {
        const LoadedMesh& mesh = meshes[drawn[i]];
        glFrontFace(clockwise[i] ? GL_CW : GL_CCW);
        for (const bool both : {false, true}) {
            const GlRange& range = both ? mesh.double_sided : mesh.single;
            if (range.count == 0) continue;
            if (both) glDisable(GL_CULL_FACE);
            else glEnable(GL_CULL_FACE);
            const GlRange& taken = of_points ? point : range;
            glDrawElementsInstancedBaseVertexBaseInstance(
                GL_TRIANGLES, static_cast<GLsizei>(taken.count), GL_UNSIGNED_INT,
                reinterpret_cast<const void*>(size_t{taken.first} * sizeof(uint32_t)), static_cast<GLsizei>(instances),
                static_cast<GLint>(mesh.base_vertex), static_cast<GLuint>(i));
        }
    }
}

void LoadedGl::State::drawFrame(const View& view, const SubmitFrame& submit, const StageLoads& loads,
                                std::span<GlCounter* const> counters) {
    const View loaded = loadedView(view, loads.fill);
    GlTarget* const target = targetOf(loaded);
    if (target == nullptr) return;
    std::span<const DrawItem> items;
    for (uint32_t i = 0; i < wholeTimes(loads.cpu); ++i) {
        items = submit();
        prepare(items, makeGlView(view, items));
    }
    carry(loads.bus);
    begin(*target);
    // Not before: llvmpipe counts no samples of a query that began without a framebuffer.
    for (GlCounter* counter : counters) counter->begin();
    for (uint32_t i = 1; i < wholeTimes(loads.cpu); ++i) submitAll(1, true);
    submitAll(wholeTimes(loads.transform), false);
    for (const GlCounter* counter : counters) counter->end();
}

LoadedGl::LoadedGl(std::unique_ptr<State> state) : state_(std::move(state)) {}
LoadedGl::LoadedGl(LoadedGl&&) noexcept = default;
LoadedGl& LoadedGl::operator=(LoadedGl&&) noexcept = default;
LoadedGl::~LoadedGl() = default;

Result<LoadedGl> LoadedGl::create(const GlContext& context, std::span<const DrawItem> items,
                                  const LoadedGlSettings& settings) {
    context.makeCurrent();
    auto state = std::make_unique<State>(context, settings);
    Result<GlName> program = makeGlProgram(kLoadedVertexShader, kLoadedFragmentShader);
    if (!program) return program.error();
    state->program = std::move(*program);
    state->upload(items);
    state->elapsed.emplace(GL_TIME_ELAPSED);
    if (const Status done = checkGl("uploading meshes"); !done) return done.error();
    return LoadedGl(std::move(state));
}

FrameTimes LoadedGl::draw(const View& view, const SubmitFrame& submit, const StageLoads& loads) {
    State& state = *state_;
    state.context.makeCurrent();
    state.bytes = 0;
    const FrameClock clock;
    state.elapsed->begin();
    state.drawFrame(view, submit, loads);
    state.elapsed->end();
    glFinish();
    FrameTimes times = clock.times();
    state.keep(checkGl("drawing"));
    // A software driver counts the caller's own work between both ends as its own, and may begin before or end after.
    times.gpu = std::min(1e-9 * static_cast<double>(state.elapsed->value().value_or(0)), times.wall);
    return times;
}

GlStatistics LoadedGl::count(const View& view, const SubmitFrame& submit, const StageLoads& loads) {
    State& state = *state_;
    state.context.makeCurrent();
    const bool there = epoxy_has_gl_extension("GL_ARB_pipeline_statistics_query") || epoxy_gl_version() >= 46;
    GlCounter vertices(GL_VERTEX_SHADER_INVOCATIONS_ARB, there), triangles(GL_CLIPPING_INPUT_PRIMITIVES_ARB, there),
        fragments(GL_FRAGMENT_SHADER_INVOCATIONS_ARB, there), samples(GL_SAMPLES_PASSED);
    GlCounter* const all[] = {&vertices, &triangles, &fragments, &samples};
    state.drawFrame(view, submit, loads, all);
    glFinish();
    state.keep(checkGl("counting"));
    return {vertices.value(), triangles.value(), fragments.value(), samples.value().value_or(0)};
}

uint64_t LoadedGl::bytes() const { return state_->bytes; }

Status LoadedGl::status() const { return state_->status; }

}  // namespace sightline
