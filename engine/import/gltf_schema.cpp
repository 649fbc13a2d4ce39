#include "engine/import/gltf_schema.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
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
    /// Members joined by dots, or by `|` where one rule holds for several; `[]` means each item of an array,
    /// `{}` each member of an object.
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

constexpr std::int64_t any_size = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t most_elements = std::numeric_limits<std::uint32_t>::max();

Problem check_number(const Json& value, const Range& range) {
    if (!value.is_number()) return "is not a number";
    const auto number = value.get<double>();
    if (number < range.lowest || number > range.highest) {
        return fmt::format("is {}, which is out of range", number);
    }
    return {};
}

Check number(Range range) {
    return [range](const Json& value, const Json&) { return check_number(value, range); };
}

/// KHR_materials_ior: at least 1, or 0.
Problem index_of_refraction(const Json& value, const Json& /*document*/) {
    return value == 0.0 ? Problem{} : check_number(value, {.lowest = 1.0});
}

Check numbers(std::size_t length, Range range) {
    return [length, range](const Json& value, const Json&) -> Problem {
        if (!value.is_array() || value.size() != length) return fmt::format("is not {} numbers", length);
        for (const Json& item : value) {
            if (Problem error = check_number(item, range)) return "holds a member that " + *error;
        }
        return {};
    };
}

/// `lowest` is not negative. Numbers beyond 63 bits become negative ones.
Check whole(std::int64_t lowest, std::int64_t highest) {
    return [lowest, highest](const Json& value, const Json&) -> Problem {
        if (!value.is_number_integer()) return "is not a whole number";
        const auto number = value.get<std::int64_t>();
        const bool fits = number >= lowest && number <= highest;
        return fits ? Problem{} : fmt::format("is {}, which is out of range", value.dump());
    };
}

Problem stride(const Json& value, const Json& document) {
    if (Problem error = whole(4, 252)(value, document)) return error;
    return value.get<int>() % 4 == 0 ? Problem{} : fmt::format("is {}, not a multiple of 4", value.dump());
}

Problem text(const Json& value, const Json& /*document*/) {
    return value.is_string() ? Problem{} : "is not a string";
}

Problem flag(const Json& value, const Json& /*document*/) {
    return value.is_boolean() ? Problem{} : "is not true or false";
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
        const auto kind = value.at("type").get<std::string>();
        const bool needed = std::ranges::find(kinds, kind) != kinds.end();
        return needed && !value.contains(kind) ? fmt::format("has no \"{}\"", kind) : Problem{};
    };
}

Problem version(const Json& value, const Json& /*document*/) {
    const bool is_read = value.is_string() && value.get<std::string>().starts_with("2.");
    return is_read ? Problem{} : fmt::format("is {}; only 2.0 is read", readable(value.dump()));
}

Check one_of(const Json& values) {
    return [values](const Json& value, const Json&) -> Problem {
        if (std::ranges::find(values, value) != values.end()) return {};
        return fmt::format("is {}, not one of {}", readable(value.dump()), values.dump());
    };
}

/// Checks for an index into the array at `path` of the document, which messages call `plural`.
Check index_into(const char* path, const char* plural) {
    return [path, plural](const Json& value, const Json& document) -> Problem {
        if (!value.is_number_integer()) return "is not an index";
        const std::size_t size = list_in(document, path).size();
        const auto index = value.get<std::int64_t>();
        const bool fits = index >= 0 && static_cast<std::size_t>(index) < size;
        return fits ? Problem{} : fmt::format("is {}, but there are {} {}", value.dump(), size, plural);
    };
}

Check index_into(const char* list) {
    return index_into(list, list);
}

std::vector<Rule> rules() {
    const Check accessor = index_into("accessors");
    const Check buffer = index_into("buffers");
    const Check buffer_view = index_into("bufferViews", "buffer views");
    const Check image = index_into("images");
    const Check node = index_into("nodes");
    const Check texture = index_into("textures");
    const Check index = whole(0, std::numeric_limits<int>::max());

    const std::string meshopt = "bufferViews.[].extensions.EXT_meshopt_compression";
    const std::string draco = "meshes.[].primitives.[].extensions.KHR_draco_mesh_compression";
    const std::string lights = "extensions.KHR_lights_punctual.lights.[]";
    const std::string environment = "scenes.[].extensions.CANDELA_environment";

    std::vector<Rule> all = {
        {"asset", has({"version"})},
        {"asset.version", version},
        {"extensionsUsed|extensionsRequired.[]", text},
        {"images|materials|meshes|cameras|nodes|animations.[].name", text},
        {"buffers|images.[].uri", text},

        {"buffers.[]", has({"byteLength"})},
        {"bufferViews.[]", has({"buffer", "byteLength"})},
        {meshopt, has({"buffer", "byteLength", "byteStride", "count", "mode"})},
        {"bufferViews.[].buffer", buffer},
        {meshopt + ".buffer", buffer},
        {"bufferViews|accessors.[].byteOffset", whole(0, any_size)},
        {meshopt + ".byteOffset", whole(0, any_size)},
        {"buffers|bufferViews.[].byteLength", whole(1, any_size)},
        {meshopt + ".byteLength", whole(1, any_size)},
        {"bufferViews.[].byteStride", stride},
        {"buffers.[].extensions.EXT_meshopt_compression.fallback", flag},
        {meshopt + ".byteStride", whole(1, 256)},
        {meshopt + ".count", whole(1, most_elements)},
        {meshopt + ".mode", one_of({"ATTRIBUTES", "TRIANGLES", "INDICES"})},
        {meshopt + ".filter", one_of({"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"})},
        {"accessors.[]", has({"componentType", "count", "type"})},
        {"accessors|images.[].bufferView", buffer_view},
        {"accessors.[].componentType", whole(signed_byte, floating_point)},
        {"accessors.[].count", whole(1, most_elements)},
        {"accessors.[].type", one_of({"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"})},
        {"accessors.[].normalized", flag},
        {"accessors.[].sparse", has({"count", "indices", "values"})},
        {"accessors.[].sparse.count", whole(1, std::numeric_limits<int>::max())},
        {"accessors.[].sparse.indices", has({"bufferView", "componentType"})},
        {"accessors.[].sparse.values", has({"bufferView"})},
        {"accessors.[].sparse.indices|values.bufferView", buffer_view},
        {"accessors.[].sparse.indices|values.byteOffset", index},
        {"accessors.[].sparse.indices.componentType", index},

        {"samplers.[].wrapS|wrapT", one_of({Wrap::repeat, Wrap::clamp_to_edge, Wrap::mirrored_repeat})},
        {"textures.[].sampler", index_into("samplers")},
        {"textures.[].source", image},
        {"textures.[].extensions.EXT_texture_webp|KHR_texture_basisu.source", image},
        {"materials.[].doubleSided", flag},
        {"materials.[].alphaMode", one_of({AlphaMode::opaque, AlphaMode::mask, AlphaMode::blend})},
        {"materials.[].alphaCutoff", number(not_negative)},
        {"materials.[].emissiveFactor", numbers(3, not_negative)},
        {"materials.[].normalTexture.scale", number(any)},
        {"materials.[].occlusionTexture.strength", number(unit)},
        {"materials.[].pbrMetallicRoughness.baseColorFactor", numbers(4, unit)},
        {"materials.[].pbrMetallicRoughness.metallicFactor|roughnessFactor", number(unit)},
        {"materials.[].extensions.KHR_materials_emissive_strength.emissiveStrength", number(not_negative)},
        {"materials.[].extensions.KHR_materials_ior.ior", index_of_refraction},
        {"materials.[].extensions.KHR_materials_transmission.transmissionFactor", number(unit)},
        {"materials.[].extensions.KHR_materials_specular.specularFactor", number(unit)},
        {"materials.[].extensions.KHR_materials_specular.specularColorFactor", numbers(3, not_negative)},

        {"meshes.[]", has({"primitives"})},
        {"meshes.[].primitives.[]", has({"attributes"})},
        {"meshes.[].primitives.[].attributes.{}", accessor},
        {"meshes.[].primitives.[].indices", accessor},
        {"meshes.[].primitives.[].material", index_into("materials")},
        {"meshes.[].primitives.[].mode", whole(0, 6)},
        {"meshes.[].primitives.[].targets.[].{}", accessor},
        {draco, has({"bufferView", "attributes"})},
        {draco + ".bufferView", buffer_view},
        {draco + ".attributes.{}", whole(0, most_elements)},

        {"cameras.[]", has({"type"})},
        {"cameras.[].type", one_of({"perspective", "orthographic"})},
        {"cameras.[]", has_its_kind({"perspective", "orthographic"})},
        {"cameras.[].perspective", has({"yfov", "znear"})},
        {"cameras.[].perspective.yfov", number(field_of_view)},
        {"cameras.[].perspective.znear", number(positive)},
        {"cameras.[].orthographic", has({"xmag", "ymag", "znear", "zfar"})},
        {"cameras.[].orthographic.ymag", number(positive)},
        {"cameras.[].orthographic.znear", number(not_negative)},
        {"cameras.[].perspective|orthographic.zfar", number(positive)},

        {"extensions.KHR_lights_punctual", has({"lights"})},
        {lights, has({"type"})},
        {lights + ".name|type", text},
        {lights, has_its_kind({"spot"})},
        {lights + ".color", numbers(3, unit)},
        {lights + ".intensity", number(not_negative)},
        {lights + ".range", number(positive)},
        {lights + ".spot.innerConeAngle", number(inner_cone)},
        {lights + ".spot.outerConeAngle", number(outer_cone)},
        {lights + ".extensions.CANDELA_light.castsShadow", flag},

        {"nodes.[].mesh", index_into("meshes")},
        {"nodes.[].skin", index_into("skins")},
        {"nodes.[].camera", index_into("cameras")},
        {"nodes.[].children.[]", node},
        {"nodes.[].translation|scale", numbers(3, any)},
        {"nodes.[].rotation", numbers(4, any)},
        {"nodes.[].matrix", numbers(16, any)},
        {"nodes.[].extensions.KHR_lights_punctual", has({"light"})},
        {"nodes.[].extensions.KHR_lights_punctual.light",
         index_into("extensions.KHR_lights_punctual.lights", "lights")},
        {"nodes.[].extensions.EXT_mesh_gpu_instancing", has({"attributes"})},
        {"nodes.[].extensions.EXT_mesh_gpu_instancing.attributes.{}", accessor},
        {"meshes|nodes.[].weights.[]", number(any)},
        {"skins.[]", has({"joints"})},
        {"skins.[].joints", not_empty("joints")},
        {"skins.[].joints.[]", node},
        {"skins.[].inverseBindMatrices", accessor},
        {"animations.[]", has({"channels", "samplers"})},
        {"animations.[].samplers.[]", has({"input", "output"})},
        {"animations.[].samplers.[].input|output", accessor},
        {"animations.[].samplers.[].interpolation",
         one_of({Interpolation::step, Interpolation::linear, Interpolation::cubic_spline})},
        {"animations.[].channels.[]", has({"sampler", "target"})},
        {"animations.[].channels.[].sampler", index},
        {"animations.[].channels.[].target", has({"path"})},
        {"animations.[].channels.[].target.node", node},
        {"animations.[].channels.[].target.path", text},
        {"scenes.[].nodes.[]", node},
        {environment + ".name|uri", text},
        {environment + ".radiance", numbers(3, not_negative)},
        {environment + ".bufferView", buffer_view},
        {environment + ".rotation", number(any)},
        {"scene", index_into("scenes")},
    };
    for (const std::string use :
         {"materials.[].pbrMetallicRoughness.baseColorTexture|metallicRoughnessTexture",
          "materials.[].normalTexture|occlusionTexture|emissiveTexture"}) {
        const std::string transform = use + ".extensions.KHR_texture_transform";
        all.push_back({use, has({"index"})});
        all.push_back({use + ".index", texture});
        all.push_back({use + ".texCoord", index});
        all.push_back({transform + ".offset|scale", numbers(2, any)});
        all.push_back({transform + ".rotation", number(any)});
        all.push_back({transform + ".texCoord", index});
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

/// The text before the first `separator`, and the one after it.
std::pair<std::string_view, std::string_view> split(std::string_view text, char separator) {
    const std::size_t at = std::min(text.find(separator), text.size());
    return {text.substr(0, at), text.substr(std::min(at + 1, text.size()))};
}

/// Applies the rule's check to each value that `path`, the rest of the rule's path, leads to from `value`.
void apply(const Rule& rule, std::string_view path, const Json& value, const Place& place,
           const Json& document) {
    if (path.empty()) {
        if (const Problem error = rule.check(value, document)) throw SceneError(place.name() + ' ' + *error);
        return;
    }
    const auto [step, rest] = split(path, '.');
    const bool items = step == "[]";
    if (items != value.is_array() || (!items && !value.is_object())) {
        throw SceneError(fmt::format("{} is not an {}", place.name(), items ? "array" : "object"));
    }
    if (items) {
        for (std::size_t i = 0; i < value.size(); ++i) {
            apply(rule, rest, value[i], {.parent = &place, .item = i}, document);
        }
    } else if (step == "{}") {
        for (const auto& [key, member] : value.items()) {
            apply(rule, rest, member, {.parent = &place, .member = key}, document);
        }
    } else {
        for (auto [name, others] = split(step, '|'); !name.empty();
             std::tie(name, others) = split(others, '|')) {
            const auto member = value.find(name);
            if (member == value.end()) continue;
            apply(rule, rest, *member, {.parent = &place, .member = name}, document);
        }
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
