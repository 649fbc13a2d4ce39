// The program in README.md, word for word: CMakeLists.txt extracts it. It looks at what was drawn before it
// is shown, and closes the window after a few frames.

#include <GL/gl.h>
#include <GLFW/glfw3.h>

#include <array>
#include <cstdio>
#include <cstdlib>

static int frames = 0;

/// In place of glfwSwapBuffers.
void look_and_swap(GLFWwindow* window) {
    std::array<unsigned char, 4> middle{};
    glReadPixels(320, 180, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, middle.data());
    if (middle[0] < 20) {
        std::puts("the lamp does not light the middle of the picture");
        std::exit(1);
    }
    ++frames;
    glfwSwapBuffers(window);
}

/// In place of glfwWindowShouldClose.
int close_after_four(GLFWwindow*) {
    return frames == 4 ? GLFW_TRUE : GLFW_FALSE;
}

#define glfwSwapBuffers look_and_swap
#define glfwWindowShouldClose close_after_four
#include "readme_example.inc"
