#include "sandbox/window/scene_loader.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

namespace candela::sandbox {

namespace {

bool has_ended(const std::future<Scene>& scene) {
    return scene.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

SceneLoader::~SceneLoader() {
    cancel();
}

void SceneLoader::start(OpenScene open, std::string name) {
    cancel();
    name_ = std::move(name);
    state_ = std::make_shared<State>();
    scene_ = std::async(std::launch::async, [open = std::move(open), state = state_, wake = wake_] {
        const struct Wake {
            const std::function<void()>& wake;
            ~Wake() { wake(); }
        } at_the_end{wake};
        return open([&](const ImportProgress& progress) {
            const std::scoped_lock lock(state->mutex);
            state->progress = progress;
            return !state->cancelled;
        });
    });
}

void SceneLoader::cancel() {
    std::erase_if(cancelled_, has_ended);
    if (scene_.valid()) {
        state_->cancelled = true;
        cancelled_.push_back(std::move(scene_));
    }
}

bool SceneLoader::is_ready() const {
    return scene_.valid() && has_ended(scene_);
}

void SceneLoader::wait() const {
    if (scene_.valid()) scene_.wait();
}

std::string SceneLoader::words() const {
    if (!scene_.valid()) return "";
    const std::scoped_lock lock(state_->mutex);
    const ImportProgress& progress = state_->progress;
    if (progress.doing.empty()) return fmt::format("loading {}", name_);
    return fmt::format("loading {}: {}, {:.0f} %", name_, progress.doing, 100.0 * progress.share);
}

bool SceneLoader::is_idle() const {
    return (!scene_.valid() || is_ready()) && std::ranges::all_of(cancelled_, has_ended);
}

}  // namespace candela::sandbox
