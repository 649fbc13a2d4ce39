#include "sandbox/window/document.hpp"

#include <GLFW/glfw3.h>

#include <doctest/doctest.h>

#include <glm/geometric.hpp>
#include "sandbox/editing/light_picking.hpp"
#include "sandbox/files/numbered_file.hpp"
#include "sandbox/window/save_commands.hpp"

#include <candela/scene/hierarchy.hpp>

namespace candela::sandbox {

TEST_SUITE("document") {

namespace {

using Kind = InputEvent::Kind;

constexpr glm::vec2 size(480.0F, 360.0F);

/// The shipped Cornell box with a script that moves one of its nodes in equal steps.
Scene moving(const std::string& node, int frames, const glm::vec3& from, const glm::vec3& to) {
    Scene scene = load_scene(shipped_file("scenes", "cornell.gltf"));
    Script script;
    script.frames = frames;
    script.tracks = {{.node = node, .translation = {{0, from}, {frames - 1, to}}}};
    scene.animation.emplace(std::move(script), scene.world);
    return scene;
}

struct Player {
    Document document;

    explicit Player(Scene scene) : document(std::move(scene), std::nullopt, size.x / size.y) {}

    /// Frames until the script has ended.
    int play() {
        int frames = 0;
        for (; document.is_playing() && frames < 100; ++frames) document.animate();
        return frames;
    }
    void step() {
        document.playback->step();
        document.animate();
    }
    [[nodiscard]] glm::mat4 view() const {
        return world_matrix(document.scene.world, document.interaction.viewer());
    }
    [[nodiscard]] glm::vec3 eye() const { return {view()[3]}; }
    void send(InputEvent event) {
        document.interaction.handle(event, size);
        document.interaction.step(0.0F, size);
    }
    void orbit() {
        send({.kind = Kind::move, .position = {240.0F, 300.0F}});
        send({.kind = Kind::press, .code = GLFW_MOUSE_BUTTON_LEFT, .position = {240.0F, 300.0F}});
        send({.kind = Kind::move, .position = {200.0F, 290.0F}});
        send({.kind = Kind::release, .code = GLFW_MOUSE_BUTTON_LEFT});
        document.animate();
    }
};

constexpr float rounding = 1e-6F;  // of coordinates of a few metres

}  // namespace

TEST_CASE("a script plays to its end, can be stepped, and is played again") {
    Player player(moving("ceiling light", 20, {-0.4F, 1.6F, 0.0F}, {0.4F, 1.6F, 0.0F}));
    const World& world = player.document.scene.world;
    const auto check_light_at = [&](float x) {
        REQUIRE(world.count<PointLight>() == 1);
        const Entity light = std::get<0>(*world.view<PointLight>().begin());
        CHECK(glm::distance(glm::vec3(world_matrix(world, light)[3]), {x, 1.6F, 0.0F}) < rounding);
    };
    CHECK(player.play() == 21);  // and one more, in which it is seen to have ended
    check_light_at(0.4F);
    player.step();
    check_light_at(-0.4F);
    for (int step = 0; step < 5; ++step) player.step();
    check_light_at(-0.4F + 5.0F * 0.8F / 19.0F);
    player.document.playback->toggle();
    CHECK(player.play() == 15);
    check_light_at(0.4F);
}

TEST_CASE("the view follows a camera that a script moves, and can be orbited after the end") {
    Player player(moving("camera", 10, {0.0F, 1.0F, 3.9F}, {0.3F, 1.0F, 3.9F}));
    const glm::mat4 start = player.view();
    for (int frame = 0; frame < 10; ++frame) {
        CHECK(player.document.animate() == (frame == 0));  // a jump to the first frame
        CHECK(glm::distance(player.eye(), {0.3F * static_cast<float>(frame) / 9.0F, 1.0F, 3.9F}) < rounding);
    }
    CHECK(player.play() == 1);
    const glm::mat4 end = player.view();
    player.orbit();
    CHECK(glm::distance(player.eye(), glm::vec3(end[3])) > 0.01F);
    player.step();
    CHECK(player.view() == start);
}

TEST_CASE("another thread gets the same copy of the world while nothing changes") {
    Player player(moving("ceiling light", 2, glm::vec3(0.0F), glm::vec3(1.0F)));
    player.play();
    const std::shared_ptr<const World> copy = player.document.copy_of_world();
    player.document.animate();
    CHECK(player.document.copy_of_world() == copy);
    player.step();
    CHECK(player.document.copy_of_world() != copy);
}

TEST_CASE("a recording of something that has not moved writes no file, and says so") {
    Document document(load_scene(shipped_file("scenes", "cornell.gltf")), std::nullopt, 1.0F);
    document.interaction.selected = light_markers(document.scene.world).front().entity;
    const std::filesystem::path next = next_numbered_file("-animation.json");
    static_cast<void>(toggle_recording(document));
    REQUIRE(document.recorder);
    for (const double seconds : {0.0, 0.1, 1.0}) document.recorder->record(document.scene.world, seconds);
    CHECK(toggle_recording(document) == "nothing has moved: no script was written");
    CHECK_FALSE(document.recorder);
    CHECK_FALSE(std::filesystem::exists(next));
}
}  // TEST_SUITE("document")

}  // namespace candela::sandbox
