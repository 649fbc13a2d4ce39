#pragma once

#include <memory>

#include <candela/ecs/world.hpp>

namespace candela::reference {

struct SceneContent;

/// A world, prepared for the path tracer. Copies what it needs: the world may be destroyed. Tracing does not
/// change the scene, so several threads may trace it at once.
class Scene {
 public:
    /// Throws SceneError if a transform is invalid and std::runtime_error if Embree fails.
    explicit Scene(const World& world);
    ~Scene();
    Scene(Scene&& other) noexcept;
    Scene& operator=(Scene&& other) noexcept;
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    [[nodiscard]] const SceneContent& content() const { return *content_; }

 private:
    std::unique_ptr<SceneContent> content_;
};

}  // namespace candela::reference
