#include "sandbox/window/layout.hpp"

#include <doctest/doctest.h>

namespace candela::sandbox {

TEST_SUITE("layout") {

TEST_CASE("the parts fill the window and do not overlap, whatever its size") {
    for (const glm::vec2 window : {glm::vec2(1280, 720), {640, 360}, {400, 300}, {3840, 2160}, {100, 80}}) {
        for (const float scale : {1.0F, 2.0F}) {
            const Layout layout = make_layout(window, scale, {});
            CAPTURE(window.x);
            CAPTURE(scale);
            CHECK(layout.status.size.y == 24.0F);
            CHECK(layout.panel_button.size.y == 24.0F);
            CHECK(layout.status.size.x + layout.panel_button.size.x == window.x);
            CHECK(layout.panel_button.corner == glm::vec2(layout.status.size.x, 0.0F));
            CHECK(layout.scene.corner == glm::vec2(0.0F, 24.0F));
            CHECK(layout.scene.size.x + layout.panel.size.x == window.x);
            CHECK(layout.panel.corner.x == layout.scene.size.x);
            CHECK(layout.scene.size.y == window.y - 24.0F);
            CHECK(layout.panel.size.y == layout.scene.size.y);
        }
    }
}

TEST_CASE("the picture keeps two thirds of the width") {
    for (float width = 100.0F; width < 2000.0F; width += 7.0F) {
        const Layout layout = make_layout({width, 500.0F}, 1.0F, {});
        CHECK(layout.scene.size.x >= 2.0F / 3.0F * width - 1e-3F);
    }
}

TEST_CASE("a panel that would be too narrow to read, or that is not wanted, is not shown") {
    CHECK(make_layout({300, 500}, 1.0F, {}).panel.size.x == 0.0F);
    CHECK(make_layout({1280, 720}, 1.0F, {.panel = false}).panel.size.x == 0.0F);
    CHECK(make_layout({690, 360}, 1.0F, {}).panel.size.x == 230.0F);
    CHECK(make_layout({690, 360}, 2.0F, {}).panel.size.x == 0.0F);
    CHECK(make_layout({1280, 720}, 1.0F, {}).panel.size.x == 340.0F);
}

TEST_CASE("a tiny window still has a picture") {
    const Layout layout = make_layout({1, 1}, 1.0F, {});
    CHECK(layout.scene.size == glm::vec2(1.0F));
    CHECK(layout.panel.size.x == 0.0F);
}
}  // TEST_SUITE("layout")

}  // namespace candela::sandbox
