#include "engine/import/export_materials.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <stb/stb_image_write.h>

#include <candela/scene/scene_error.hpp>
#include "engine/import/gltf_constants.hpp"
#include "engine/import/naming.hpp"
#include "engine/readable.hpp"

namespace candela::gltf {

namespace {

std::vector<std::byte> encode_png(const Image& image) {
    std::vector<std::byte> png;
    const auto store = [](void* context, void* data, int length) {
        const auto* const bytes = static_cast<const std::byte*>(data);
        static_cast<std::vector<std::byte>*>(context)->assign(bytes, bytes + length);
    };
    const auto width = static_cast<int>(image.width);
    const auto height = static_cast<int>(image.height);
    if (stbi_write_png_to_func(store, &png, width, height, 4, image.texels.data(), 4 * width) == 0) {
        throw SceneError("a texture cannot be encoded as PNG");
    }
    return png;
}

void check_base_colour(const glm::vec4& colour) {
    if (std::max({colour.r, colour.g, colour.b, colour.a}) > 1.0F) {
        throw SceneError("a channel of its base colour is above 1, which glTF does not allow");
    }
}

/// Metalness and roughness, and what differs from the defaults of the extensions.
void write_gloss(const Material& material, Json& json, Draft& draft) {
    json["pbrMetallicRoughness"]["metallicFactor"] = to_json(material.metalness);
    json["pbrMetallicRoughness"]["roughnessFactor"] = to_json(material.roughness);
    Json specular = Json::object();
    if (material.specular != 1.0F) specular["specularFactor"] = to_json(material.specular);
    if (material.specular_colour != glm::vec3(1.0F)) {
        specular["specularColorFactor"] = to_json(material.specular_colour);
    }
    if (!specular.empty()) {
        json["extensions"][specular_extension] = std::move(specular);
        draft.use_extension(specular_extension);
    }
    if (material.ior != 1.5F) {
        json["extensions"][ior_extension] = {{"ior", to_json(material.ior)}};
        draft.use_extension(ior_extension);
    }
    if (material.transmission > 0.0F) {
        json["extensions"][transmission_extension] = {{"transmissionFactor", to_json(material.transmission)}};
        draft.use_extension(transmission_extension);
    }
}

/// glTF's emissive factors are at most 1. Quotients and strength are written in double precision, so that
/// their product, rounded to a float, is the emission again.
void write_emission(const glm::vec3& emissive, Json& material, Draft& draft) {
    const double strength = std::max({emissive.r, emissive.g, emissive.b});
    if (strength <= 1.0) {
        material["emissiveFactor"] = to_json(emissive);
        return;
    }
    const glm::dvec3 factor = glm::dvec3(emissive) / strength;
    material["emissiveFactor"] = {factor.r, factor.g, factor.b};
    material["extensions"][emissive_strength_extension] = {{"emissiveStrength", strength}};
    draft.use_extension(emissive_strength_extension);
}

/// A textureInfo with a factor, unless that is the default of 1.
Json with_factor(Json info, const char* name, float factor) {
    if (factor != 1.0F) info[name] = to_json(factor);
    return info;
}

}  // namespace

std::size_t MaterialWriter::index_of(const std::shared_ptr<const Material>& material) {
    if (const auto found = materials_.find(material); found != materials_.end()) return found->second;
    Json json =
        naming(fmt::format("material \"{}\"", readable(material->name)), [&] { return describe(*material); });
    return materials_.emplace(material, draft_.add("materials", std::move(json))).first->second;
}

Json MaterialWriter::describe(const Material& material) {
    check_base_colour(material.base_colour);
    Json json = {{"pbrMetallicRoughness", {{"baseColorFactor", to_json(material.base_colour)}}}};
    const SecondUvUse& use = material.second_uvs;
    write_gloss(material, json, draft_);
    if (!material.name.empty()) json["name"] = to_json(material.name);
    if (material.base_colour_texture) {
        json["pbrMetallicRoughness"]["baseColorTexture"] = texture_info(material.base_colour_texture);
    }
    if (material.metal_roughness_texture) {
        json["pbrMetallicRoughness"]["metallicRoughnessTexture"] =
            texture_info(material.metal_roughness_texture, use.metal_roughness);
    }
    if (emits(material)) write_emission(material.emissive, json, draft_);
    if (material.emissive_texture) {
        json["emissiveTexture"] = texture_info(material.emissive_texture, use.emissive);
    }
    if (material.normal_texture) {
        json["normalTexture"] =
            with_factor(texture_info(material.normal_texture, use.normal), "scale", material.normal_scale);
    }
    if (material.occlusion_texture) {
        json["occlusionTexture"] = with_factor(texture_info(material.occlusion_texture, use.occlusion),
                                               "strength", material.occlusion_strength);
    }
    if (material.double_sided) json["doubleSided"] = true;
    if (material.alpha_mode != AlphaMode::opaque) json["alphaMode"] = material.alpha_mode;
    if (material.alpha_cutoff != Material{}.alpha_cutoff) {
        json["alphaCutoff"] = to_json(material.alpha_cutoff);
    }
    return json;
}

Json MaterialWriter::texture_info(const std::shared_ptr<const Image>& image, bool has_second_uvs) {
    auto found = textures_.find(image);
    if (found == textures_.end()) found = textures_.emplace(image, add_texture(*image)).first;
    Json info = {{"index", found->second}};
    if (has_second_uvs) info["texCoord"] = 1;
    return info;
}

std::size_t MaterialWriter::add_texture(const Image& image) {
    Json source = draft_.add_picture(encode_png(image), fmt::format("-{}.png", textures_.size()));
    source["mimeType"] = "image/png";
    const std::size_t index = draft_.add("images", std::move(source));
    return draft_.add("textures", {{"source", index}, {"sampler", sampler_of(image.wrap_u, image.wrap_v)}});
}

std::size_t MaterialWriter::sampler_of(Wrap u, Wrap v) {
    const auto found = samplers_.find({u, v});
    if (found != samplers_.end()) return found->second;
    const std::size_t index = draft_.add("samplers", {{"wrapS", u}, {"wrapT", v}});
    samplers_.emplace(std::pair(u, v), index);
    return index;
}

}  // namespace candela::gltf
