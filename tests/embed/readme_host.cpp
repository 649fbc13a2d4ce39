// The first example of README.md, word for word: CMakeLists.txt extracts it. Around it stands what README.md
// leaves to the host: a window, the lamp's way, and the end of the loop.

#include <GL/gl.h>
#include <GLFW/glfw3.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "readme_includes.inc"

namespace {

constexpr unsigned width = 160;
constexpr unsigned height = 120;
int frames = 0;
GLFWwindow* window = nullptr;
std::array<unsigned char, 4> middle{};  // of the last frame

/// Shows what was drawn, and asks for four frames.
struct Running {
    operator bool() const {
        glReadPixels(width / 2, height / 2, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, middle.data());
        glfwSwapBuffers(window);
        glfwPollEvents();
        return frames++ < 4;
    }
};

glm::vec3 lamp_position() {
    return {0.3F * std::sin(static_cast<float>(frames)), 1.5F, 0.5F};
}

}  // namespace

int main() {
    if (glfwInit() == GLFW_FALSE) {
        std::puts("readme_host needs a display");
        return 1;
    }
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    window = glfwCreateWindow(width, height, "host", nullptr, nullptr);
    glfwMakeContextCurrent(window);
    const Running running;

#include "readme_body.inc"

    if (middle[0] < 20) {
        std::puts("the lamp does not light the middle of the picture");
        return 1;
    }
    return 0;
}
