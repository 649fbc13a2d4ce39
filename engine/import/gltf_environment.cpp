#include "engine/import/gltf_environment.hpp"

#include <string>

#include <fmt/format.h>

#include <candela/scene/sky_picture.hpp>
#include "engine/import/gltf_accessors.hpp"
#include "engine/import/gltf_nodes.hpp"
#include "engine/import/sky_picture_size.hpp"

namespace candela::gltf {

namespace {

std::shared_ptr<const SkyPicture> decode_sky(Bytes bytes, ImportBudget& budget) {
    const PictureSize size = sky_picture_size(bytes);
    budget.add_picture(static_cast<std::uint64_t>(size.width), static_cast<std::uint64_t>(size.height));
    return decode_sky_picture(bytes);
}

/// Null if there is none.
std::shared_ptr<const SkyPicture> read_picture(const Document& document, const tinygltf::Value& source,
                                               ImportFiles& files, ImportBudget& budget) {
    try {
        if (source.Has("bufferView")) {
            return decode_sky(buffer_view_bytes(document, source.Get("bufferView").GetNumberAsInt()), budget);
        }
        if (source.Has("uri")) {
            return decode_sky(*files.read(source.Get("uri").Get<std::string>()), budget);
        }
        return nullptr;
    } catch (const SceneError& error) {
        throw SceneError(fmt::format("the environment's picture: {}", error.what()));
    }
}

}  // namespace

std::optional<NamedEnvironment> read_environment(const Document& document, ImportFiles& files,
                                                 ImportBudget& budget) {
    const tinygltf::ExtensionMap& extensions = default_scene(document.model).extensions;
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
    environment.picture = read_picture(document, source, files, budget);
    const bool is_named = source.Has("name");
    return NamedEnvironment{is_named ? source.Get("name").Get<std::string>() : "environment", environment};
}

}  // namespace candela::gltf
