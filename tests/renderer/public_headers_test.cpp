// Public headers compile before the GL headers of a host, and show nothing of GL.
// public_headers_after_gl_test.cpp includes them after those.

// clang-format off
#include "tests/renderer/public_headers.hpp"

#if defined(GL_VERSION_1_0) || defined(APIENTRY)
#error "a public header includes GL"
#endif
#ifdef BINDING_LIGHTS
#error "a public header shows binding points"
#endif

#include "tests/renderer/gl_headers_of_hosts.hpp"
// clang-format on

#include <doctest/doctest.h>

#include <type_traits>

TEST_SUITE("public headers") {
    TEST_CASE("a renderer can be moved but not copied") {
        CHECK(std::is_nothrow_move_constructible_v<candela::Renderer>);
        CHECK_FALSE(std::is_copy_constructible_v<candela::Renderer>);
    }

    TEST_CASE("the table of shading paths is in the order of their enumeration") {
        for (const candela::ShadingPathInfo& path : candela::shading_paths) {
            CHECK(candela::info_of(path.path).name == path.name);
        }
    }
}
