#include "engine/import/gltf_environment.hpp"

#include <string>

#include <fmt/format.h>

#include <candela/scene/sky_picture.hpp>
#include "engine/import/gltf_accessors.hpp"
#include "engine/import/gltf_nodes.hpp"

namespace candela::gltf {

namespace {

/// Null if there is none.
std::shared_ptr<const SkyPicture> read_picture(const tinygltf::Model& model, const tinygltf::Value& source,
                                               const std::filesystem::path& base_directory) {
    try {
        if (source.Has("bufferView")) {
            return decode_sky_picture(buffer_view_bytes(model, source.Get("bufferView").GetNumberAsInt()));
        }
        if (source.Has("uri")) {
            return decode_sky_picture(read_uri(source.Get("uri").Get<std::string>(), base_directory));
        }
        return nullptr;
    } catch (const SceneError& error) {
        throw SceneError(fmt::format("the environment's picture: {}", error.what()));
    }
}

}  // namespace

std::optional<NamedEnvironment> read_environment(const tinygltf::Model& model,
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
    environment.picture = read_picture(model, source, base_directory);
    const bool is_named = source.Has("name");
    return NamedEnvironment{is_named ? source.Get("name").Get<std::string>() : "environment", environment};
}

}  // namespace candela::gltf
