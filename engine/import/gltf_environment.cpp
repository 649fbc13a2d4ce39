#include "engine/import/gltf_environment.hpp"

#include <string>

#include <fmt/format.h>

#include <candela/scene/sky_picture.hpp>
#include "engine/import/gltf_nodes.hpp"

namespace candela::gltf {

namespace {

std::shared_ptr<const SkyPicture> read_picture(const std::string& uri,
                                               const std::filesystem::path& base_directory) {
    try {
        return decode_sky_picture(read_uri(uri, base_directory));
    } catch (const SceneError& error) {
        throw SceneError(fmt::format("the environment's picture: {}", error.what()));
    }
}

}  // namespace

std::optional<Environment> read_environment(const tinygltf::Model& model,
                                            const std::filesystem::path& base_directory) {
    const tinygltf::ExtensionMap& extensions = default_scene(model).extensions;
    const auto found = extensions.find(environment_extension);
    if (found == extensions.end()) {
        return std::nullopt;
    }
    const tinygltf::Value& source = found->second;
    Environment environment{.radiance = glm::vec3(1.0F), .picture = nullptr};
    for (int i = 0; i < 3 && source.Has("radiance"); ++i) {
        environment.radiance[i] = static_cast<float>(source.Get("radiance").Get(i).GetNumberAsDouble());
    }
    if (source.Has("rotation")) {
        environment.rotation = static_cast<float>(source.Get("rotation").GetNumberAsDouble());
    }
    if (source.Has("uri")) {
        environment.picture = read_picture(source.Get("uri").Get<std::string>(), base_directory);
    }
    return environment;
}

}  // namespace candela::gltf
