#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "sandbox/scene/scene.hpp"

namespace candela::sandbox {

/// The `progress` of an import: see ImportOptions.
using TellProgress = std::function<bool(const ImportProgress&)>;

/// Opens a scene. Passes the progress on to the import.
using OpenScene = std::function<Scene(const TellProgress&)>;

/// Loads scenes in threads of its own, one after the other.
class SceneLoader {
 public:
    /// `wake` is called by other threads, without a lock, when a scene is loaded or could not be.
    explicit SceneLoader(std::function<void()> wake) : wake_(std::move(wake)) {}
    SceneLoader(const SceneLoader&) = delete;
    SceneLoader& operator=(const SceneLoader&) = delete;
    /// Cancels and waits.
    ~SceneLoader();

    /// Cancels what is being loaded. `name`: what messages call the scene.
    void start(OpenScene open, std::string name);
    void cancel();

    [[nodiscard]] bool is_loading() const { return scene_.valid(); }
    [[nodiscard]] bool is_ready() const;
    void wait() const;
    /// The loaded scene; throws what opening it has thrown. It must be ready.
    [[nodiscard]] Scene take() { return scene_.get(); }

    /// "loading cornell.gltf: reading meshes, 40 %"; empty if nothing is being loaded.
    [[nodiscard]] std::string words() const;
    /// Whether no thread is working.
    [[nodiscard]] bool is_idle() const;

 private:
    /// What the loading thread shares with this object.
    struct State {
        std::mutex mutex;
        ImportProgress progress;  // guarded by the mutex
        std::atomic<bool> cancelled = false;
    };

    std::function<void()> wake_;
    std::string name_;
    std::shared_ptr<State> state_;
    std::future<Scene> scene_;
    std::vector<std::future<Scene>> cancelled_;  // their threads may still be working
};

}  // namespace candela::sandbox
