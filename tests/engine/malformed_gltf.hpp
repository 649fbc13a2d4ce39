#pragma once

#include <doctest/doctest.h>

#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tests/engine/gltf_builder.hpp"

namespace candela::test {

/// What the import reports about the file; "imported" on success. Checks that a failure leaves the world
/// unchanged, and that its message is one line that starts with the file's name.
inline std::string error_of(const Bytes& file) {
    World world;
    const Entity before = world.create();
    world.set(before, Name{"before"});
    const auto names = world.revision<Name>();
    try {
        (void)import_gltf(file, {}, "broken.gltf", world);
    } catch (const SceneError& error) {
        const std::string message = error.what();
        CHECK(world.size() == 1);
        CHECK(world.revision<Name>() == names);
        CHECK(world.revision<Transform>() == 0);
        CHECK(message.find('\n') == std::string::npos);
        CHECK(message.size() < 400);
        REQUIRE(message.starts_with("broken.gltf: "));
        return message.substr(13);
    }
    return "imported";
}

inline std::string error_of(const GltfBuilder& file) {
    return error_of(file.gltf());
}

/// A file that contains everything that the import reads.
inline GltfBuilder complete_scene() {
    GltfBuilder file;
    file.add_primitive({0, 0, 0, 1, 0, 0, 0, 1, 0});                                           // accessor 0
    file.primitive()["indices"] = file.add_indices({0, 1, 2});                                 // accessor 1
    file.primitive()["attributes"]["NORMAL"] = file.add_vectors({0, 0, 1, 0, 0, 1, 0, 0, 1});  // accessor 2
    file.primitive()["attributes"]["TEXCOORD_0"] =
        file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, 5126, "VEC2", 2);  // accessor 3
    file.primitive()["material"] = 0;
    const std::size_t indices = file.add_view(std::vector<std::uint32_t>{1});
    const std::size_t values = file.add_view(std::vector<float>{2, 0, 0});
    file.document["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", indices}, {"componentType", 5125}}},
        {"values", {{"bufferView", values}}}};
    file.document.update(Json::parse(R"({
        "materials": [{"emissiveFactor": [1, 1, 2], "emissiveTexture": {"index": 0},
                       "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 2}}, "doubleSided": true, "normalTexture": {"index": 0},
                       "alphaMode": "MASK", "alphaCutoff": 0.5,
                       "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1], "baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0, "sampler": 0}], "samplers": [{"wrapS": 10497, "wrapT": 10497}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1, "zfar": 2}},
                    {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 1, "zfar": 2}}],
        "extensionsUsed": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "spot", "color": [1, 1, 1], "intensity": 1, "range": 1,
             "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.2}}]}},
        "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "a", "mesh": 0, "camera": 0, "children": [1, 2], "translation": [0, 0, 0],
                   "rotation": [0, 0, 0, 1], "scale": [1, 1, 1], "extensions": {"KHR_lights_punctual": {"light": 0}}},
                  {"camera": 1}, {"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}]})"));
    file.add("images", {{"uri", sixteen_bit_png}});
    return file;
}

/// One change to a document, and the error that must be reported.
struct Defect {
    std::string where;  ///< JSON pointer
    std::string value;  ///< JSON text; empty: the member is removed
    std::string error;  ///< `@` stands for the member as messages call it, `^` for what it is in
};

/// As messages call it: "nodes[0].mesh".
inline std::string name_of(const Json::json_pointer& where) {
    if (where.empty()) return {};
    const std::string before = name_of(where.parent_pointer());
    const std::string& last = where.back();
    if (last.find_first_not_of("0123456789") == std::string::npos) return fmt::format("{}[{}]", before, last);
    return before.empty() ? last : fmt::format("{}.{}", before, last);
}

inline std::string expected(std::string error, const Json::json_pointer& where) {
    if (error.starts_with('@')) return name_of(where) + error.substr(1);
    return error.starts_with('^') ? name_of(where.parent_pointer()) + error.substr(1) : error;
}

inline void check_defects(const std::vector<Defect>& defects, const GltfBuilder& whole = complete_scene()) {
    for (const Defect& defect : defects) {
        CAPTURE(defect.where);
        CAPTURE(defect.value);
        GltfBuilder file = whole;
        const Json::json_pointer where(defect.where);
        if (!defect.value.empty()) {
            file.document[where] = Json::parse(defect.value);
        } else {
            REQUIRE(file.document.contains(where));
            file.document[where.parent_pointer()].erase(where.back());
        }
        CHECK(error_of(file) == expected(defect.error, where));
    }
}

}  // namespace candela::test
