#include "sandbox/window/scene_loader.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

TEST_SUITE("scene loader") {

using namespace candela;
using namespace candela::sandbox;

namespace {

/// Waits until the condition holds, at most 20 s.
template <class Condition>
bool holds_soon(Condition condition) {
    for (int i = 0; i < 2000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return condition();
}

/// A scene that is never loaded, unless it is cancelled.
Scene endless(const TellProgress& tell) {
    while (tell({"reading meshes", 0.25})) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    throw ImportCancelled("the import was cancelled");
}

}  // namespace

TEST_CASE("a scene is loaded, and the window is woken") {
    std::atomic<int> woken = 0;
    SceneLoader loader([&] { ++woken; });
    CHECK(!loader.is_loading());
    CHECK(loader.words().empty());
    loader.start(
        [](const TellProgress& tell) {
            return load_scene(shipped_file("scenes", "cornell.gltf"),
                              {.limits = {}, .root = {}, .progress = tell});
        },
        "cornell.gltf");
    REQUIRE(holds_soon([&] { return loader.is_ready(); }));
    CHECK(woken == 1);
    CHECK(loader.take().world.count<MeshInstance>() > 0);
    CHECK(!loader.is_loading());
    CHECK(loader.is_idle());
}

TEST_CASE("words tell what is done, and a cancelled scene ends") {
    SceneLoader loader([] {});
    loader.start(endless, "hall.glb");
    CHECK(holds_soon([&] { return loader.words() == "loading hall.glb: reading meshes, 25 %"; }));
    CHECK(!loader.is_idle());
    loader.cancel();
    CHECK(!loader.is_loading());
    CHECK(holds_soon([&] { return loader.is_idle(); }));
}

TEST_CASE("another scene replaces the one that is being loaded") {
    SceneLoader loader([] {});
    loader.start(endless, "first");
    loader.start([](const TellProgress&) -> Scene { throw std::runtime_error("second: no such file"); },
                 "second");
    REQUIRE(holds_soon([&] { return loader.is_ready(); }));
    CHECK_THROWS_WITH((void)loader.take(), "second: no such file");
    CHECK(holds_soon([&] { return loader.is_idle(); }));
}

}  // TEST_SUITE("scene loader")
