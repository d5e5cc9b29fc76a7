// A window with a GL: what the user does in it, frame by frame.
// SPDX-License-Identifier: MIT
#include "apps/viewer/window.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace sightline::viewer {
namespace {

GLFWwindow* of(void* window) { return static_cast<GLFWwindow*>(window); }

std::string lastError() {
    const char* words = nullptr;
    glfwGetError(&words);
    return words ? words : "unknown reason";
}

/// What comes as events, between two frames.
struct Typed {
    float wheel = 0;
    std::string text;
};

void appendUtf8(std::string& text, uint32_t code) {
    if (code < 0x80) {
        text += static_cast<char>(code);
    } else if (code < 0x800) {
        text += static_cast<char>(0xc0 | code >> 6);
        text += static_cast<char>(0x80 | (code & 0x3f));
    } else {
        if (code < 0x10000) {
            text += static_cast<char>(0xe0 | code >> 12);
        } else {
            text += static_cast<char>(0xf0 | code >> 18);
            text += static_cast<char>(0x80 | (code >> 12 & 0x3f));
        }
        text += static_cast<char>(0x80 | (code >> 6 & 0x3f));
        text += static_cast<char>(0x80 | (code & 0x3f));
    }
}

Input inputOf(GLFWwindow* window, double seconds, Typed& typed) {
    Input input;
    input.seconds = seconds;
    double x = 0, y = 0;
    glfwGetCursorPos(window, &x, &y);
    int window_width = 1, window_height = 1, width = 1, height = 1;
    glfwGetWindowSize(window, &window_width, &window_height);
    glfwGetFramebufferSize(window, &width, &height);
    input.mouse_x = static_cast<float>(x * width / std::max(window_width, 1));
    input.mouse_y = static_cast<float>(y * height / std::max(window_height, 1));
    constexpr int kButtons[] = {GLFW_MOUSE_BUTTON_LEFT, GLFW_MOUSE_BUTTON_RIGHT, GLFW_MOUSE_BUTTON_MIDDLE};
    for (int i = 0; i < 3; ++i) input.buttons[i] = glfwGetMouseButton(window, kButtons[i]) == GLFW_PRESS;
    const auto held = [&](int key) { return glfwGetKey(window, key) == GLFW_PRESS; };
    for (int key = 'A'; key <= 'Z'; ++key) input.keys[key] = held(key);
    for (int key = '0'; key <= '9'; ++key) input.keys[key] = held(key);
    constexpr std::pair<uint16_t, int> kNamed[] = {
        {kEscape, GLFW_KEY_ESCAPE},       {kEnter, GLFW_KEY_ENTER},   {kTab, GLFW_KEY_TAB},
        {kBackspace, GLFW_KEY_BACKSPACE}, {kDelete, GLFW_KEY_DELETE}, {kLeft, GLFW_KEY_LEFT},
        {kRight, GLFW_KEY_RIGHT},         {kUp, GLFW_KEY_UP},         {kDown, GLFW_KEY_DOWN},
        {kHome, GLFW_KEY_HOME},           {kEnd, GLFW_KEY_END}};
    for (const auto& [key, code] : kNamed) input.keys[key] = held(code);
    for (int i = 0; i < 12; ++i) input.keys[kF1 + i] = held(GLFW_KEY_F1 + i);
    input.shift = held(GLFW_KEY_LEFT_SHIFT) || held(GLFW_KEY_RIGHT_SHIFT);
    input.control = held(GLFW_KEY_LEFT_CONTROL) || held(GLFW_KEY_RIGHT_CONTROL);
    input.alt = held(GLFW_KEY_LEFT_ALT) || held(GLFW_KEY_RIGHT_ALT);
    input.wheel = std::exchange(typed.wheel, 0.0f);
    input.text = std::exchange(typed.text, {});
    return input;
}

}  // namespace

Result<Window> Window::open(const std::string& title, uint32_t width, uint32_t height) {
    if (glfwInit() != GLFW_TRUE)
        return Error{Error::Kind::kInput,
                     "view: no window can be opened here: " + lastError() + "; --headless draws without one"};
    Window made;
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    for (const auto& [major, minor] : {std::pair(4, 5), std::pair(3, 3)}) {
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, major);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, minor);
        glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
        glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
        made.window_ =
            glfwCreateWindow(static_cast<int>(width), static_cast<int>(height), title.c_str(), nullptr, nullptr);
        if (made.window_ != nullptr) break;
    }
    if (made.window_ == nullptr) {
        const std::string why = lastError();
        glfwTerminate();
        return Error{Error::Kind::kInput, "view: no window with OpenGL 3.3 can be opened: " + why};
    }
    glfwMakeContextCurrent(of(made.window_));
    glfwSwapInterval(1);
    return made;
}

Window::Window(Window&& other) noexcept : window_(std::exchange(other.window_, nullptr)) {}

Window::~Window() {
    if (window_ == nullptr) return;
    glfwDestroyWindow(of(window_));
    glfwTerminate();
}

float Window::scale() const {
    float x = 1, y = 1;
    glfwGetWindowContentScale(of(window_), &x, &y);
    return x;
}

void Window::run(const std::function<Next(const Input& input, uint32_t width, uint32_t height)>& draw) {
    GLFWwindow* const window = of(window_);
    Typed typed;
    glfwShowWindow(window);
    glfwSetWindowUserPointer(window, &typed);
    // What is pressed and let go between two frames is seen in the next one.
    glfwSetInputMode(window, GLFW_STICKY_KEYS, GLFW_TRUE);
    glfwSetInputMode(window, GLFW_STICKY_MOUSE_BUTTONS, GLFW_TRUE);
    glfwSetScrollCallback(window, [](GLFWwindow* in, double, double up) {
        static_cast<Typed*>(glfwGetWindowUserPointer(in))->wheel += static_cast<float>(up);
    });
    glfwSetCharCallback(window, [](GLFWwindow* in, unsigned code) {
        appendUtf8(static_cast<Typed*>(glfwGetWindowUserPointer(in))->text, code);
    });
    double last = glfwGetTime();
    Next next = Next::kFrame;
    while (next != Next::kEnd && glfwWindowShouldClose(window) == GLFW_FALSE) {
        if (next == Next::kRest) glfwWaitEventsTimeout(0.1);
        else glfwPollEvents();
        int width = 0, height = 0;
        glfwGetFramebufferSize(window, &width, &height);
        if (width <= 0 || height <= 0) {  // minimized
            glfwWaitEventsTimeout(0.1);
            continue;
        }
        const double now = glfwGetTime();
        next = draw(inputOf(window, now - last, typed), static_cast<uint32_t>(width), static_cast<uint32_t>(height));
        last = now;
        glfwSwapBuffers(window);
    }
    glfwSetWindowUserPointer(window, nullptr);
}

}  // namespace sightline::viewer
