#include "sandbox/editing/enclosed_lights.hpp"

#include <cstddef>
#include <optional>

#include <fmt/format.h>

#include <candela/scene/lights.hpp>
#include "sandbox/editing/placing.hpp"
#include "sandbox/scene/scene.hpp"

namespace candela::sandbox {

std::vector<EnclosedLight> enclosed_lights(const World& world, const tools::SceneRays& surfaces) {
    constexpr std::size_t most = 1000;
    std::size_t searched = 0;
    std::vector<EnclosedLight> enclosed;
    visit_lights(world, [&]<class Light>(Entity entity, const Light& light) {
        if (!light_traits<Light>.has_position || !light.casts_shadow || ++searched > most) return;
        const std::optional<Entity> object = surfaces.enclosing(position_of(world, entity));
        if (object) enclosed.push_back({entity, *object});
    });
    return enclosed;
}

std::string words_of(const World& world, const std::vector<EnclosedLight>& enclosed) {
    if (enclosed.empty()) return "";
    if (enclosed.size() > 1) {
        return fmt::format("{} lights are inside closed objects, which let no light out", enclosed.size());
    }
    return fmt::format("{} is inside {}, which lets no light out", name_of(world, enclosed.front().light),
                       name_of(world, enclosed.front().object));
}

}  // namespace candela::sandbox
