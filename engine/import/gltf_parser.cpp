#include "engine/import/gltf_parser.hpp"

#include <algorithm>
#include <limits>
#include <string_view>
#include <utility>

#include <tiny_gltf.h>

#include <candela/scene/scene_error.hpp>
#include "engine/import/gltf_extensions.hpp"

namespace candela::gltf {

namespace {

template <class To, class From, class Translate>
std::vector<To> translated(const std::vector<From>& source, Translate translate) {
    std::vector<To> result;
    result.reserve(source.size());
    std::ranges::transform(source, std::back_inserter(result), translate);
    return result;
}

const tinygltf::Value* find(const tinygltf::ExtensionMap& extensions, const char* name) {
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

double number_of(const tinygltf::Value& object, const char* member, double otherwise) {
    return object.Has(member) ? object.Get(member).GetNumberAsDouble() : otherwise;
}

template <class Vector>
Vector vector_of(const tinygltf::Value& object, const char* member, Vector otherwise) {
    for (int i = 0; i < Vector::length() && object.Has(member); ++i) {
        otherwise[i] = static_cast<float>(object.Get(member).Get(i).GetNumberAsDouble());
    }
    return otherwise;
}

int components_of(int type) {
    switch (type) {
        case TINYGLTF_TYPE_SCALAR:
            return 1;
        case TINYGLTF_TYPE_VEC2:
            return 2;
        case TINYGLTF_TYPE_VEC3:
            return 3;
        case TINYGLTF_TYPE_VEC4:
            return 4;
        default:
            return 0;
    }
}

BufferView translate(const tinygltf::BufferView& source) {
    return {source.buffer, source.byteOffset, source.byteLength, source.byteStride};
}

/// `no_view` stands for an accessor without a buffer view: see write_defaults.
Accessor translate(const tinygltf::Accessor& source, int no_view) {
    Accessor accessor;
    accessor.source = {source.bufferView == no_view ? -1 : source.bufferView, source.byteOffset,
                       source.componentType};
    accessor.components = components_of(source.type);
    accessor.count = source.count;
    accessor.normalized = source.normalized;
    if (const auto& sparse = source.sparse; sparse.isSparse) {
        accessor.sparse = {static_cast<std::size_t>(sparse.count),
                           {sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset),
                            sparse.indices.componentType},
                           {sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset),
                            source.componentType}};
    }
    return accessor;
}

TextureUse translate(const tinygltf::TextureInfo& source) {
    TextureUse use{.texture = source.index, .coordinate_set = source.texCoord};
    if (const tinygltf::Value* const transform = find(source.extensions, texture_transform_extension)) {
        use.coordinate_set = static_cast<int>(number_of(*transform, "texCoord", use.coordinate_set));
        use.scale = vector_of(*transform, "scale", use.scale);
        use.offset = vector_of(*transform, "offset", use.offset);
        use.rotation = number_of(*transform, "rotation", 0.0);
    }
    return use;
}

MaterialSource translate(const tinygltf::Material& source) {
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    MaterialSource material;
    material.name = source.name;
    std::ranges::copy(pbr.baseColorFactor, material.base_colour.begin());
    material.base_colour_texture = translate(pbr.baseColorTexture);
    std::ranges::copy(source.emissiveFactor, material.emissive.begin());
    if (const tinygltf::Value* const strength = find(source.extensions, emissive_strength_extension)) {
        material.emissive_strength = number_of(*strength, "emissiveStrength", 1.0);
    }
    material.emissive_texture = translate(source.emissiveTexture);
    material.alpha_mode = source.alphaMode;
    material.alpha_cutoff = source.alphaCutoff;
    material.double_sided = source.doubleSided;
    material.unlit = find(source.extensions, unlit_extension) != nullptr;
    return material;
}

PrimitiveSource translate(const tinygltf::Primitive& source) {
    return {source.attributes, source.indices, source.material, source.mode, !source.targets.empty()};
}

CameraSource translate(const tinygltf::Camera& source) {
    if (source.type == "perspective") {
        return {source.name,
                true,
                source.perspective.yfov,
                0.0,
                source.perspective.znear,
                source.perspective.zfar};
    }
    const tinygltf::OrthographicCamera& lens = source.orthographic;
    return {source.name, false, 0.0, lens.ymag, lens.znear, lens.zfar};
}

LightSource translate(const tinygltf::Light& source) {
    const tinygltf::Value* const extension = find(source.extensions, light_extension);
    const bool casts_shadow =
        !extension || !extension->Has("castsShadow") || extension->Get("castsShadow").Get<bool>();
    return {source.name,
            source.type,
            source.color,
            source.intensity,
            source.range,
            source.spot.innerConeAngle,
            source.spot.outerConeAngle,
            casts_shadow};
}

EnvironmentSource translate_environment(const tinygltf::Value& source) {
    EnvironmentSource environment;
    environment.radiance = vector_of(source, "radiance", environment.radiance);
    environment.rotation = static_cast<float>(number_of(source, "rotation", 0.0));
    environment.buffer_view = static_cast<int>(number_of(source, "bufferView", -1.0));
    if (source.Has("uri")) {
        environment.uri = source.Get("uri").Get<std::string>();
    }
    if (source.Has("name")) {
        environment.name = source.Get("name").Get<std::string>();
    }
    return environment;
}

SceneSource translate(const tinygltf::Scene& source) {
    SceneSource scene{.nodes = source.nodes, .environment = {}};
    if (const tinygltf::Value* const environment = find(source.extensions, environment_extension)) {
        scene.environment = translate_environment(*environment);
    }
    return scene;
}

Model translate(const tinygltf::Model& source, int no_view) {
    const auto same = [](const auto& each) { return translate(each); };
    Model model;
    model.buffer_views = translated<BufferView>(source.bufferViews, same);
    model.accessors = translated<Accessor>(
        source.accessors, [no_view](const tinygltf::Accessor& each) { return translate(each, no_view); });
    model.samplers = translated<Sampler>(source.samplers, [](const tinygltf::Sampler& each) {
        return Sampler{each.wrapS, each.wrapT};
    });
    model.textures = translated<Texture>(source.textures, [](const tinygltf::Texture& each) {
        return Texture{each.sampler, each.source};
    });
    model.materials = translated<MaterialSource>(source.materials, same);
    model.meshes = translated<MeshSource>(source.meshes, [same](const tinygltf::Mesh& each) {
        return MeshSource{each.name, translated<PrimitiveSource>(each.primitives, same)};
    });
    model.cameras = translated<CameraSource>(source.cameras, same);
    model.lights = translated<LightSource>(source.lights, same);
    model.scenes = translated<SceneSource>(source.scenes, same);
    model.default_scene = source.defaultScene;
    model.buffer_views.pop_back();
    return model;
}

/// Adds two defaults that TinyGLTF 2.5 does not handle: byte offsets that a sparse accessor leaves out, and
/// the buffer view of an accessor without one (TinyGLTF then writes out of bounds). Such accessors get an
/// extra buffer view after those of the file; its index is returned.
std::size_t write_defaults(Json& document) {
    Json& views = document["bufferViews"];
    views.push_back({{"buffer", 0}, {"byteLength", 1}});
    const std::size_t none = views.size() - 1;
    const auto write_default = [](Json& object, const char* member, std::size_t value) {
        if (!object.contains(member)) {
            object[member] = value;
        }
    };
    if (!document.contains("accessors")) {
        return none;
    }
    for (Json& accessor : document["accessors"].items()) {
        write_default(accessor, "bufferView", none);
        if (accessor.contains("sparse")) {
            write_default(accessor["sparse"]["indices"], "byteOffset", 0);
            write_default(accessor["sparse"]["values"], "byteOffset", 0);
        }
    }
    return none;
}

/// Removes extras and extensions that are not supported, for each of which TinyGLTF would make objects.
void remove_unread(Json& value) {
    value.erase("extras");
    if (value.contains("extensions")) {
        value["extensions"].erase_members([](const JsonMember& each) { return !is_supported(each.name); });
    }
    for (JsonMember& member : value.members()) {
        remove_unread(member.value);
    }
    for (Json& item : value.items()) {
        remove_unread(item);
    }
}

/// TinyGLTF's messages, one per line, as one line.
std::string joined(std::string messages) {
    std::ranges::replace(messages, '\n', ' ');
    messages.erase(messages.find_last_not_of(" .") + 1);
    return messages;
}

}  // namespace

std::uint64_t parsing_memory(const Json& document) {
    const auto size_of = [](const Json& object, std::string_view list) {
        const Json* const items = object.find(list);
        return items ? std::uint64_t{items->size()} : 0;
    };
    std::uint64_t bytes =
        size_of(document, "accessors") * (sizeof(tinygltf::Accessor) + sizeof(Accessor)) +
        size_of(document, "bufferViews") * (sizeof(tinygltf::BufferView) + sizeof(BufferView)) +
        size_of(document, "cameras") * (sizeof(tinygltf::Camera) + sizeof(CameraSource)) +
        size_of(document, "images") * sizeof(EncodedImage) +
        size_of(document, "materials") * (sizeof(tinygltf::Material) + sizeof(MaterialSource)) +
        size_of(document, "meshes") * (sizeof(tinygltf::Mesh) + sizeof(MeshSource)) +
        size_of(document, "samplers") * (sizeof(tinygltf::Sampler) + sizeof(Sampler)) +
        size_of(document, "scenes") * (sizeof(tinygltf::Scene) + sizeof(SceneSource)) +
        size_of(document, "textures") * (sizeof(tinygltf::Texture) + sizeof(Texture));
    if (const Json* const lights = document.find_path("extensions/KHR_lights_punctual")) {
        bytes += size_of(*lights, "lights") * (sizeof(tinygltf::Light) + sizeof(LightSource));
    }
    if (const Json* const meshes = document.find("meshes")) {
        for (const Json& mesh : meshes->items()) {
            bytes += size_of(mesh, "primitives") * (sizeof(tinygltf::Primitive) + sizeof(PrimitiveSource));
        }
    }
    return bytes;
}

Model parse_model(Json document) {
    for (const char* member : {"buffers", "images", "nodes", "animations", "skins"}) {
        document.erase(member);
    }
    remove_unread(document);
    const std::size_t no_view = write_defaults(document);
    const std::string text = document.dump();
    if (text.size() > std::numeric_limits<unsigned int>::max()) {
        throw SceneError("its JSON exceeds 4 GiB");
    }

    tinygltf::Model model;
    std::string errors;
    std::string warnings;
    tinygltf::TinyGLTF parser;
    const bool parsed = parser.LoadASCIIFromString(&model, &errors, &warnings, text.data(),
                                                   static_cast<unsigned int>(text.size()), {});
    if (!parsed || !errors.empty()) {
        throw SceneError(errors.empty() ? "it is not valid glTF" : joined(errors));
    }
    return translate(model, static_cast<int>(no_view));
}

std::optional<std::vector<unsigned char>> decode_data_uri(const std::string& uri) {
    std::vector<unsigned char> bytes;
    std::string media_type;
    const bool decoded = tinygltf::DecodeDataURI(&bytes, media_type, uri, 0, false);
    return decoded ? std::optional(std::move(bytes)) : std::nullopt;
}

}  // namespace candela::gltf
