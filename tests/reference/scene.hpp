#pragma once

#include <memory>

#include "engine/ecs/world.hpp"

namespace candela::reference {

struct SceneContent;

/// A world as the path tracer sees it. Keeps what it needs: the world may go away. Tracing does not change
/// it, so that several threads may trace the same scene.
class Scene {
 public:
    /// Throws SceneError if a transform is faulty and std::runtime_error where Embree fails.
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
