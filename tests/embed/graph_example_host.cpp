// The program sandbox/hosts/graph.cpp. It looks at what was drawn before it is shown, and closes the window
// after a few frames.

// clang-format off
#include <epoxy/gl.h>  // before GLFW, which would include another header of GL
#include <GLFW/glfw3.h>
// clang-format on

#include <cstdio>
#include <cstdlib>
#include <vector>

static int frames = 0;

/// In place of glfwSwapBuffers.
void look_and_swap(GLFWwindow* window) {
    std::vector<unsigned char> red(640 * 360);
    glReadPixels(0, 0, 640, 360, GL_RED, GL_UNSIGNED_BYTE, red.data());
    long lit = 0;
    for (const unsigned char pixel : red) lit += pixel == 255 ? 1 : 0;
    if (lit != 40 * 8 * 8) {
        std::printf("the boxes of 40 particles cover %ld pixels\n", lit);
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
#include "../../sandbox/hosts/graph.cpp"
