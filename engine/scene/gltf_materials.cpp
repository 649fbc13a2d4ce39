#include "engine/scene/gltf_materials.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <string_view>
#include <tuple>

#include <fmt/format.h>
#include <stb/stb_image.h>

#include <candela/scene/scene_error.hpp>
#include "engine/scene/gltf_accessors.hpp"

namespace candela::gltf {

namespace {

using Bytes = std::span<const unsigned char>;
using ImageKey = std::tuple<int, Wrap, Wrap>;  // index, wrap_u, wrap_v
using Images = std::map<ImageKey, std::shared_ptr<const Image>>;

bool starts_with(Bytes bytes, std::string_view prefix) {
    return bytes.size() >= prefix.size() && std::memcmp(bytes.data(), prefix.data(), prefix.size()) == 0;
}

Image decode(Bytes encoded) {
    // Upper bound of pixels per encoded byte, to reject headers with impossible sizes. Deflate compresses at
    // most 1,032 : 1 (zlib's documentation), and an uncompressed PNG byte holds at most 8 pixels. A JPEG uses
    // at least 1 bit for 64 pixels, which gives fewer pixels per byte.
    constexpr std::uint64_t most_pixels_in_a_byte = 8256;  // 8 × 1,032

    if (!starts_with(encoded, "\x89PNG") && !starts_with(encoded, "\xFF\xD8\xFF")) {
        throw SceneError("it is neither PNG nor JPEG");
    }
    if (encoded.size() > std::numeric_limits<int>::max()) {
        throw SceneError("it exceeds 2 GiB");
    }
    const int size = static_cast<int>(encoded.size());
    int width = 0;
    int height = 0;
    if (stbi_info_from_memory(encoded.data(), size, &width, &height, nullptr) == 0) {
        throw SceneError("it cannot be decoded");
    }
    if (std::uint64_t(width) * std::uint64_t(height) > most_pixels_in_a_byte * encoded.size()) {
        throw SceneError(fmt::format("its {} bytes cannot hold {} x {} pixels", size, width, height));
    }
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
        stbi_load_from_memory(encoded.data(), size, &width, &height, nullptr, STBI_rgb_alpha),
        stbi_image_free);
    if (!pixels) {
        throw SceneError("it cannot be decoded");
    }

    Image image;
    image.width = static_cast<std::uint32_t>(width);
    image.height = static_cast<std::uint32_t>(height);
    image.texels.resize(std::size_t{image.width} * image.height);
    std::memcpy(image.texels.data(), pixels.get(), image.texels.size() * sizeof(glm::u8vec4));
    return image;
}

std::shared_ptr<const Image> load_image(const tinygltf::Model& model, const ImageKey& key,
                                        const std::filesystem::path& base_directory) {
    const auto& [index, wrap_u, wrap_v] = key;
    const tinygltf::Image& source = model.images[static_cast<std::size_t>(index)];
    try {
        Image image = source.bufferView >= 0 ? decode(buffer_view_bytes(model, source.bufferView))
                                             : decode(read_uri(source.uri, base_directory));
        image.wrap_u = wrap_u;
        image.wrap_v = wrap_v;
        return std::make_shared<const Image>(std::move(image));
    } catch (const SceneError& error) {
        throw SceneError(fmt::format("image {}: {}", index, error.what()));
    }
}

Wrap to_wrap(int mode, int sampler) {
    switch (mode) {
        case TINYGLTF_TEXTURE_WRAP_REPEAT:
            return Wrap::repeat;
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
            return Wrap::mirrored_repeat;
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
            return Wrap::clamp_to_edge;
        default:
            throw SceneError(fmt::format("sampler {} has the unknown wrapping mode {}", sampler, mode));
    }
}

/// The image of a base colour and the wrapping modes of its sampler.
ImageKey image_key(const tinygltf::Model& model, const tinygltf::Texture& texture) {
    if (texture.sampler < 0) {
        return {texture.source, Wrap::repeat, Wrap::repeat};
    }
    const tinygltf::Sampler& sampler = model.samplers[static_cast<std::size_t>(texture.sampler)];
    return {texture.source, to_wrap(sampler.wrapS, texture.sampler), to_wrap(sampler.wrapT, texture.sampler)};
}

/// Reads the images of materials. Textures with the same image and wrapping share one.
class ImageReader {
 public:
    ImageReader(Document& document, const std::filesystem::path& base_directory)
        : document_(document), base_directory_(base_directory) {}

    /// The image of a texture; null, with a warning that starts with `label`, if it cannot be used.
    std::shared_ptr<const Image> read(int index, int coordinate_set, const std::string& label) {
        if (index < 0) {
            return nullptr;
        }
        const tinygltf::Texture& texture = document_.model.textures[static_cast<std::size_t>(index)];
        if (texture.source < 0) {
            document_.warnings.push_back(fmt::format("{} has no PNG or JPEG image; ignored", label));
            return nullptr;
        }
        if (coordinate_set != 0) {
            document_.warnings.push_back(
                fmt::format("{} uses coordinate set {}; only set 0 is read; ignored", label, coordinate_set));
            return nullptr;
        }
        const ImageKey key = image_key(document_.model, texture);
        std::shared_ptr<const Image>& image = images_[key];
        if (!image) {
            image = load_image(document_.model, key, base_directory_);
        }
        return image;
    }

 private:
    Document& document_;
    const std::filesystem::path& base_directory_;
    Images images_;
};

/// KHR_materials_emissive_strength; check_schema has checked the value.
double emissive_strength(const tinygltf::Material& material) {
    const auto extension = material.extensions.find(emissive_strength_extension);
    if (extension == material.extensions.end() || !extension->second.Has("emissiveStrength")) {
        return 1.0;
    }
    return extension->second.Get("emissiveStrength").GetNumberAsDouble();
}

/// check_schema accepts no other names.
AlphaMode to_alpha_mode(std::string_view name) {
    if (name == "MASK") {
        return AlphaMode::mask;
    }
    return name == "BLEND" ? AlphaMode::blend : AlphaMode::opaque;
}

Material read_material(const tinygltf::Material& source, const std::string& label, ImageReader& images) {
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    Material material;
    material.name = source.name;
    for (int i = 0; i < 4; ++i) {
        material.base_colour[i] = static_cast<float>(pbr.baseColorFactor[static_cast<std::size_t>(i)]);
    }
    for (int i = 0; i < 3; ++i) {
        material.emissive[i] = static_cast<float>(source.emissiveFactor[static_cast<std::size_t>(i)] *
                                                  emissive_strength(source));
        if (!std::isfinite(material.emissive[i])) {
            throw SceneError(fmt::format("{}: its emission is too large", label));
        }
    }
    material.base_colour_texture =
        images.read(pbr.baseColorTexture.index, pbr.baseColorTexture.texCoord, label + ": its texture");
    if (material.emissive != glm::vec3(0.0F)) {
        material.emissive_texture = images.read(source.emissiveTexture.index, source.emissiveTexture.texCoord,
                                                label + ": its emissive texture");
    }
    material.double_sided = source.doubleSided;
    material.alpha_mode = to_alpha_mode(source.alphaMode);
    material.alpha_cutoff = static_cast<float>(source.alphaCutoff);
    return material;
}

}  // namespace

std::vector<std::shared_ptr<const Material>> read_materials(Document& document,
                                                            const std::filesystem::path& base_directory) {
    ImageReader images(document, base_directory);
    std::vector<std::shared_ptr<const Material>> materials;
    for (const tinygltf::Material& source : document.model.materials) {
        const std::string label = fmt::format("material {}", materials.size());
        materials.push_back(std::make_shared<const Material>(read_material(source, label, images)));
    }
    materials.push_back(std::make_shared<const Material>());
    return materials;
}

}  // namespace candela::gltf
