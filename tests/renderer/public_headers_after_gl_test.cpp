// clang-format off
#include "tests/renderer/gl_headers_of_hosts.hpp"
#include "tests/renderer/public_headers.hpp"
// clang-format on

#include <doctest/doctest.h>

TEST_SUITE("public headers") {
TEST_CASE("the host's GL types can be used with the API") {
    const GLuint framebuffer = 3;
    const candela::Target target{.framebuffer = framebuffer, .size = {4, 2}};
    CHECK(target.framebuffer == framebuffer);
}

}  // TEST_SUITE("public headers")
