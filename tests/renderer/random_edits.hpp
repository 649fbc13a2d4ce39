#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "tests/renderer/path_fixture.hpp"

namespace candela {

/// A scene, how it is rendered, and edits of all kinds to both, at random but the same for the same seed.
class RandomEdits {
 public:
    /// The scene needs a mesh and a point light; the mesh that came last must leave a room behind it when it
    /// moves. Hangs a panel and a lamp on a parent that mirrors and stretches them.
    RandomEdits(Scene scene, const Configuration& configuration, unsigned seed);

    /// Does one edit; gives its name.
    std::string next();
    /// Takes all meshes out of the scene.
    void clear_meshes();

    Scene scene;
    Configuration configuration;
    glm::uvec2 size{40, 30};

 private:
    std::uint32_t draw(std::uint32_t choices) { return static_cast<std::uint32_t>(random_()) % choices; }
    float offset() { return 0.1F * (static_cast<float>(draw(9)) - 4.0F); }
    void shift(Entity entity);

    void move_light() { shift(scene.light); }
    void move_mesh() { shift(block_); }
    void move_parent() { shift(parent_); }
    void mirror_parent();
    void toggle_light();
    void add_point();
    void add_spot();
    void add_sun();
    void add_mesh();
    void paint_mesh();
    void remove_something();
    void move_something();
    void move_camera();
    void resize();
    void switch_path();
    void switch_shadows();

    std::mt19937 random_;
    Entity block_;
    Entity parent_;
    std::vector<Entity> extra_;  ///< lights and meshes that came
};

}  // namespace candela
