#include "engine/import/gltf_environment.hpp"

#include <string>

#include <candela/scene/sky_picture.hpp>
#include "engine/import/gltf_accessors.hpp"
#include "engine/import/gltf_nodes.hpp"
#include "engine/import/naming.hpp"
#include "engine/import/sky_picture_size.hpp"

namespace candela::gltf {

namespace {

std::shared_ptr<const SkyPicture> decode_sky(Bytes bytes, ImportBudget& budget) {
    const PictureSize size = sky_picture_size(bytes);
    budget.add_picture(static_cast<std::uint64_t>(size.width), static_cast<std::uint64_t>(size.height));
    return decode_sky_picture(bytes);
}

/// Null if there is none.
std::shared_ptr<const SkyPicture> read_picture(const Document& document, const Json& source,
                                               ImportFiles& files, ImportBudget& budget) {
    return naming("the environment's picture", [&]() -> std::shared_ptr<const SkyPicture> {
        if (const int view = index_in(source, "bufferView"); view >= 0) {
            return decode_sky(buffer_view_bytes(document, view), budget);
        }
        const std::string uri = text_in(source, "uri");
        return uri.empty() ? nullptr : decode_sky(*files.read(uri), budget);
    });
}

}  // namespace

std::optional<NamedEnvironment> read_environment(const Document& document, ImportFiles& files,
                                                 ImportBudget& budget) {
    const Json* const source = find_member(default_scene(document), "extensions.CANDELA_environment");
    if (!source) return std::nullopt;
    return NamedEnvironment{text_in(*source, "name", "environment"),
                            Environment{.radiance = vector_in(*source, "radiance", glm::vec3(1.0F)),
                                        .picture = read_picture(document, *source, files, budget),
                                        .rotation = value_in(*source, "rotation", 0.0F)}};
}

}  // namespace candela::gltf
