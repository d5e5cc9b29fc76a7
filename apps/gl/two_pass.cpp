// Culling on the GPU in two passes: what was visible is drawn first, and its depths, as a pyramid, decide about the rest.
// SPDX-License-Identifier: MIT
//
// Ulrich Haar, Sebastian Aaltonen. GPU-Driven Rendering Pipelines. 2015.
// Ned Greene, Michael Kass, Gavin Miller. Hierarchical Z-Buffer Visibility. 1993.
#include "apps/gl/two_pass.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>

#include "apps/gl/gl_view.h"
#include "apps/gl/meshes.h"
#include "apps/gl/two_pass_shaders.h"

namespace sightline {
using namespace studies;
namespace {

/// As the shaders have them.
struct PassItem {
    glm::vec4 columns[3];
    glm::vec4 high, low;
};
struct PassPart {
    glm::vec3 center;
    uint32_t item = 0;
    glm::vec4 half_size;
};
struct PassCommand {
    uint32_t count = 0, instances = 1, first = 0, base_vertex = 0, base_instance = 0;
};

/// Parts that are drawn with the same state.
enum class Faces : uint8_t { kCounterClockwise, kClockwise, kBoth };
constexpr size_t kFaces = 3;
constexpr size_t kMostParts = 64 * 65535 / 2;  // each may have two commands

enum Binding : GLuint { kItems, kParts, kCommands, kSeen, kEarly, kLate, kBindings };

GlName makeBuffer(size_t bytes, const void* data) {
    GLuint name = 0;
    glCreateBuffers(1, &name);
    const uint32_t nothing[4] = {};
    glNamedBufferStorage(name, static_cast<GLsizeiptr>(std::max(bytes, sizeof nothing)), bytes == 0 ? nothing : data,
                         GL_DYNAMIC_STORAGE_BIT);
    return {name, [](uint32_t old) { glDeleteBuffers(1, &old); }};
}

template <class T>
GlName makeBuffer(const std::vector<T>& data) {
    return makeBuffer(data.size() * sizeof(T), data.data());
}

GlName makeTexture(GLenum format, GLsizei levels, uint32_t width, uint32_t height) {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    glTextureStorage2D(name, levels, format, static_cast<GLsizei>(width), static_cast<GLsizei>(height));
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return {name, [](uint32_t old) { glDeleteTextures(1, &old); }};
}

PassItem passItemOf(const DrawItem& item) {
    PassItem made;
    for (int i = 0; i < 3; ++i) made.columns[i] = glm::vec4(glm::vec3(item.transform[i]), 0.0f);
    const glm::dvec3 place(item.transform[3]);
    made.high = glm::vec4(glm::vec3(place), 0.0f);
    made.low = glm::vec4(glm::vec3(place - glm::dvec3(made.high)), 0.0f);
    return made;
}

bool mirrors(const DrawItem& item) { return glm::determinant(glm::dmat3(item.transform)) < 0; }

}  // namespace

std::vector<GlCullPart> makeCullParts(std::span<const DrawItem> items, uint32_t most_triangles) {
    std::vector<GlCullPart> parts;
    for (uint32_t item = 0; item < items.size(); ++item) {
        const auto all = static_cast<uint32_t>(items[item].mesh.triangles());
        const uint32_t most = most_triangles == 0 ? std::max(all, 1u) : most_triangles;
        for (uint32_t first = 0; first < all; first += most)
            parts.push_back({item, first, std::min(most, all - first)});
    }
    return parts;
}

struct GlTwoPass::State {
    State(const GlContext& in, std::span<const DrawItem> of) : context(in), items(of) {}
    ~State() { context.makeCurrent(); }

    const GlContext& context;
    std::span<const DrawItem> items;
    std::vector<uint32_t> part_of;  ///< per command: which of the caller's parts; a part may have two
    size_t part_count = 0;
    size_t first_of[kFaces + 1] = {};  ///< commands by their state
    GlName vertices, indices, numbers, array;
    std::array<GlName, kBindings> buffers;
    GlName draw_program, cull_program, reduce_program;
    uint32_t width = 0, height = 0;
    GLsizei levels = 0;
    GlName colour, depth, pyramid, framebuffer;

    Status compile();
    void upload(std::span<const GlCullPart> parts);
    Status resize(const View& view);
    void clear() const;
    void setView(const GlView& view) const;
    void cull(const GlView& view, bool late) const;
    void drawParts(const GlView& view) const;
    void reduce() const;
    void setSeen(uint32_t value) const;
    std::vector<uint32_t> read(Binding buffer) const;
    Result<std::vector<uint32_t>> readPixels(GLenum format, GLenum type) const;
};

Status GlTwoPass::State::compile() {
    Result<GlName> draws = makeGlProgram(std::string(kTwoPassCommon) + kTwoPassVertex, kTwoPassFragment);
    if (!draws) return draws.error();
    Result<GlName> culls = makeGlComputeProgram(std::string(kTwoPassCommon) + kTwoPassCull);
    if (!culls) return culls.error();
    Result<GlName> reduces = makeGlComputeProgram(kTwoPassReduce);
    if (!reduces) return reduces.error();
    draw_program = std::move(*draws);
    cull_program = std::move(*culls);
    reduce_program = std::move(*reduces);
    return success();
}

void GlTwoPass::State::upload(std::span<const GlCullPart> parts) {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> all_indices, base_of, numbers_of_items;
    GlMeshNumbers known;
    std::vector<PassItem> pass_items;
    for (uint32_t item = 0; item < items.size(); ++item) {
        const DrawItem& of = items[item];
        if (known.of(of) == base_of.size()) {
            base_of.push_back(static_cast<uint32_t>(positions.size()));
            positions.insert(positions.end(), of.mesh.positions.begin(), of.mesh.positions.end());
        }
        pass_items.push_back(passItemOf(of));
        numbers_of_items.push_back(item);
    }
    struct Made {
        PassPart part;
        PassCommand command;
        uint32_t number = 0;
    };
    std::array<std::vector<Made>, kFaces> by_faces;
    for (uint32_t number = 0; number < parts.size(); ++number) {
        const GlCullPart& part = parts[number];
        const DrawItem& of = items[part.item];
        for (const bool both : {false, true}) {
            Made made;
            made.number = number;
            made.command.first = static_cast<uint32_t>(all_indices.size());
            made.command.base_vertex = base_of[known.of(of)];
            made.command.base_instance = part.item;
            Box3f box;
            for (size_t t = part.first_triangle; t < size_t{part.first_triangle} + part.triangle_count; ++t) {
                if (!of.writes_depth.empty() && of.writes_depth[t] == 0) continue;
                if ((!of.double_sided.empty() && of.double_sided[t] != 0) != both) continue;
                for (size_t corner = 3 * t; corner < 3 * t + 3; ++corner) {
                    all_indices.push_back(of.mesh.indices[corner]);
                    box.grow(of.mesh.positions[of.mesh.indices[corner]]);
                }
            }
            made.command.count = static_cast<uint32_t>(all_indices.size()) - made.command.first;
            if (made.command.count == 0) continue;
            made.part.center = box.center();
            made.part.item = part.item;
            // From the rounded middle to the farther side: no point of the box is outside of it.
            made.part.half_size =
                glm::vec4(glm::max(box.max - made.part.center, made.part.center - box.min) * 1.000001f, 0);
            const Faces faces = both ? Faces::kBoth : mirrors(of) ? Faces::kClockwise : Faces::kCounterClockwise;
            by_faces[static_cast<size_t>(faces)].push_back(made);
        }
    }
    part_count = parts.size();
    std::vector<PassPart> pass_parts;
    std::vector<PassCommand> commands;
    for (size_t faces = 0; faces < kFaces; ++faces) {
        first_of[faces] = commands.size();
        for (const Made& made : by_faces[faces]) {
            pass_parts.push_back(made.part);
            commands.push_back(made.command);
            part_of.push_back(made.number);
        }
    }
    first_of[kFaces] = commands.size();
    const std::vector<uint32_t> none(commands.size(), 0);
    buffers[kItems] = makeBuffer(pass_items);
    buffers[kParts] = makeBuffer(pass_parts);
    buffers[kCommands] = makeBuffer(commands);
    buffers[kSeen] = makeBuffer(none);
    buffers[kEarly] = makeBuffer(none);
    buffers[kLate] = makeBuffer(none);
    vertices = makeBuffer(positions);
    indices = makeBuffer(all_indices);
    numbers = makeBuffer(numbers_of_items);
    array = makeGlVertexArray();
    glVertexArrayElementBuffer(array.get(), indices.get());
    glVertexArrayVertexBuffer(array.get(), 0, vertices.get(), 0, sizeof(glm::vec3));
    glVertexArrayVertexBuffer(array.get(), 1, numbers.get(), 0, sizeof(uint32_t));
    for (const GLuint attribute : {0u, 1u}) {
        glEnableVertexArrayAttrib(array.get(), attribute);
        glVertexArrayAttribBinding(array.get(), attribute, attribute);
    }
    glVertexArrayAttribFormat(array.get(), 0, 3, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribIFormat(array.get(), 1, 1, GL_UNSIGNED_INT, 0);
    glVertexArrayBindingDivisor(array.get(), 1, 1);
}

Status GlTwoPass::State::resize(const View& view) {
    if (width == view.width && height == view.height) return success();
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    if (view.width > static_cast<uint32_t>(most) || view.height > static_cast<uint32_t>(most))
        return Error{Error::Kind::kInput, "OpenGL: an image of " + std::to_string(view.width) + "x" +
                                              std::to_string(view.height) + " is too large"};
    width = height = 0;  // nothing is here if the rest fails
    colour = makeTexture(GL_R32UI, 1, view.width, view.height);
    depth = makeTexture(GL_DEPTH_COMPONENT32F, 1, view.width, view.height);
    // A level is half of the one before, to the texel: so that no texel of an image of odd size is left out.
    const uint32_t half_width = std::bit_ceil((view.width + 1) / 2), half_height = std::bit_ceil((view.height + 1) / 2);
    levels = static_cast<GLsizei>(std::bit_width(std::max(half_width, half_height)));
    pyramid = makeTexture(GL_R32F, levels, half_width, half_height);
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    framebuffer = {name, [](uint32_t old) { glDeleteFramebuffers(1, &old); }};
    glNamedFramebufferTexture(name, GL_COLOR_ATTACHMENT0, colour.get(), 0);
    glNamedFramebufferTexture(name, GL_DEPTH_ATTACHMENT, depth.get(), 0);
    if (const Status made = checkGl("making an image"); !made) return made;
    if (glCheckNamedFramebufferStatus(name, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return Error{Error::Kind::kInput, "OpenGL: the image to draw into is not complete"};
    width = view.width;
    height = view.height;
    return success();
}

void GlTwoPass::State::clear() const {
    const GLfloat nowhere = 0.0f;
    const GLuint none[4] = {kNone, 0, 0, 0};
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.get());
    glViewport(0, 0, static_cast<GLsizei>(width), static_cast<GLsizei>(height));
    glDepthMask(GL_TRUE);
    glClearBufferfv(GL_DEPTH, 0, &nowhere);
    glClearBufferuiv(GL_COLOR, 0, none);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glCullFace(GL_BACK);
    glBindVertexArray(array.get());
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, buffers[kCommands].get());
    for (GLuint binding = 0; binding < kBindings; ++binding)
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffers[binding].get());
}

void GlTwoPass::State::setView(const GlView& view) const {
    const glm::mat4 to_clip(view.to_clip * glm::dmat4(view.rotation));
    const glm::vec3 high(view.eye), low(view.eye - glm::dvec3(high));
    glUniformMatrix4fv(0, 1, GL_FALSE, &to_clip[0][0]);
    glUniform3fv(4, 1, &high[0]);
    glUniform3fv(5, 1, &low[0]);
}

void GlTwoPass::State::cull(const GlView& view, bool late) const {
    glUseProgram(cull_program.get());
    setView(view);
    glUniform1ui(6, static_cast<GLuint>(part_of.size()));
    glUniform1ui(7, late ? 1 : 0);
    glUniform2i(8, static_cast<GLint>(width), static_cast<GLint>(height));
    glBindTextureUnit(0, depth.get());
    glBindTextureUnit(1, pyramid.get());
    glDispatchCompute((static_cast<GLuint>(part_of.size()) + 63) / 64, 1, 1);
    glMemoryBarrier(GL_COMMAND_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

void GlTwoPass::State::drawParts(const GlView& view) const {
    glUseProgram(draw_program.get());
    setView(view);
    for (size_t faces = 0; faces < kFaces; ++faces) {
        const size_t count = first_of[faces + 1] - first_of[faces];
        if (count == 0) continue;
        if (faces == static_cast<size_t>(Faces::kBoth)) glDisable(GL_CULL_FACE);
        else glEnable(GL_CULL_FACE);
        glFrontFace((faces == static_cast<size_t>(Faces::kClockwise)) != view.mirrored ? GL_CW : GL_CCW);
        glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT,
                                    reinterpret_cast<const void*>(first_of[faces] * sizeof(PassCommand)),
                                    static_cast<GLsizei>(count), sizeof(PassCommand));
    }
}

void GlTwoPass::State::reduce() const {
    glUseProgram(reduce_program.get());
    glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
    uint32_t from_width = width, from_height = height;
    uint32_t to_width = std::bit_ceil((width + 1) / 2), to_height = std::bit_ceil((height + 1) / 2);
    for (GLsizei level = 0; level < levels; ++level) {
        glBindTextureUnit(0, level == 0 ? depth.get() : pyramid.get());
        glBindImageTexture(0, pyramid.get(), level, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32F);
        glUniform1i(0, level == 0 ? 0 : level - 1);
        glUniform2i(1, static_cast<GLint>(from_width), static_cast<GLint>(from_height));
        glDispatchCompute((to_width + 7) / 8, (to_height + 7) / 8, 1);
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
        from_width = to_width;
        from_height = to_height;
        to_width = std::max(to_width / 2, 1u);
        to_height = std::max(to_height / 2, 1u);
    }
}

void GlTwoPass::State::setSeen(uint32_t value) const {
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    glClearNamedBufferData(buffers[kSeen].get(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &value);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

/// Per part of the caller's.
std::vector<uint32_t> GlTwoPass::State::read(Binding buffer) const {
    std::vector<uint32_t> by_command(part_of.size()), by_part(part_count, 0);
    if (!by_command.empty()) {
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        glGetNamedBufferSubData(buffers[buffer].get(), 0, static_cast<GLsizeiptr>(by_command.size() * sizeof(uint32_t)),
                                by_command.data());
    }
    for (size_t i = 0; i < by_command.size(); ++i) by_part[part_of[i]] |= by_command[i];
    return by_part;
}

Result<std::vector<uint32_t>> GlTwoPass::State::readPixels(GLenum format, GLenum type) const {
    std::vector<uint32_t> pixels(size_t{width} * height);
    if (pixels.empty()) return pixels;
    context.makeCurrent();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.get());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, static_cast<GLsizei>(width), static_cast<GLsizei>(height), format, type, pixels.data());
    if (const Status done = checkGl("reading an image"); !done) return done.error();
    return pixels;
}

GlTwoPass::GlTwoPass(std::unique_ptr<State> state) : state_(std::move(state)) {}
GlTwoPass::GlTwoPass(GlTwoPass&&) noexcept = default;
GlTwoPass& GlTwoPass::operator=(GlTwoPass&&) noexcept = default;
GlTwoPass::~GlTwoPass() = default;

Result<GlTwoPass> GlTwoPass::create(const GlContext& context, std::span<const DrawItem> items,
                                    std::span<const GlCullPart> parts) {
    for (const GlCullPart& part : parts)
        if (part.item >= items.size() ||
            uint64_t{part.first_triangle} + part.triangle_count > items[part.item].mesh.triangles())
            return Error{Error::Kind::kUsage, "two passes: a part of item " + std::to_string(part.item) +
                                                  " has triangles that the item has not"};
    if (parts.size() > kMostParts)
        return Error{Error::Kind::kUsage, "two passes: more than " + std::to_string(kMostParts) + " parts"};
    context.makeCurrent();
    auto state = std::make_unique<State>(context, items);
    if (const Status made = state->compile(); !made) return made.error();
    state->upload(parts);
    if (const Status done = checkGl("uploading parts"); !done) return done.error();
    return GlTwoPass(std::move(state));
}

void GlTwoPass::moved(std::span<const uint32_t> items) {
    state_->context.makeCurrent();
    for (const uint32_t item : items) {
        const PassItem now = passItemOf(state_->items[item]);
        glNamedBufferSubData(state_->buffers[kItems].get(), static_cast<GLintptr>(item * sizeof(PassItem)), sizeof now,
                             &now);
    }
}

Status GlTwoPass::draw(const View& view) {
    State& state = *state_;
    state.context.makeCurrent();
    if (Status ready = state.resize(view); !ready) return ready;
    const GlView gl_view = makeGlView(view, state.items);
    state.clear();
    state.cull(gl_view, false);
    state.drawParts(gl_view);
    state.reduce();
    state.cull(gl_view, true);
    state.drawParts(gl_view);
    glFinish();
    return checkGl("culling in two passes");
}

Status GlTwoPass::drawAll(const View& view) {
    State& state = *state_;
    state.context.makeCurrent();
    if (Status ready = state.resize(view); !ready) return ready;
    const GlView gl_view = makeGlView(view, state.items);
    state.clear();
    std::vector<PassCommand> commands(state.part_of.size());
    if (!commands.empty()) {
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        const auto bytes = static_cast<GLsizeiptr>(commands.size() * sizeof(PassCommand));
        glGetNamedBufferSubData(state.buffers[kCommands].get(), 0, bytes, commands.data());
        for (PassCommand& command : commands) command.instances = 1;
        glNamedBufferSubData(state.buffers[kCommands].get(), 0, bytes, commands.data());
    }
    state.drawParts(gl_view);
    state.setSeen(0);
    glFinish();
    return checkGl("drawing all parts");
}

Result<GlTwoPass::Drawn> GlTwoPass::readDrawn() const {
    state_->context.makeCurrent();
    Drawn drawn;
    drawn.early = state_->read(kEarly);
    drawn.late = state_->read(kLate);
    if (const Status done = checkGl("reading what was drawn"); !done) return done.error();
    return drawn;
}

Result<std::vector<uint32_t>> GlTwoPass::readItems() const {
    return state_->readPixels(GL_RED_INTEGER, GL_UNSIGNED_INT);
}

Result<std::vector<uint32_t>> GlTwoPass::readDepths() const { return state_->readPixels(GL_DEPTH_COMPONENT, GL_FLOAT); }

}  // namespace sightline
