#include "sandbox/editing/interaction.hpp"

#include <GLFW/glfw3.h>

#include <cmath>

#include <doctest/doctest.h>
#include <glm/gtc/constants.hpp>

#include "sandbox/editing/placing.hpp"
#include "tests/sandbox/editing_scene.hpp"

namespace candela::sandbox {

TEST_SUITE("interaction") {

namespace {

using Kind = InputEvent::Kind;

constexpr glm::vec2 size(640.0F, 480.0F);
constexpr glm::vec2 origin(100.0F, 50.0F);

// A hundredth of a pixel, and about the same in metres at the distances below.
constexpr float tolerance_window = 1e-2F;
constexpr float tolerance_world = 1e-4F;

/// A floor with a cube on it and a light beside, seen from the front and above, and a user.
struct User {
    World world;
    Entity floor = add_mesh(world, square(10.0F),
                            {.translation = {0, -0.5F, 0},
                             .rotation = glm::angleAxis(-glm::half_pi<float>(), glm::vec3(1, 0, 0))});
    Entity box = add_mesh(world, cube(0.5F));
    Entity light = add_point_light(world, {1.5F, 0.5F, 0.5F});
    Interaction interaction{world, add_eye(world, {0.0F, 2.0F, 6.0F})};

    User() {
        world.set(light, Name{"lamp"});
        interaction.wait_for_surfaces();
    }

    [[nodiscard]] Viewport viewport() const {
        return make_viewport(world, interaction.viewer(), size, origin);
    }
    [[nodiscard]] glm::vec2 seen(const glm::vec3& point) const { return project(viewport(), point).value(); }
    [[nodiscard]] glm::vec2 seen(Entity entity) const { return seen(position_of(world, entity)); }

    std::optional<Command> send(InputEvent event) {
        const auto command = interaction.handle(event, size, origin);
        interaction.step(0.0F, size, origin);
        return command;
    }
    void press(glm::vec2 at, int button = GLFW_MOUSE_BUTTON_LEFT, int modifiers = 0) {
        send({.kind = Kind::move, .position = at});
        send({.kind = Kind::press, .code = button, .modifiers = modifiers, .position = at});
    }
    void move(glm::vec2 to) { send({.kind = Kind::move, .position = to}); }
    void release(int button = GLFW_MOUSE_BUTTON_LEFT) { send({.kind = Kind::release, .code = button}); }
    void click(glm::vec2 at) {
        press(at);
        move(at + glm::vec2(1.0F, 1.0F));  // a hand is not quite still
        release();
    }
    std::optional<Command> key(int code, int modifiers = 0, bool repeated = false) {
        return send({.kind = Kind::key, .code = code, .modifiers = modifiers, .repeated = repeated});
    }
    void undo() { key(GLFW_KEY_Z, GLFW_MOD_CONTROL); }
};

}  // namespace

TEST_CASE("a click selects a light before a surface, a surface, or nothing, and the scene stays as it is") {
    User user;
    const glm::mat4 view = user.viewport().clip_from_world;
    user.click(user.seen({0.0F, 0.4F, 0.5F}));
    CHECK(user.interaction.selected == user.box);
    user.click(user.seen(user.light) + glm::vec2(10.0F, 0.0F));
    CHECK(user.interaction.selected == user.light);
    user.click(origin + glm::vec2(320.0F, 5.0F));  // above the horizon
    CHECK_FALSE(user.interaction.selected);
    CHECK(user.viewport().clip_from_world == view);
    CHECK_FALSE(user.interaction.history().undo_name());
}

TEST_CASE("a press on a surface orbits if the pointer moves, and keeps the selection") {
    User user;
    user.click(user.seen({0.0F, 0.4F, 0.5F}));
    const glm::mat4 view = user.viewport().clip_from_world;
    user.press(user.seen({-3.0F, -0.5F, 0.0F}));
    user.move(user.seen({-3.0F, -0.5F, 0.0F}) + glm::vec2(50.0F, 0.0F));
    user.release();
    CHECK(user.viewport().clip_from_world != view);
    CHECK(user.interaction.selected == user.box);
}

TEST_CASE("a light follows the pointer, and the drag is one edit") {
    User user;
    const glm::vec3 start = position_of(user.world, user.light);
    const glm::vec2 from = user.seen(user.light);
    user.press(from + glm::vec2(4.0F, 3.0F));
    for (int i = 1; i <= 10; ++i) user.move(from + glm::vec2(4.0F - 8.0F * static_cast<float>(i), 3.0F));
    CHECK(user.interaction.dragged() == user.light);
    CHECK(glm::distance(user.seen(user.light), from - glm::vec2(80.0F, 0.0F)) < tolerance_window);
    user.release();
    CHECK(user.interaction.history().undo_name() == "move lamp");
    user.undo();
    CHECK(position_of(user.world, user.light) == start);
    CHECK_FALSE(user.interaction.history().undo_name());
    user.key(GLFW_KEY_Y, GLFW_MOD_CONTROL);
    CHECK(glm::distance(user.seen(user.light), from - glm::vec2(80.0F, 0.0F)) < tolerance_window);
}

TEST_CASE("escape first cancels a drag, then deselects, then is the app's") {
    User user;
    const glm::vec3 start = position_of(user.world, user.light);
    user.press(user.seen(user.light));
    user.move(user.seen(user.light) + glm::vec2(50.0F, 50.0F));
    CHECK_FALSE(user.key(GLFW_KEY_ESCAPE));
    CHECK(position_of(user.world, user.light) == start);
    user.move({300.0F, 300.0F});  // the button is still held
    user.release();
    CHECK(position_of(user.world, user.light) == start);
    CHECK(user.interaction.selected == user.light);
    CHECK_FALSE(user.key(GLFW_KEY_ESCAPE));
    CHECK_FALSE(user.interaction.selected);
    CHECK(user.key(GLFW_KEY_ESCAPE) == Command{Action::cancel});
}

TEST_CASE("X, Y and Z keep a drag on an axis, and the same key again frees it") {
    User user;
    const glm::vec3 start = position_of(user.world, user.light);
    user.press(user.seen(start));
    user.move(user.seen(start) + glm::vec2(30.0F, -40.0F));
    user.key(GLFW_KEY_X);
    const glm::vec3 moved = position_of(user.world, user.light) - start;
    CHECK(moved.x > 0.1F);
    CHECK(std::abs(moved.y) + std::abs(moved.z) < tolerance_world);
    user.key(GLFW_KEY_X);
    CHECK(glm::distance(user.seen(user.light), user.seen(start) + glm::vec2(30.0F, -40.0F)) <
          tolerance_window);
    user.release();
    user.undo();
    CHECK(position_of(user.world, user.light) == start);
}

TEST_CASE("an object moves by its gizmo, along an axis and over the floor") {
    User user;
    user.click(user.seen({0.0F, 0.4F, 0.5F}));
    const glm::vec2 centre = user.seen(user.box);
    user.press(centre + glm::vec2(50.0F, 0.0F));  // on the arrow along x
    user.move(centre + glm::vec2(110.0F, 30.0F));
    user.release();
    const glm::vec3 at = position_of(user.world, user.box);
    CHECK(at.x > 0.3F);
    CHECK(std::abs(at.y) + std::abs(at.z) < tolerance_world);

    user.key(GLFW_KEY_V);
    user.press(user.seen(user.box));
    user.move(user.seen({-2.0F, -0.5F, 1.0F}));
    user.release();
    CHECK(glm::distance(position_of(user.world, user.box), {-2.0F, 0.0F, 1.0F}) < tolerance_world);
    user.undo();
    user.undo();
    CHECK(position_of(user.world, user.box) == glm::vec3(0.0F));
}

TEST_CASE("the overlay shows which handle or light is under the pointer, except over a panel") {
    User user;
    user.move(user.seen(user.light));
    CHECK(user.interaction.overlay(user.viewport(), true).lights.at(0).hovered);
    CHECK_FALSE(user.interaction.overlay(user.viewport(), false).lights.at(0).hovered);
    CHECK_FALSE(user.interaction.overlay(user.viewport(), true).gizmo);
    user.click(user.seen({0.0F, 0.4F, 0.5F}));
    const glm::vec2 arrow = user.seen(user.box) + glm::vec2(50.0F, 0.0F);
    user.move(arrow);
    const Overlay overlay = user.interaction.overlay(user.viewport(), true);
    REQUIRE(overlay.active);
    CHECK(overlay.gizmo->handles[*overlay.active].mode == DragMode{DragKind::move_along_axis, 0});
    user.press(arrow);
    user.move(arrow + glm::vec2(90.0F, 90.0F));
    CHECK(user.interaction.overlay(user.viewport(), true).active == overlay.active);
}

TEST_CASE("nudges are one edit until something else happens") {
    User user;
    const glm::vec3 start = position_of(user.world, user.light);
    user.click(user.seen(user.light));
    user.key(GLFW_KEY_UP);
    user.key(GLFW_KEY_UP, 0, true);
    user.key(GLFW_KEY_RIGHT, 0, true);
    CHECK(glm::distance(position_of(user.world, user.light), start) > 0.1F);
    user.undo();
    CHECK(position_of(user.world, user.light) == start);
    CHECK_FALSE(user.interaction.history().undo_name());
}

TEST_CASE("lights are added over the surface in the middle, copied and deleted, and all is undone") {
    User user;
    user.key(GLFW_KEY_L, GLFW_MOD_SHIFT);
    const Entity spot = user.interaction.selected.value();
    // The middle of the picture shows the top of the cube, or its front.
    const auto hit =
        user.interaction.surfaces().first_hit(ray_through(user.viewport(), origin + 0.5F * size));
    const glm::vec3 over = position_of(user.world, spot) - hit.value().point;
    CHECK(glm::dot(over, hit->normal) > 0.1F);
    CHECK(glm::distance(direction_of(user.world, spot), -hit->normal) < tolerance_world);
    user.key(GLFW_KEY_D, GLFW_MOD_CONTROL);
    const Entity copy = user.interaction.selected.value();
    CHECK(copy != spot);
    CHECK(user.world.get<Name>(copy).value == "spot light 2");
    user.key(GLFW_KEY_DELETE);
    CHECK_FALSE(user.interaction.selected);
    CHECK_FALSE(is_present(user.world, copy));
    user.undo();
    CHECK(user.interaction.selected == copy);
    user.undo();
    CHECK_FALSE(user.interaction.selected);
    user.undo();
    CHECK_FALSE(is_present(user.world, spot));
    CHECK_FALSE(user.interaction.history().undo_name());
}

TEST_CASE("a directional light is aimed with rings around the pivot of the view") {
    User user;
    user.key(GLFW_KEY_L, GLFW_MOD_CONTROL);
    const Entity sun = user.interaction.selected.value();
    const Overlay overlay = user.interaction.overlay(user.viewport(), true);
    REQUIRE(overlay.gizmo);
    CHECK(glm::distance(overlay.gizmo->centre, origin + 0.5F * size) < tolerance_window);
    const glm::vec3 before = direction_of(user.world, sun);
    user.press(overlay.gizmo->centre);
    user.move(user.seen({2.0F, -0.5F, 2.0F}));
    user.release();
    CHECK(glm::distance(direction_of(user.world, sun), before) > 0.1F);
    CHECK(user.interaction.history().undo_name() == "aim directional light");
}

TEST_CASE("keys fly until they are released or the window loses the focus, but not with Ctrl or in a drag") {
    User user;
    user.key(GLFW_KEY_W);
    CHECK(user.interaction.moving());
    const glm::vec3 before = position_of(user.world, user.interaction.viewer());
    user.interaction.step(0.1F, size, origin);
    CHECK(position_of(user.world, user.interaction.viewer()) != before);
    user.send({.kind = Kind::key_release, .code = GLFW_KEY_W});
    CHECK_FALSE(user.interaction.moving());
    user.key(GLFW_KEY_E);
    user.send({.kind = Kind::focus_lost});
    CHECK_FALSE(user.interaction.moving());
    CHECK(user.key(GLFW_KEY_S, GLFW_MOD_CONTROL) == Command{Action::save_scene});
    CHECK_FALSE(user.interaction.moving());
    user.press(user.seen(user.light));
    user.key(GLFW_KEY_W);
    CHECK_FALSE(user.interaction.moving());
}

TEST_CASE("the right button looks around, and the wheel then changes the speed and not the distance") {
    User user;
    const glm::vec3 eye = position_of(user.world, user.interaction.viewer());
    user.press({300.0F, 300.0F}, GLFW_MOUSE_BUTTON_RIGHT);
    user.move({340.0F, 300.0F});
    user.send({.kind = Kind::scroll, .scrolled = 3.0F});
    user.release();  // another button
    user.move({380.0F, 300.0F});
    user.release(GLFW_MOUSE_BUTTON_RIGHT);
    const glm::vec3 view = user.viewport().forward;
    user.move({500.0F, 300.0F});
    CHECK(user.viewport().forward == view);
    CHECK(std::abs(std::atan2(view.x, -view.z) - 80.0F / size.y * glm::pi<float>()) < tolerance_world);
    CHECK(position_of(user.world, user.interaction.viewer()) == eye);
}

TEST_CASE("F looks at the selection, or at the whole scene, and Home goes back") {
    User user;
    const glm::mat4 view = user.viewport().clip_from_world;
    user.click(user.seen(user.light));
    user.key(GLFW_KEY_F);
    CHECK(glm::distance(user.seen(user.light), origin + 0.5F * size) < tolerance_window);
    user.key(GLFW_KEY_ESCAPE);
    user.key(GLFW_KEY_F);
    for (const float x : {-10.0F, 10.0F}) {
        for (const float z : {-10.0F, 10.0F}) CHECK(user.viewport().contains(user.seen({x, -0.5F, z})));
    }
    user.key(GLFW_KEY_HOME);
    CHECK(user.viewport().clip_from_world == view);
}

TEST_CASE("what is the app's is returned, presets with their number, repeats only where they are useful") {
    User user;
    CHECK(user.key(GLFW_KEY_Q, GLFW_MOD_CONTROL) == Command{Action::quit});
    for (int number = 1; number <= 4; ++number) {
        CHECK(user.key(GLFW_KEY_0 + number) == Command{Action::preset, number});
    }
    CHECK(user.key(GLFW_KEY_SPACE) == Command{Action::play_pause});
    CHECK(user.key(GLFW_KEY_PERIOD) == Command{Action::step_frame});
    CHECK(user.key(GLFW_KEY_P, 0, true) == Command{Action::next_path});
    CHECK_FALSE(user.key(GLFW_KEY_F11, 0, true));
    CHECK_FALSE(user.key(GLFW_KEY_G));
    CHECK_FALSE(user.interaction.carry_out(Action::screenshot));
}

TEST_CASE("a selected entity that is gone is deselected") {
    User user;
    user.click(user.seen(user.light));
    user.world.destroy(user.light);
    CHECK_FALSE(user.interaction.overlay(user.viewport(), true).gizmo);
    user.interaction.step(0.0F, size, origin);
    CHECK_FALSE(user.interaction.selected);
}

TEST_CASE("a copy of an object stands beside it, so that both are seen") {
    User user;
    const auto copy_of_box = [&] {
        user.interaction.selected = user.box;
        user.key(GLFW_KEY_D, GLFW_MOD_CONTROL);
        const glm::vec3 away =
            position_of(user.world, *user.interaction.selected) - position_of(user.world, user.box);
        CHECK(user.viewport().contains(user.seen(*user.interaction.selected)));
        return away;
    };
    // The viewer looks along -z, from above: the sides of the cube are 1 m long. With a gap, but near.
    const glm::vec3 right = copy_of_box();
    CHECK(right.x > 1.0F);
    CHECK(right.x < 1.5F);
    CHECK(glm::length(glm::vec2(right.y, right.z)) < tolerance_world);
    // At the right edge of the picture there is no room at the right.
    glm::vec3 at(0.0F);
    while (user.viewport().contains(user.seen(at + glm::vec3(0.5F, 0.0F, 0.0F)))) at.x += 0.1F;
    move_to(user.world, user.box, at);
    CHECK(copy_of_box().x < -1.0F);
}

TEST_CASE("a light that is moved into an object is found there, until it is out again") {
    User user;
    CHECK(user.interaction.enclosed().empty());
    move_to(user.world, user.light, {0.1F, 0.1F, 0.1F});
    user.interaction.step(0.0F, size, origin);
    REQUIRE(user.interaction.enclosed().size() == 1);
    CHECK(user.interaction.enclosed().front() == EnclosedLight{user.light, user.box});
    move_to(user.world, user.light, {1.5F, 0.5F, 0.5F});
    user.interaction.step(0.0F, size, origin);
    CHECK(user.interaction.enclosed().empty());
}

TEST_CASE("several objects are selected with Ctrl, and moved, copied and deleted as one step each") {
    User user;
    const Entity lamp = add_point_light(user.world, {-1.5F, 0.5F, 0.5F});
    user.click(user.seen({0.0F, 0.4F, 0.5F}));
    const auto with_control = [&](glm::vec2 at) {
        user.press(at, GLFW_MOUSE_BUTTON_LEFT, GLFW_MOD_CONTROL);
        user.release();
    };
    with_control(user.seen(user.light));
    with_control(user.seen(lamp));
    CHECK(user.interaction.all_selected() == std::vector<Entity>{lamp, user.light, user.box});
    with_control(user.seen(lamp));
    CHECK(user.interaction.all_selected() == std::vector<Entity>{user.light, user.box});
    CHECK(user.interaction.history().undo_count() == 0);

    // A drag of one of them moves both by the same, in one step.
    const glm::vec3 light = position_of(user.world, user.light);
    user.press(user.seen(user.light));
    user.move(user.seen(light + glm::vec3(0.5F, 0.0F, 0.0F)));
    user.release();
    CHECK(glm::distance(position_of(user.world, user.light), light + glm::vec3(0.5F, 0.0F, 0.0F)) <
          tolerance_world);
    CHECK(glm::distance(position_of(user.world, user.box), {0.5F, 0.0F, 0.0F}) < tolerance_world);
    CHECK(user.interaction.history().undo_name() == "move 2 objects");
    user.undo();
    CHECK(position_of(user.world, user.light) == light);
    CHECK(position_of(user.world, user.box) == glm::vec3(0.0F));
    CHECK(user.interaction.all_selected() == std::vector<Entity>{user.light, user.box});

    user.key(GLFW_KEY_D, GLFW_MOD_CONTROL);
    const std::vector<Entity> copies = user.interaction.all_selected();
    REQUIRE(copies.size() == 2);
    CHECK(is_light(user.world, copies[0]));
    CHECK(user.world.has<MeshInstance>(copies[1]));
    CHECK(glm::distance(position_of(user.world, copies[0]) - light, position_of(user.world, copies[1])) <
          tolerance_world);
    user.key(GLFW_KEY_DELETE);
    CHECK_FALSE(is_present(user.world, copies[0]));
    CHECK_FALSE(is_present(user.world, copies[1]));
    user.undo();
    CHECK(user.interaction.all_selected() == copies);
    user.undo();
    CHECK_FALSE(is_present(user.world, copies[1]));
    CHECK(user.interaction.history().undo_count() == 0);

    // A click without Ctrl selects one alone.
    user.click(user.seen({0.0F, 0.4F, 0.5F}));
    CHECK(user.interaction.all_selected() == std::vector<Entity>{user.box});
}

TEST_CASE("what stands on another selected object moves once, not twice") {
    User user;
    const Entity on_box = add_point_light(user.world, {0.0F, 1.0F, 0.0F}, user.box);
    user.interaction.selected = user.box;
    user.interaction.toggle(on_box);
    user.key(GLFW_KEY_RIGHT);
    const glm::vec3 moved = position_of(user.world, user.box);
    CHECK(moved.x > 0.0F);
    CHECK(glm::distance(position_of(user.world, on_box), moved + glm::vec3(0.0F, 1.0F, 0.0F)) < 1e-6F);
    user.undo();
    CHECK(position_of(user.world, user.box) == glm::vec3(0.0F));
}
}  // TEST_SUITE("interaction")

}  // namespace candela::sandbox
