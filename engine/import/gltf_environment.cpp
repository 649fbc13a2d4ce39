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
std::shared_ptr<const SkyPicture> read_picture(const Document& document, const EnvironmentSource& source,
                                               ImportFiles& files, ImportBudget& budget) {
    try {
        if (source.buffer_view >= 0) {
            return decode_sky(buffer_view_bytes(document, source.buffer_view), budget);
        }
        return source.uri.empty() ? nullptr : decode_sky(*files.read(source.uri), budget);
    } catch (const SceneError& error) {
        throw SceneError(fmt::format("the environment's picture: {}", error.what()));
    }
}

}  // namespace

std::optional<NamedEnvironment> read_environment(const Document& document, ImportFiles& files,
                                                 ImportBudget& budget) {
    const std::optional<EnvironmentSource>& source = default_scene(document.model).environment;
    if (!source) {
        return std::nullopt;
    }
    return NamedEnvironment{source->name,
                            Environment{.radiance = source->radiance,
                                        .picture = read_picture(document, *source, files, budget),
                                        .rotation = source->rotation}};
}

}  // namespace candela::gltf
