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

#include <stdexcept>
#include <type_traits>

TEST_SUITE("public headers") {
TEST_CASE("a renderer can be moved but not copied") {
    CHECK(std::is_nothrow_move_constructible_v<candela::Renderer>);
    CHECK_FALSE(std::is_copy_constructible_v<candela::Renderer>);
}

TEST_CASE("all exceptions of the library have one base class") {
    using candela::Error;
    CHECK(std::is_base_of_v<std::runtime_error, Error>);
    CHECK(std::is_base_of_v<Error, candela::EntityError>);
    CHECK(std::is_base_of_v<Error, candela::UndeclaredAccess>);
    CHECK(std::is_base_of_v<Error, candela::SceneError>);
    CHECK(std::is_base_of_v<Error, candela::GraphError>);
    CHECK(std::is_base_of_v<Error, candela::ContextError>);
    CHECK(std::is_base_of_v<Error, candela::gl::GlError>);
    CHECK(std::is_base_of_v<Error, candela::tools::ToolError>);
    CHECK(std::is_base_of_v<candela::gl::GlError, candela::gl::ProgramError>);
}

TEST_CASE("a host that catches the base class catches every error") {
    candela::World world;
    CHECK_THROWS_AS(static_cast<void>(world.get<candela::Camera>({})), candela::Error);
    CHECK_THROWS_AS(candela::import_gltf("nowhere.gltf", world), candela::Error);
    CHECK_THROWS_AS(static_cast<void>(candela::load_sky_picture("nowhere.hdr")), candela::Error);
    CHECK_THROWS_AS(candela::Renderer(nullptr), candela::Error);
}

TEST_CASE("the table of shading paths is in the order of their enumeration") {
    for (const candela::ShadingPathInfo& path : candela::shading_paths) {
        CHECK(candela::info_of(path.path).name == path.name);
    }
}

}  // TEST_SUITE("public headers")
