#include "engine/import/gltf_schema.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <candela/scene/scene_error.hpp>
#include "engine/import/gltf_constants.hpp"
#include "engine/readable.hpp"

namespace candela::gltf {

namespace {

/// What is wrong with a value, worded to follow the value's name in a message; nullopt if it is valid.
using Problem = std::optional<std::string>;
using Check = std::function<Problem(const Json& value, const Json& document)>;

struct Rule {
    /// Members joined by dots; `[]` means each item of an array, `{}` each member of an object.
    std::string path;
    Check check;
};

struct Range {
    double lowest = -std::numeric_limits<float>::max();
    double highest = std::numeric_limits<float>::max();
};

constexpr Range any{};
constexpr Range unit{.lowest = 0.0, .highest = 1.0};
constexpr Range not_negative{.lowest = 0.0};
constexpr Range positive{.lowest = std::numeric_limits<float>::min()};
// Radians. Less than pi by enough that tan(fov / 2) stays finite in single precision.
constexpr Range field_of_view{.lowest = std::numeric_limits<float>::min(), .highest = 3.1415};
// Radians. Up to pi/2, with a margin because some files round it up.
constexpr Range inner_cone{.lowest = 0.0, .highest = 1.570797};
constexpr Range outer_cone{.lowest = std::numeric_limits<float>::min(), .highest = 1.570797};

constexpr std::uint64_t any_size = std::numeric_limits<std::int64_t>::max();
constexpr std::uint64_t most_elements = std::numeric_limits<std::uint32_t>::max();

Problem check_number(const Json& value, const Range& range) {
    if (!value.is_number()) return "is not a number";
    const auto number = value.number();
    if (number < range.lowest || number > range.highest) {
        return fmt::format("is {}, which is out of range", number);
    }
    return {};
}

Check number(Range range) {
    return [range](const Json& value, const Json&) { return check_number(value, range); };
}

/// KHR_materials_ior: at least 1, or 0.
Check index_of_refraction() {
    return [](const Json& value, const Json&) {
        const bool is_0 = value.is_number() && value.number() == 0.0;
        return is_0 ? Problem{} : check_number(value, {.lowest = 1.0});
    };
}

Check numbers(std::size_t length, Range range) {
    return [length, range](const Json& value, const Json&) -> Problem {
        if (!value.is_array() || value.size() != length) return fmt::format("is not {} numbers", length);
        for (const Json& item : value.items()) {
            if (Problem error = check_number(item, range)) return "holds a member that " + *error;
        }
        return {};
    };
}

Check whole(std::uint64_t lowest, std::uint64_t highest) {
    return [lowest, highest](const Json& value, const Json&) -> Problem {
        if (!value.is_whole()) return "is not a whole number";
        if (!value.is_not_negative() || value.whole<std::uint64_t>() < lowest ||
            value.whole<std::uint64_t>() > highest) {
            return fmt::format("is {}, which is out of range", value.dump());
        }
        return {};
    };
}

Check stride() {
    return [](const Json& value, const Json& document) -> Problem {
        if (Problem error = whole(4, 252)(value, document)) return error;
        if (value.whole<int>() % 4 != 0) return fmt::format("is {}, not a multiple of 4", value.whole<int>());
        return {};
    };
}

Check text() {
    return [](const Json& value, const Json&) { return value.is_string() ? Problem{} : "is not a string"; };
}

Check flag() {
    return [](const Json& value, const Json&) {
        return value.is_boolean() ? Problem{} : "is not true or false";
    };
}

Check has(std::initializer_list<const char*> members) {
    return [required = std::vector<const char*>(members)](const Json& value, const Json&) -> Problem {
        if (!value.is_object()) return "is not an object";
        for (const char* member : required) {
            if (!value.contains(member)) return fmt::format("has no \"{}\"", member);
        }
        return {};
    };
}

Check not_empty(const char* plural) {
    return [plural](const Json& value, const Json&) {
        return value.empty() ? fmt::format("has no {}", plural) : Problem{};
    };
}

/// Checks for a member that is named like the value of "type", if that is one of `kinds`.
Check has_its_kind(std::vector<std::string_view> kinds) {
    return [kinds = std::move(kinds)](const Json& value, const Json&) -> Problem {
        const std::string& kind = value.at("type").text();
        const bool needed = std::ranges::find(kinds, kind) != kinds.end();
        return needed && !value.contains(kind) ? fmt::format("has no \"{}\"", kind) : Problem{};
    };
}

Check version() {
    return [](const Json& value, const Json&) -> Problem {
        if (!value.is_string()) return "is not a string";
        const auto& number = value.text();
        return number.starts_with("2.") ? Problem{}
                                        : fmt::format("is \"{}\"; only 2.0 is read", readable(number));
    };
}

Check one_of(std::vector<std::string_view> names) {
    return [names = std::move(names)](const Json& value, const Json&) -> Problem {
        if (!value.is_string()) return "is not a string";
        const auto& name = value.text();
        const bool known = std::ranges::find(names, name) != names.end();
        return known ? Problem{}
                     : fmt::format("is \"{}\", not one of {}", readable(name), fmt::join(names, ", "));
    };
}

/// Checks for an index into the array at `path` of the document, which messages call `plural`.
Check index_into(const char* path, const char* plural) {
    return [path, plural](const Json& value, const Json& document) -> Problem {
        if (!value.is_whole()) return "is not an index";
        const Json* const list = document.find_path(path);
        const std::size_t size = list ? list->size() : 0;
        if (!value.is_not_negative() || value.whole<std::uint64_t>() >= size) {
            return fmt::format("is {}, but there are {} {}", value.dump(), size, plural);
        }
        return {};
    };
}

/// The rules of a textureInfo, a texture with the coordinates that are used for it.
void add_texture_rules(std::vector<Rule>& rules, const std::string& path, const Check& texture) {
    const std::string transform = path + ".extensions.KHR_texture_transform";
    const Check set = whole(0, std::numeric_limits<int>::max());
    rules.push_back({path, has({"index"})});
    rules.push_back({path + ".index", texture});
    rules.push_back({path + ".texCoord", set});
    rules.push_back({transform + ".offset", numbers(2, any)});
    rules.push_back({transform + ".rotation", number(any)});
    rules.push_back({transform + ".scale", numbers(2, any)});
    rules.push_back({transform + ".texCoord", set});
}

std::vector<Rule> rules() {
    const Check accessor = index_into("accessors", "accessors");
    const Check buffer = index_into("buffers", "buffers");
    const Check buffer_view = index_into("bufferViews", "buffer views");
    const Check camera = index_into("cameras", "cameras");
    const Check image = index_into("images", "images");
    const Check light = index_into("extensions/KHR_lights_punctual/lights", "lights");
    const Check material = index_into("materials", "materials");
    const Check mesh = index_into("meshes", "meshes");
    const Check node = index_into("nodes", "nodes");
    const Check sampler = index_into("samplers", "samplers");
    const Check scene = index_into("scenes", "scenes");
    const Check skin = index_into("skins", "skins");
    const Check texture = index_into("textures", "textures");
    const Check size = whole(0, any_size);
    const Check index = whole(0, std::numeric_limits<int>::max());

    const std::string meshopt = "bufferViews.[].extensions.EXT_meshopt_compression";
    const std::string draco = "meshes.[].primitives.[].extensions.KHR_draco_mesh_compression";

    std::vector<Rule> all = {
        {"asset", has({"version"})},
        {"asset.version", version()},
        {"extensionsUsed.[]", text()},
        {"extensionsRequired.[]", text()},

        {"buffers.[]", has({"byteLength"})},
        {"buffers.[].byteLength", whole(1, any_size)},
        {"buffers.[].uri", text()},
        {"bufferViews.[]", has({"buffer", "byteLength"})},
        {"bufferViews.[].buffer", buffer},
        {"bufferViews.[].byteOffset", size},
        {"bufferViews.[].byteLength", whole(1, any_size)},
        {"bufferViews.[].byteStride", stride()},
        {"buffers.[].extensions.EXT_meshopt_compression.fallback", flag()},
        {meshopt, has({"buffer", "byteLength", "byteStride", "count", "mode"})},
        {meshopt + ".buffer", buffer},
        {meshopt + ".byteOffset", size},
        {meshopt + ".byteLength", whole(1, any_size)},
        {meshopt + ".byteStride", whole(1, 256)},
        {meshopt + ".count", whole(1, most_elements)},
        {meshopt + ".mode", one_of({"ATTRIBUTES", "TRIANGLES", "INDICES"})},
        {meshopt + ".filter", one_of({"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"})},
        {"accessors.[]", has({"componentType", "count", "type"})},
        {"accessors.[].bufferView", buffer_view},
        {"accessors.[].byteOffset", size},
        {"accessors.[].componentType", whole(signed_byte, floating_point)},
        {"accessors.[].count", whole(1, most_elements)},
        {"accessors.[].type", one_of({"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"})},
        {"accessors.[].normalized", flag()},
        {"accessors.[].sparse", has({"count", "indices", "values"})},
        {"accessors.[].sparse.count", whole(1, std::numeric_limits<int>::max())},
        {"accessors.[].sparse.indices", has({"bufferView", "componentType"})},
        {"accessors.[].sparse.indices.bufferView", buffer_view},
        {"accessors.[].sparse.indices.byteOffset", index},
        {"accessors.[].sparse.indices.componentType", index},
        {"accessors.[].sparse.values", has({"bufferView"})},
        {"accessors.[].sparse.values.bufferView", buffer_view},
        {"accessors.[].sparse.values.byteOffset", index},

        {"images.[].name", text()},
        {"images.[].uri", text()},
        {"images.[].bufferView", buffer_view},
        {"samplers.[].wrapS", index},
        {"samplers.[].wrapT", index},
        {"textures.[].sampler", sampler},
        {"textures.[].source", image},
        {"textures.[].extensions.EXT_texture_webp.source", image},
        {"textures.[].extensions.KHR_texture_basisu.source", image},
        {"materials.[].name", text()},
        {"materials.[].doubleSided", flag()},
        {"materials.[].alphaMode", one_of({"OPAQUE", "MASK", "BLEND"})},
        {"materials.[].alphaCutoff", number(not_negative)},
        {"materials.[].emissiveFactor", numbers(3, not_negative)},
        {"materials.[].normalTexture.scale", number(any)},
        {"materials.[].occlusionTexture.strength", number(unit)},
        {"materials.[].pbrMetallicRoughness.baseColorFactor", numbers(4, unit)},
        {"materials.[].pbrMetallicRoughness.metallicFactor", number(unit)},
        {"materials.[].pbrMetallicRoughness.roughnessFactor", number(unit)},
        {"materials.[].extensions.KHR_materials_emissive_strength.emissiveStrength", number(not_negative)},
        {"materials.[].extensions.KHR_materials_ior.ior", index_of_refraction()},
        {"materials.[].extensions.KHR_materials_transmission.transmissionFactor", number(unit)},
        {"materials.[].extensions.KHR_materials_specular.specularFactor", number(unit)},
        {"materials.[].extensions.KHR_materials_specular.specularColorFactor", numbers(3, not_negative)},

        {"meshes.[]", has({"primitives"})},
        {"meshes.[].name", text()},
        {"meshes.[].primitives.[]", has({"attributes"})},
        {"meshes.[].primitives.[].attributes.{}", accessor},
        {"meshes.[].primitives.[].indices", accessor},
        {"meshes.[].primitives.[].material", material},
        {"meshes.[].primitives.[].mode", whole(0, 6)},
        {"meshes.[].primitives.[].targets.[].{}", accessor},
        {"meshes.[].weights.[]", number(any)},

        {draco, has({"bufferView", "attributes"})},
        {draco + ".bufferView", buffer_view},
        {draco + ".attributes.{}", whole(0, most_elements)},

        {"cameras.[]", has({"type"})},
        {"cameras.[].name", text()},
        {"cameras.[].type", one_of({"perspective", "orthographic"})},
        {"cameras.[]", has_its_kind({"perspective", "orthographic"})},
        {"cameras.[].perspective", has({"yfov", "znear"})},
        {"cameras.[].perspective.yfov", number(field_of_view)},
        {"cameras.[].perspective.znear", number(positive)},
        {"cameras.[].perspective.zfar", number(positive)},
        {"cameras.[].orthographic", has({"xmag", "ymag", "znear", "zfar"})},
        {"cameras.[].orthographic.ymag", number(positive)},
        {"cameras.[].orthographic.znear", number(not_negative)},
        {"cameras.[].orthographic.zfar", number(positive)},

        {"extensions.KHR_lights_punctual", has({"lights"})},
        {"extensions.KHR_lights_punctual.lights.[]", has({"type"})},
        {"extensions.KHR_lights_punctual.lights.[].name", text()},
        {"extensions.KHR_lights_punctual.lights.[].type", text()},
        {"extensions.KHR_lights_punctual.lights.[]", has_its_kind({"spot"})},
        {"extensions.KHR_lights_punctual.lights.[].color", numbers(3, unit)},
        {"extensions.KHR_lights_punctual.lights.[].intensity", number(not_negative)},
        {"extensions.KHR_lights_punctual.lights.[].range", number(positive)},
        {"extensions.KHR_lights_punctual.lights.[].spot.innerConeAngle", number(inner_cone)},
        {"extensions.KHR_lights_punctual.lights.[].spot.outerConeAngle", number(outer_cone)},

        {"extensions.KHR_lights_punctual.lights.[].extensions.CANDELA_light.castsShadow", flag()},

        {"nodes.[].name", text()},
        {"nodes.[].mesh", mesh},
        {"nodes.[].skin", skin},
        {"nodes.[].weights.[]", number(any)},
        {"nodes.[].camera", camera},
        {"nodes.[].children.[]", node},
        {"nodes.[].translation", numbers(3, any)},
        {"nodes.[].rotation", numbers(4, any)},
        {"nodes.[].scale", numbers(3, any)},
        {"nodes.[].matrix", numbers(16, any)},
        {"nodes.[].extensions.KHR_lights_punctual", has({"light"})},
        {"nodes.[].extensions.KHR_lights_punctual.light", light},
        {"nodes.[].extensions.EXT_mesh_gpu_instancing", has({"attributes"})},
        {"nodes.[].extensions.EXT_mesh_gpu_instancing.attributes.{}", accessor},
        {"skins.[]", has({"joints"})},
        {"skins.[].joints", not_empty("joints")},
        {"skins.[].joints.[]", node},
        {"skins.[].inverseBindMatrices", accessor},
        {"animations.[]", has({"channels", "samplers"})},
        {"animations.[].name", text()},
        {"animations.[].samplers.[]", has({"input", "output"})},
        {"animations.[].samplers.[].input", accessor},
        {"animations.[].samplers.[].output", accessor},
        {"animations.[].samplers.[].interpolation", one_of({"STEP", "LINEAR", "CUBICSPLINE"})},
        {"animations.[].channels.[]", has({"sampler", "target"})},
        {"animations.[].channels.[].sampler", index},
        {"animations.[].channels.[].target", has({"path"})},
        {"animations.[].channels.[].target.node", node},
        {"animations.[].channels.[].target.path", text()},
        {"scenes.[].nodes.[]", node},
        {"scenes.[].extensions.CANDELA_environment.radiance", numbers(3, not_negative)},
        {"scenes.[].extensions.CANDELA_environment.bufferView", buffer_view},
        {"scenes.[].extensions.CANDELA_environment.name", text()},
        {"scenes.[].extensions.CANDELA_environment.rotation", number(any)},
        {"scenes.[].extensions.CANDELA_environment.uri", text()},
        {"scene", scene},
    };
    for (const char* use :
         {"pbrMetallicRoughness.baseColorTexture", "pbrMetallicRoughness.metallicRoughnessTexture",
          "normalTexture", "occlusionTexture", "emissiveTexture"}) {
        add_texture_rules(all, fmt::format("materials.[].{}", use), texture);
    }
    return all;
}

/// Where a value is in the document. Names are made only for messages: there may be millions of values.
struct Place {
    const Place* parent = nullptr;  // null for the document
    std::string_view member{};      // empty for an item of an array
    std::size_t item = 0;

    [[nodiscard]] std::string name() const {
        if (!parent) return {};
        const std::string before = parent->name();
        if (member.empty()) return fmt::format("{}[{}]", before, item);
        return before.empty() ? readable(member) : fmt::format("{}.{}", before, readable(member));
    }
};

/// Applies the rule's check to each value that `path`, the rest of the rule's path, leads to from `value`.
void apply(const Rule& rule, std::string_view path, const Json& value, const Place& place,
           const Json& document) {
    if (path.empty()) {
        if (const Problem error = rule.check(value, document)) throw SceneError(place.name() + ' ' + *error);
        return;
    }
    const std::size_t dot = path.find('.');
    const std::string_view step = path.substr(0, dot);
    const std::string_view rest = dot == std::string_view::npos ? "" : path.substr(dot + 1);

    const bool items = step == "[]";
    if (items != value.is_array() || (!items && !value.is_object())) {
        throw SceneError(fmt::format("{} is not an {}", place.name(), items ? "array" : "object"));
    }
    if (items) {
        for (std::size_t i = 0; i < value.size(); ++i) {
            apply(rule, rest, value[i], {.parent = &place, .item = i}, document);
        }
    } else if (step == "{}") {
        for (const auto& [key, member] : value.members()) {
            apply(rule, rest, member, {.parent = &place, .member = key}, document);
        }
    } else if (const Json* const member = value.find(step)) {
        apply(rule, rest, *member, {.parent = &place, .member = step}, document);
    }
}

}  // namespace

void check_schema(const Json& document) {
    if (!document.is_object()) throw SceneError("the document is not a JSON object");
    if (!document.contains("asset")) throw SceneError("it has no \"asset\", so it is not glTF 2.0");
    for (const Rule& rule : rules()) {
        apply(rule, rule.path, document, Place{}, document);
    }
}

}  // namespace candela::gltf
