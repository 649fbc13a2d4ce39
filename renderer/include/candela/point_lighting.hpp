#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include <candela/api.hpp>

namespace candela {

class Gpu;
class Pass;
struct Lighting;

/// The light at any point, for shaders of a host's passes, such as those that draw its particles, fog or
/// materials: the same functions that light Candela's own surfaces, with what they read. A value; it belongs
/// to the frame graph that is being declared.
class CANDELA_API PointLighting {
 public:
    /// GLSL 4.50 of functions and of what they need, to be put after the directive with the version and
    /// before the host's own code, in any stage. It depends on the configuration and on what the world
    /// contains: compile again when it has changed. The functions, which
    /// shaders/receivers/point_lighting.glsl describes:
    ///
    ///     uint candela_light_count();
    ///     Incident candela_light(uint index, vec3 position, vec3 normal);  // .direction, .irradiance
    ///     Incident candela_light(uint index, vec3 position);               // in the air
    ///     vec3 candela_irradiance_from_lights(vec3 position, vec3 normal);
    ///     uint candela_vpl_count();
    ///     vec3 candela_irradiance_from_vpls(vec3 position, vec3 normal, uint most, uint pattern);
    ///     vec3 candela_irradiance(vec3 position, vec3 normal, uint pattern);  // from both
    ///
    /// The text also defines names without this prefix, such as Surface, Light and PI. Where the host's own
    /// are the same, make the text a shader object of its own, declare these functions in the host's shader
    /// of the same stage, and link both into one program. Storage blocks of vertex shaders, of which OpenGL
    /// does not guarantee any, are needed to light vertices.
    [[nodiscard]] std::string glsl() const;

    /// Declares, for a pass that uses these functions, what they read. The binding points are then set when
    /// the pass runs.
    void read(Pass& pass) const;

    // What the functions leave to the host's own declarations in such a pass; other texture units and
    // binding points are in use.
    static constexpr std::uint32_t free_storage_bindings = 10;  ///< this, and three that follow
    static constexpr std::uint32_t free_uniform_bindings = 5;   ///< this, and all that follow
    static constexpr std::uint32_t free_texture_units = 13;     ///< this, and all that follow

 private:
    struct Parts;
    explicit PointLighting(std::shared_ptr<const Parts> parts) : parts_(std::move(parts)) {}
    friend PointLighting make_point_lighting(const Gpu& gpu, const Lighting& lighting);

    std::shared_ptr<const Parts> parts_;
};

}  // namespace candela
