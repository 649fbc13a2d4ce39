#include "engine/import/gltf_materials.hpp"

#include <cmath>
#include <cstdint>
#include <map>
#include <string_view>
#include <tuple>

#include <fmt/format.h>

#include <candela/scene/scene_error.hpp>
#include "engine/import/decode_image.hpp"
#include "engine/import/gltf_accessors.hpp"

namespace candela::gltf {

namespace {

using ImageKey = std::tuple<const unsigned char*, Wrap, Wrap>;  // encoded bytes, wrap_u, wrap_v

Wrap to_wrap(int mode, int sampler) {
    switch (mode) {
        case wrap_repeat:
            return Wrap::repeat;
        case wrap_mirrored_repeat:
            return Wrap::mirrored_repeat;
        case wrap_clamp_to_edge:
            return Wrap::clamp_to_edge;
        default:
            throw SceneError(fmt::format("sampler {} has the unknown wrapping mode {}", sampler, mode));
    }
}

/// How a texture repeats along u and v.
struct Wraps {
    Wrap u = Wrap::repeat;
    Wrap v = Wrap::repeat;
};

Wraps wraps_of(const Model& model, const Texture& texture) {
    if (texture.sampler < 0) {
        return {};
    }
    const Sampler& sampler = model.samplers[static_cast<std::size_t>(texture.sampler)];
    return {to_wrap(sampler.wrap_s, texture.sampler), to_wrap(sampler.wrap_t, texture.sampler)};
}

/// Of (u, v, 1): scales, then rotates, then moves.
glm::mat3 transform_of(const TextureUse& use) {
    const auto cosine = static_cast<float>(std::cos(use.rotation));
    const auto sine = static_cast<float>(std::sin(use.rotation));
    return {glm::vec3(cosine * use.scale.x, -sine * use.scale.x, 0.0F),
            glm::vec3(sine * use.scale.y, cosine * use.scale.y, 0.0F), glm::vec3(use.offset, 1.0F)};
}

/// Reads the images of materials. Textures with the same bytes and wrapping share one.
class ImageReader {
 public:
    ImageReader(Document& document, ImportFiles& files, ImportBudget& budget)
        : document_(document), files_(files), budget_(budget) {}

    /// The image of a texture; null, with a warning that starts with `label`, if it cannot be used.
    std::shared_ptr<const Image> read(const TextureUse& use, const std::string& label) {
        if (use.texture < 0) {
            return nullptr;
        }
        const Texture& texture = document_.model.textures[static_cast<std::size_t>(use.texture)];
        if (texture.image < 0) {
            warn(fmt::format("{} has no PNG or JPEG image; ignored", label));
            return nullptr;
        }
        if (use.coordinate_set != 0) {
            warn(fmt::format("{} uses coordinate set {}; only set 0 is read; ignored", label,
                             use.coordinate_set));
            return nullptr;
        }
        const Wraps wraps = wraps_of(document_.model, texture);
        try {
            return load(texture.image, wraps);
        } catch (const SceneError& error) {
            throw SceneError(fmt::format("image {}: {}", texture.image, error.what()));
        }
    }

    void warn(std::string warning) { document_.warnings.push_back(std::move(warning)); }

 private:
    std::shared_ptr<const Image> load(int index, const Wraps& wraps) {
        const Bytes encoded = encoded_image(index);
        std::shared_ptr<const Image>& image = images_[{encoded.data(), wraps.u, wraps.v}];
        if (!image) {
            Image decoded = decode_image(encoded, budget_);
            decoded.wrap_u = wraps.u;
            decoded.wrap_v = wraps.v;
            image = std::make_shared<const Image>(std::move(decoded));
        }
        return image;
    }

    Bytes encoded_image(int index) {
        const EncodedImage& source = document_.model.images[static_cast<std::size_t>(index)];
        if (source.buffer_view >= 0) {
            return buffer_view_bytes(document_, source.buffer_view);
        }
        Content& content = contents_[index];
        if (!content) {
            content = files_.read(source.uri);
        }
        return *content;
    }

    Document& document_;
    ImportFiles& files_;
    ImportBudget& budget_;
    std::map<int, Content> contents_;  // by image; keeps their bytes, whose addresses identify images
    std::map<ImageKey, std::shared_ptr<const Image>> images_;
};

/// check_schema accepts no other names.
AlphaMode to_alpha_mode(std::string_view name) {
    if (name == "MASK") {
        return AlphaMode::mask;
    }
    return name == "BLEND" ? AlphaMode::blend : AlphaMode::opaque;
}

/// KHR_materials_unlit: what is seen is the base colour, whatever the light. Such a surface emits it.
void show_unlit(Material& material) {
    material.emissive = glm::vec3(material.base_colour);
    material.emissive_texture = emits(material) ? material.base_colour_texture : nullptr;
    material.base_colour = glm::vec4(0.0F, 0.0F, 0.0F, material.base_colour.a);
}

ReadMaterial read_material(const MaterialSource& source, const std::string& label, ImageReader& images) {
    const TextureUse& emissive = source.unlit ? source.base_colour_texture : source.emissive_texture;
    Material material;
    material.name = source.name;
    for (int i = 0; i < 4; ++i) {
        material.base_colour[i] = static_cast<float>(source.base_colour[static_cast<std::size_t>(i)]);
    }
    for (int i = 0; i < 3; ++i) {
        material.emissive[i] =
            static_cast<float>(source.emissive[static_cast<std::size_t>(i)] * source.emissive_strength);
        if (!std::isfinite(material.emissive[i])) {
            throw SceneError(fmt::format("{}: its emission is too large", label));
        }
    }
    material.base_colour_texture = images.read(source.base_colour_texture, label + ": its texture");
    if (source.unlit) {
        show_unlit(material);
    } else if (material.emissive != glm::vec3(0.0F)) {
        material.emissive_texture = images.read(emissive, label + ": its emissive texture");
    }
    const glm::mat3 transform = transform_of(source.base_colour_texture);
    if (material.base_colour_texture && material.emissive_texture && transform != transform_of(emissive)) {
        images.warn(label + ": its emissive texture is transformed like its base colour");
    }
    material.double_sided = source.double_sided;
    material.alpha_mode = to_alpha_mode(source.alpha_mode);
    material.alpha_cutoff = static_cast<float>(source.alpha_cutoff);
    const glm::mat3 used = material.base_colour_texture ? transform : transform_of(emissive);
    return {std::make_shared<const Material>(std::move(material)), used};
}

std::vector<bool> used_materials(const Model& model, const std::vector<bool>& used_meshes) {
    std::vector<bool> used(model.materials.size());
    for (std::size_t i = 0; i < model.meshes.size(); ++i) {
        for (const PrimitiveSource& primitive : model.meshes[i].primitives) {
            if (used_meshes[i] && primitive.material >= 0) {
                used[static_cast<std::size_t>(primitive.material)] = true;
            }
        }
    }
    return used;
}

}  // namespace

std::vector<ReadMaterial> read_materials(Document& document, const std::vector<bool>& used_meshes,
                                         ImportFiles& files, ImportBudget& budget, const Progress& progress) {
    ImageReader images(document, files, budget);
    const std::vector<bool> used = used_materials(document.model, used_meshes);
    std::vector<ReadMaterial> materials(used.size());
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (used[i]) {
            progress("reading materials and images", i, used.size());
            materials[i] = read_material(document.model.materials[i], fmt::format("material {}", i), images);
        }
    }
    materials.push_back({std::make_shared<const Material>()});
    return materials;
}

}  // namespace candela::gltf
