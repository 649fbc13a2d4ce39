// Reading animation scripts: either refused with a message, or written back equal and played on a world.

#include <exception>
#include <optional>
#include <string>
#include <string_view>

#include <glm/common.hpp>

#include <candela/scene/components.hpp>
#include "sandbox/animation/animation_script.hpp"
#include "sandbox/animation/script_writer.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace candela;
using namespace candela::sandbox;

namespace {

std::optional<Script> read(std::string_view json) {
    try {
        return read_script(json);
    } catch (const std::exception& error) {
        fuzz::require_readable(error.what());
        return std::nullopt;
    }
}

/// The nodes that the scripts of the corpus animate.
World make_world() {
    World world;
    for (const char* name : {"lamp", "door", "camera"}) {
        const Entity entity = world.create();
        world.set(entity, Name{name});
        world.set(entity, Transform{});
        world.set(entity, PointLight{});
    }
    return world;
}

void play(const Script& script) {
    World world = make_world();
    std::optional<Animation> animation;
    try {
        animation.emplace(script, world);
    } catch (const std::exception& error) {
        fuzz::require_readable(error.what());
        return;
    }
    for (const int frame : {0, 1, script.frames / 2, script.frames - 1, script.frames}) {
        animation->apply(world, frame);
        for (const auto& [entity, transform] : world.view<Transform>()) {
            fuzz::require(!glm::any(glm::isnan(transform.translation)) &&
                              !glm::any(glm::isnan(transform.scale)) &&
                              !glm::any(glm::isnan(transform.rotation)),
                          "what is animated is a number");
        }
    }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto script = read({reinterpret_cast<const char*>(data), size});
    if (script) {
        fuzz::require(read(write_script(*script)) == script, "what was written is read back");
        play(*script);
    }
    return 0;
}
