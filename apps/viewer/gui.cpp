// Dear ImGui in the viewer's own GL: what the user did goes in, panels come out.
// SPDX-License-Identifier: MIT
#include "apps/viewer/gui.h"

#include <algorithm>
#include <utility>

#include <imgui.h>

namespace sightline::viewer {
namespace {

constexpr const char* kVertexShader = R"(#version 330 core
layout(location = 0) in vec2 place;
layout(location = 1) in vec2 texel;
layout(location = 2) in vec4 colour;
uniform vec2 size;
out vec2 at;
out vec4 ink;
void main() {
    gl_Position = vec4(2.0 * place.x / size.x - 1.0, 1.0 - 2.0 * place.y / size.y, 0.0, 1.0);
    at = texel;
    ink = colour;
}
)";

constexpr const char* kFragmentShader = R"(#version 330 core
in vec2 at;
in vec4 ink;
uniform sampler2D picture;
out vec4 shown;
void main() { shown = ink * texture(picture, at); }
)";

GlName makeFont() {
    ImGuiIO& io = ImGui::GetIO();
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    io.Fonts->SetTexID(reinterpret_cast<ImTextureID>(static_cast<uintptr_t>(name)));
    return {name, [](uint32_t old) { glDeleteTextures(1, &old); }};
}

void nameKeys(ImGuiIO& io) {
    constexpr std::pair<int, uint16_t> kNames[] = {{ImGuiKey_Tab, kTab},
                                                   {ImGuiKey_LeftArrow, kLeft},
                                                   {ImGuiKey_RightArrow, kRight},
                                                   {ImGuiKey_UpArrow, kUp},
                                                   {ImGuiKey_DownArrow, kDown},
                                                   {ImGuiKey_Home, kHome},
                                                   {ImGuiKey_End, kEnd},
                                                   {ImGuiKey_Delete, kDelete},
                                                   {ImGuiKey_Backspace, kBackspace},
                                                   {ImGuiKey_Enter, kEnter},
                                                   {ImGuiKey_Escape, kEscape},
                                                   {ImGuiKey_A, 'A'},
                                                   {ImGuiKey_C, 'C'},
                                                   {ImGuiKey_V, 'V'},
                                                   {ImGuiKey_X, 'X'},
                                                   {ImGuiKey_Y, 'Y'},
                                                   {ImGuiKey_Z, 'Z'}};
    for (const auto& [name, key] : kNames) io.KeyMap[name] = key;
}

}  // namespace

Result<Gui> Gui::create() {
    Gui gui;
    gui.context_ = ImGui::CreateContext();
    ImGui::SetCurrentContext(gui.context_);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // no file appears where the user happens to stand
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    nameKeys(io);
    ImGui::StyleColorsDark();
    ImGui::GetStyle().WindowRounding = 4;
    Result<GlName> program = makeGlProgram(kVertexShader, kFragmentShader);
    if (!program) return program.error();
    gui.program_ = std::move(*program);
    gui.to_clip_ = glGetUniformLocation(gui.program_.get(), "size");
    gui.font_ = makeFont();
    gui.array_ = makeArray();
    glBindVertexArray(gui.array_.get());
    gui.vertices_ = makeBuffer(GL_ARRAY_BUFFER, {}, GL_STREAM_DRAW);
    gui.indices_ = makeBuffer(GL_ELEMENT_ARRAY_BUFFER, {}, GL_STREAM_DRAW);
    const auto attribute = [](GLuint which, GLint parts, GLenum type, GLboolean whole, size_t offset) {
        glEnableVertexAttribArray(which);
        glVertexAttribPointer(which, parts, type, whole, sizeof(ImDrawVert), reinterpret_cast<const void*>(offset));
    };
    attribute(0, 2, GL_FLOAT, GL_FALSE, offsetof(ImDrawVert, pos));
    attribute(1, 2, GL_FLOAT, GL_FALSE, offsetof(ImDrawVert, uv));
    attribute(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(ImDrawVert, col));
    glBindVertexArray(0);
    if (const Status done = checkGl("preparing the panels"); !done) return done.error();
    return gui;
}

Gui::Gui(Gui&& other) noexcept { *this = std::move(other); }

Gui& Gui::operator=(Gui&& other) noexcept {
    std::swap(context_, other.context_);
    font_ = std::move(other.font_);
    vertices_ = std::move(other.vertices_);
    indices_ = std::move(other.indices_);
    array_ = std::move(other.array_);
    program_ = std::move(other.program_);
    to_clip_ = other.to_clip_;
    return *this;
}

Gui::~Gui() {
    if (context_ != nullptr) ImGui::DestroyContext(context_);
}

void Gui::begin(const Input& input, uint32_t width, uint32_t height, float scale) {
    ImGui::SetCurrentContext(context_);
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = ImVec2(static_cast<float>(width), static_cast<float>(height));
    io.FontGlobalScale = scale;
    io.DeltaTime = static_cast<float>(std::max(input.seconds, 1e-4));
    io.MousePos = ImVec2(input.mouse_x, input.mouse_y);
    std::copy(std::begin(input.buttons), std::end(input.buttons), io.MouseDown);
    io.MouseWheel = input.wheel;
    std::copy(std::begin(input.keys), std::end(input.keys), io.KeysDown);
    io.KeyShift = input.shift;
    io.KeyCtrl = input.control;
    io.KeyAlt = input.alt;
    io.AddInputCharactersUTF8(input.text.c_str());
    ImGui::NewFrame();
}

bool Gui::wantsMouse() const { return ImGui::GetIO().WantCaptureMouse; }
bool Gui::wantsKeys() const { return ImGui::GetIO().WantCaptureKeyboard; }

void Gui::draw() {
    ImGui::Render();
    const ImDrawData& all = *ImGui::GetDrawData();
    glUseProgram(program_.get());
    glUniform2f(to_clip_, all.DisplaySize.x, all.DisplaySize.y);
    glBindVertexArray(array_.get());
    glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
    glActiveTexture(GL_TEXTURE0);
    for (GLenum i = 0; i < 8; ++i) glDisable(GL_CLIP_DISTANCE0 + i);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glEnable(GL_SCISSOR_TEST);
    for (int i = 0; i < all.CmdListsCount; ++i) {
        const ImDrawList& list = *all.CmdLists[i];
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(list.VtxBuffer.size_in_bytes()), list.VtxBuffer.Data,
                     GL_STREAM_DRAW);
        glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(list.IdxBuffer.size_in_bytes()),
                     list.IdxBuffer.Data, GL_STREAM_DRAW);
        for (const ImDrawCmd& command : list.CmdBuffer) {
            const ImVec4& clip = command.ClipRect;
            const float width = clip.z - clip.x, height = clip.w - clip.y;
            if (width <= 0 || height <= 0) continue;
            glScissor(static_cast<GLint>(clip.x), static_cast<GLint>(all.DisplaySize.y - clip.w),
                      static_cast<GLsizei>(width), static_cast<GLsizei>(height));
            glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(reinterpret_cast<uintptr_t>(command.GetTexID())));
            glDrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount),
                                     sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
                                     reinterpret_cast<const void*>(size_t{command.IdxOffset} * sizeof(ImDrawIdx)),
                                     static_cast<GLint>(command.VtxOffset));
        }
    }
    glDisable(GL_SCISSOR_TEST);
}

}  // namespace sightline::viewer
