#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "tests/renderer/path_fixture.hpp"

namespace candela {

/// A scene, its configuration, and random edits of all kinds to both. The same seed gives the same edits.
class RandomEdits {
 public:
    /// The scene needs a mesh and a point light. The last mesh is the one that moves, so it must not be the
    /// room itself. Adds a panel and a lamp as children of a parent that mirrors and stretches them.
    RandomEdits(Scene scene, const Configuration& configuration, unsigned seed);

    /// Makes one edit; returns its name.
    std::string next();
    /// Removes all meshes from the scene.
    void clear_meshes();

    Scene scene;
    Configuration configuration;
    glm::uvec2 size{40, 30};
    bool emission = false;  ///< also add skies and surfaces that emit light, which take much longer to render

 private:
    std::uint32_t draw(std::uint32_t choices) { return static_cast<std::uint32_t>(random_()) % choices; }
    float offset() { return 0.1F * (static_cast<float>(draw(9)) - 4.0F); }
    void shift(Entity entity);
    [[nodiscard]] std::optional<Entity> any(const std::vector<Entity>& entities);
    /// Of anything from two to a thousand triangles, with an image or without.
    [[nodiscard]] std::shared_ptr<const Mesh> any_mesh();

    void move_light() { shift(scene.light); }
    void move_mesh() { shift(block_); }
    void move_parent() { shift(parent_); }
    void mirror_parent();
    void toggle_light();
    void add_point();
    void add_spot();
    void add_sun();
    void add_sky();
    void add_lamp();
    void add_mesh();
    void add_coinciding();
    void paint_mesh();
    void replace_mesh();
    void deform_mesh();
    void remove_something();
    void move_something();
    void move_camera();
    void resize();
    void switch_path();
    void switch_shadows();
    void switch_vpls();

    std::mt19937 random_;
    Entity block_;
    Entity parent_;
    std::vector<Entity> meshes_;  ///< that were added
    std::vector<Entity> extra_;   ///< lights, skies and lamps that were added
    std::shared_ptr<const Material> shared_;
    std::shared_ptr<const Mesh> shared_mesh_;
};

}  // namespace candela
