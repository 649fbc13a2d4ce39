#include "engine/import/gltf_materials.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <candela/scene/scene_error.hpp>
#include "engine/import/decode_image.hpp"
#include "engine/import/gltf_accessors.hpp"
#include "engine/import/gltf_constants.hpp"
#include "engine/import/naming.hpp"
#include "engine/import/piece_error.hpp"
#include "engine/import/stand_ins.hpp"
#include "engine/readable.hpp"

namespace candela::gltf {

namespace {

using ImageKey = std::tuple<const unsigned char*, Wrap, Wrap, Encoding>;  // encoded bytes, wrap_u, wrap_v

/// How a texture repeats along u and v.
struct Wraps {
    Wrap u = Wrap::repeat;
    Wrap v = Wrap::repeat;
};

Wraps wraps_of(const Document& document, const Json& texture) {
    const int index = index_in(texture, "sampler");
    if (index < 0) return {};
    const Json& sampler = document.at("samplers", index);
    return {value_in(sampler, "wrapS", Wrap::repeat), value_in(sampler, "wrapT", Wrap::repeat)};
}

/// The index of a texture's image; -1 for none. Beside an image of a kind that an extension adds, there may
/// be another one for who cannot read that kind.
int image_of(const Json& texture) {
    const auto added_by = [&](const char* extension) {
        return index_in(texture, fmt::format("extensions.{}.source", extension));
    };
    const int webp = added_by(webp_extension);
    const int plain = index_in(texture, "source");
    if (webp >= 0 && (reads_webp() || plain < 0)) return webp;
    return plain >= 0 ? plain : added_by(basisu_extension);
}

/// What KHR_texture_transform of a textureInfo does to (u, v, 1): scales, then rotates, then moves.
glm::mat3 transform_of(const Json& use) {
    const Json* const transform = find_member(use, "extensions.KHR_texture_transform");
    if (!transform) return glm::mat3(1.0F);
    const auto scale = vector_in(*transform, "scale", glm::vec2(1.0F));
    const auto offset = vector_in(*transform, "offset", glm::vec2(0.0F));
    const double rotation = value_in(*transform, "rotation", 0.0);
    const auto cosine = static_cast<float>(std::cos(rotation));
    const auto sine = static_cast<float>(std::sin(rotation));
    return {glm::vec3(cosine * scale.x, -sine * scale.x, 0.0F),
            glm::vec3(sine * scale.y, cosine * scale.y, 0.0F), glm::vec3(offset, 1.0F)};
}

/// The texture coordinates of a textureInfo. The extension's set replaces that of the textureInfo.
Coordinates coordinates_of(const Json& use) {
    const int set = value_in(use, "texCoord", 0);
    return {value_in(use, "extensions.KHR_texture_transform.texCoord", set), transform_of(use)};
}

/// Reads the images of materials. Textures with the same bytes and wrapping share one.
class ImageReader {
 public:
    ImageReader(Document& document, ImportFiles& files, ImportBudget& budget)
        : document_(document), files_(files), budget_(budget) {}

    /// The image of a textureInfo. What stands in for an image that cannot be read comes with one warning for
    /// that image. `use` may be null.
    std::shared_ptr<const Image> read(const Json* use, Encoding encoding, StandIn stand_in) {
        if (!use) return nullptr;
        const int index = index_in(*use, "index");
        const Json& texture = document_.at("textures", index);
        const int image = image_of(texture);
        const Wraps wraps = wraps_of(document_, texture);
        const std::string called =
            image < 0 ? fmt::format("texture {}", index) : fmt::format("image {}", image);
        try {
            // Each is tried once: trying again would use up the budget.
            if (!unreadable_.contains(called)) {
                return naming(called, [&] { return load(image, wraps, encoding); });
            }
        } catch (const PieceError& fault) {
            unreadable_.insert(called);
            warn(fmt::format("{}; {}", readable(fault.what(), longest_message), consequence(stand_in)));
        }
        return stand_ins_.image(stand_in);
    }

    void warn(std::string warning) { document_.warnings.push_back(std::move(warning)); }

 private:
    std::shared_ptr<const Image> load(int index, const Wraps& wraps, Encoding encoding) {
        if (index < 0) throw PieceError("it has no PNG, JPEG or WebP image");
        const Bytes encoded = encoded_image(index);
        std::shared_ptr<const Image>& image = images_[{encoded.data(), wraps.u, wraps.v, encoding}];
        if (!image) {
            Image decoded = naming_image(index, [&] { return decode_image(encoded, budget_); });
            decoded.wrap_u = wraps.u;
            decoded.wrap_v = wraps.v;
            decoded.encoding = encoding;
            image = std::make_shared<const Image>(std::move(decoded));
        }
        return image;
    }

    /// Runs the decoding of an image, whose faults then name its file or, if it is embedded, what it is
    /// called.
    template <class Decode>
    Image naming_image(int index, Decode decode) {
        const Json& source = document_.at("images", index);
        const std::string uri = text_in(source, "uri");
        const bool is_embedded = uri.empty() || uri.starts_with("data:");
        const std::string name = is_embedded ? text_in(source, "name") : uri;
        return name.empty() ? decode() : naming(readable(name), decode);
    }

    Bytes encoded_image(int index) {
        const Json& source = document_.at("images", index);
        const int view = index_in(source, "bufferView");
        if (text_in(source, "uri").empty() != (view >= 0)) {
            throw PieceError(R"(it needs either a "uri" or a "bufferView")");
        }
        if (view >= 0) return buffer_view_bytes(document_, view);
        Content& content = contents_[index];
        if (!content) content = files_.read(source.at("uri").get_ref<const std::string&>());
        return *content;
    }

    Document& document_;
    ImportFiles& files_;
    ImportBudget& budget_;
    std::map<int, Content> contents_;  // by image; keeps their bytes, whose addresses identify images
    std::map<ImageKey, std::shared_ptr<const Image>> images_;
    std::set<std::string> unreadable_;  // images, and textures without one, as warnings call them
    StandIns stand_ins_;
};

/// Factors of pbrMetallicRoughness, KHR_materials_specular, KHR_materials_ior and KHR_materials_transmission.
void read_gloss(const Json& source, Material& material) {
    material.metalness = value_in(source, "pbrMetallicRoughness.metallicFactor", 1.0F);
    material.roughness = value_in(source, "pbrMetallicRoughness.roughnessFactor", 1.0F);
    material.specular = value_in(source, "extensions.KHR_materials_specular.specularFactor", 1.0F);
    material.specular_colour =
        vector_in(source, "extensions.KHR_materials_specular.specularColorFactor", glm::vec3(1.0F));
    material.ior = value_in(source, "extensions.KHR_materials_ior.ior", 1.5F);
    material.transmission =
        value_in(source, "extensions.KHR_materials_transmission.transmissionFactor", 0.0F);
}

void read_emission(const Json& source, const std::string& label, Material& material) {
    const double strength =
        value_in(source, "extensions.KHR_materials_emissive_strength.emissiveStrength", 1.0);
    material.emissive = glm::vec3(vector_in(source, "emissiveFactor", glm::dvec3(0.0)) * strength);
    if (!std::isfinite(std::max({material.emissive.r, material.emissive.g, material.emissive.b}))) {
        throw SceneError(fmt::format("{}: its emission is too large", label));
    }
}

/// KHR_materials_unlit: what is seen is the base colour, whatever the light. Such a surface emits it.
void show_unlit(Material& material) {
    material.emissive = glm::vec3(material.base_colour);
    material.emissive_texture = emits(material) ? material.base_colour_texture : nullptr;
    material.base_colour = glm::vec4(0.0F, 0.0F, 0.0F, material.base_colour.a);
}

/// Reads the textures of a material, and what coordinates they have. There are at most two kinds of these:
/// those of the first texture that is read, and the first others.
class TextureReader {
 public:
    TextureReader(ImageReader& images, std::string label) : images_(images), label_(std::move(label)) {}

    /// `is_second` becomes whether the texture has the second kind of coordinates.
    std::shared_ptr<const Image> read(const Json* use, Encoding encoding, StandIn stand_in, const char* name,
                                      bool& is_second) {
        std::shared_ptr<const Image> image = images_.read(use, encoding, stand_in);
        if (!image) return nullptr;
        const Coordinates coordinates = coordinates_of(*use);
        for (std::size_t i = 0; i < uses_.size(); ++i) {
            if (uses_[i].coordinates != coordinates) continue;
            is_second = i == 1;
            return image;
        }
        if (uses_.size() < 2) {
            is_second = uses_.size() == 1;
            uses_.push_back({name, coordinates});
            return image;
        }
        is_second = nearer_to(coordinates) == 1;
        images_.warn(
            fmt::format("{}: its {} is placed like its {}: two kinds of texture coordinates are read", label_,
                        name, uses_[is_second ? 1 : 0].name));
        return image;
    }

    [[nodiscard]] Coordinates first() const { return uses_.empty() ? Coordinates{} : uses_[0].coordinates; }
    [[nodiscard]] std::optional<Coordinates> second() const {
        return uses_.size() < 2 ? std::nullopt : std::optional(uses_[1].coordinates);
    }

 private:
    struct Use {
        const char* name;
        Coordinates coordinates;
    };

    /// The kind of the same set; of both or none, the second.
    [[nodiscard]] std::size_t nearer_to(const Coordinates& coordinates) const {
        const auto has_set = [&](std::size_t i) { return uses_[i].coordinates.set == coordinates.set; };
        return has_set(0) && !has_set(1) ? 0 : 1;
    }

    ImageReader& images_;
    std::string label_;
    std::vector<Use> uses_;
};

/// Normal and occlusion textures.
void read_bumps(const Json& source, TextureReader& textures, Material& material) {
    material.normal_texture = textures.read(find_member(source, "normalTexture"), Encoding::linear,
                                            StandIn::nothing, "normal texture", material.second_uvs.normal);
    material.normal_scale = value_in(source, "normalTexture.scale", 1.0F);
    material.occlusion_texture =
        textures.read(find_member(source, "occlusionTexture"), Encoding::linear, StandIn::nothing,
                      "occlusion texture", material.second_uvs.occlusion);
    material.occlusion_strength = value_in(source, "occlusionTexture.strength", 1.0F);
}

ReadMaterial read_material(const Json& source, const std::string& label, ImageReader& images) {
    Material material;
    TextureReader textures(images, label);
    material.name = text_in(source, "name");
    material.base_colour = vector_in(source, "pbrMetallicRoughness.baseColorFactor", glm::vec4(1.0F));
    bool is_second = false;  // never: this texture is the first
    material.base_colour_texture =
        textures.read(find_member(source, "pbrMetallicRoughness.baseColorTexture"), Encoding::srgb,
                      StandIn::checker, "base colour texture", is_second);
    read_emission(source, label, material);
    if (find_member(source, "extensions.KHR_materials_unlit")) {
        show_unlit(material);
    } else {
        read_gloss(source, material);
        if (emits(material)) {
            material.emissive_texture =
                textures.read(find_member(source, "emissiveTexture"), Encoding::srgb, StandIn::black,
                              "emissive texture", material.second_uvs.emissive);
        }
        material.metal_roughness_texture = textures.read(
            find_member(source, "pbrMetallicRoughness.metallicRoughnessTexture"), Encoding::linear,
            StandIn::nothing, "metallic-roughness texture", material.second_uvs.metal_roughness);
        read_bumps(source, textures, material);
    }
    material.double_sided = value_in(source, "doubleSided", false);
    material.alpha_mode = value_in(source, "alphaMode", AlphaMode::opaque);
    material.alpha_cutoff = value_in(source, "alphaCutoff", 0.5F);
    return {std::make_shared<const Material>(std::move(material)), textures.first(), textures.second()};
}

std::vector<bool> used_materials(const Document& document, const std::vector<bool>& used_meshes) {
    std::vector<bool> used(document.all("materials").size());
    for (std::size_t i = 0; i < used_meshes.size(); ++i) {
        for (const Json& primitive : document.all("meshes")[i].at("primitives")) {
            if (const int material = index_in(primitive, "material"); used_meshes[i] && material >= 0) {
                used[static_cast<std::size_t>(material)] = true;
            }
        }
    }
    return used;
}

}  // namespace

std::vector<ReadMaterial> read_materials(Document& document, const std::vector<bool>& used_meshes,
                                         ImportFiles& files, ImportBudget& budget, const Progress& progress) {
    ImageReader images(document, files, budget);
    const std::vector<bool> used = used_materials(document, used_meshes);
    std::vector<ReadMaterial> materials(used.size());
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (used[i]) {
            progress("reading materials and images", i, used.size());
            materials[i] = read_material(document.all("materials")[i], fmt::format("material {}", i), images);
        }
    }
    Material by_default;
    read_gloss(Json::object(), by_default);
    materials.push_back({std::make_shared<const Material>(std::move(by_default))});
    return materials;
}

}  // namespace candela::gltf
