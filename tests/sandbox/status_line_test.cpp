#include "sandbox/panels/status_line.hpp"

#include <doctest/doctest.h>

#include "sandbox/candela_private.hpp"
#include "sandbox/editing/light_picking.hpp"
#include "sandbox/editing/placing.hpp"
#include "sandbox/window/session_state.hpp"

namespace candela::sandbox {

TEST_SUITE("status line") {

TEST_CASE("it tells the frame time, and what converges") {
    Status status;
    status.frame_ms = 12.34;
    status.mean_ms = 15.0;
    CHECK(to_words(status) == "12.3 ms (mean 15.0)");
    status.vpls = 512;
    status.refined = 12;
    status.to_refine = 1024;
    CHECK(to_words(status) == "12.3 ms (mean 15.0) · 512 VPLs · refined 12/1024");
    status.noise = 0.0123;
    CHECK(to_words(status) == "12.3 ms (mean 15.0) · 512 VPLs · refined 12/1024 · noise 1.2 %");
    status.settled = true;
    CHECK(to_words(status) == "12.3 ms (mean 15.0) · 512 VPLs · refined 12/1024 · noise 1.2 % · done");
}

TEST_CASE("it tells the quality that was chosen for the frame time") {
    Status status;
    status.frame_ms = 60.0;
    status.mean_ms = 60.0;
    status.quality = {0.5F, 8};
    CHECK(to_words(status) == "60.0 ms (mean 60.0) · 50 % of the sides while moving");
}

TEST_CASE("it warns of a light that no light gets out of, unless there are no shadows") {
    SessionState state;
    state.document.emplace(load_scene(shipped_file("scenes", "cornell.gltf")), std::nullopt, 1.0F);
    World& world = state.document->scene.world;
    Interaction& interaction = state.document->interaction;
    interaction.wait_for_surfaces();
    interaction.step(0.0F, {640.0F, 480.0F});
    CHECK(status_of(state).warning.empty());
    // Into the middle of the first object that is closed: one of the two blocks.
    const Entity light = light_markers(world).front().entity;
    for (auto [entity, mesh] : world.view<MeshInstance>()) {
        const Box box = box_of(world, {entity});
        if (name_of(world, entity).find("block") == std::string::npos) continue;
        move_to(world, light, 0.5F * (box.lower + box.upper));
        break;
    }
    interaction.step(0.0F, {640.0F, 480.0F});
    CHECK(status_of(state).warning.starts_with("ceiling light is inside "));
    state.app.configuration.shadows.enabled = false;
    CHECK(status_of(state).warning.empty());
}
}  // TEST_SUITE("status line")

}  // namespace candela::sandbox
