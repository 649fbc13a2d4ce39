#include "sandbox/window/redraw.hpp"

#include <doctest/doctest.h>

namespace candela::sandbox {

TEST_SUITE("redraw") {

namespace {

constexpr Redraw::Clock::time_point start{std::chrono::seconds(100)};

/// How often it is drawn while nothing else happens.
int count_draws(Redraw& redraw) {
    int draws = 0;
    for (; redraw.is_due(start); ++draws) redraw.draw(start);
    return draws;
}

}  // namespace

TEST_CASE("a change is drawn until panels have settled, a new picture once") {
    Redraw redraw;
    CHECK(count_draws(redraw) > 1);  // the first frames
    CHECK_FALSE(redraw.has_changes());
    redraw.changed();
    CHECK(redraw.has_changes());
    const int settling = count_draws(redraw);
    CHECK(settling > 1);
    redraw.changed_once();
    CHECK(count_draws(redraw) == 1);
    redraw.changed();
    redraw.changed_once();
    CHECK(count_draws(redraw) == settling);
}

TEST_CASE("while only the pointer moves, it is drawn now and then") {
    Redraw redraw;
    CHECK(count_draws(redraw) > 0);
    const auto soon = start + Redraw::between_moves / 2;
    CHECK_FALSE(redraw.is_due(soon + Redraw::between_moves));  // nothing has moved
    redraw.pointer_moved();
    CHECK(redraw.has_moves());
    CHECK_FALSE(redraw.is_due(soon));
    CHECK(redraw.is_due(start + Redraw::between_moves));
    CHECK_FALSE(redraw.is_due(start + Redraw::between_moves, true));  // a picture follows
    CHECK(redraw.is_due(start + Redraw::while_rendering, true));
    redraw.draw(start + Redraw::between_moves);
    CHECK_FALSE(redraw.has_moves());
    redraw.pointer_moved();
    CHECK_FALSE(redraw.is_due(soon + Redraw::between_moves));
}
}  // TEST_SUITE("redraw")

}  // namespace candela::sandbox
