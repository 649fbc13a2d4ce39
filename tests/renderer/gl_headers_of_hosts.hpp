#pragma once

// The GL headers that a host may use, as far as they are installed. GLEW and epoxy exclude each other.

#if __has_include(<GL/glew.h>)
#include <GL/glew.h>
#elif __has_include(<epoxy/gl.h>)
#include <epoxy/gl.h>
#else
#include <GL/gl.h>
#endif
#if __has_include(<GLFW/glfw3.h>)
#include <GLFW/glfw3.h>
#endif
