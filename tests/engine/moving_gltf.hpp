#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/engine/gltf_builder.hpp"

namespace candela::test {

using Floats = std::vector<float>;

/// The right triangle with a skeleton of two joints: node 0 is the mesh, 1 the first joint, at (0, 0, 3), 2
/// its child. Corner i follows joint i % 2.
inline GltfBuilder figure() {
    GltfBuilder file = right_triangle();
    file.primitive()["attributes"]["JOINTS_0"] =
        file.add_accessor(std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, 5121, "VEC4", 4);
    file.primitive()["attributes"]["WEIGHTS_0"] =
        file.add_accessor(Floats{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 5126, "VEC4", 4);
    file.document["nodes"] =
        Json::parse(R"([{"mesh": 0, "skin": 0}, {"translation": [0, 0, 3], "children": [2]},
                                             {"name": "arm", "translation": [1, 0, 0]}])");
    file.document["scenes"] = Json::parse(R"([{"nodes": [0, 1]}])");
    Floats binds(32, 0.0F);
    for (std::size_t i = 0; i < 4; ++i) binds[5 * i] = binds[16 + 5 * i] = 1.0F;
    binds[16 + 12] = -1.0F;  // from the mesh to the arm, which is at x = 1
    file.document["skins"] = {
        {{"joints", {1, 2}}, {"inverseBindMatrices", file.add_accessor(binds, 5126, "MAT4", 16)}}};
    return file;
}

/// The right triangle with two morph targets.
inline GltfBuilder morphing() {
    GltfBuilder file = right_triangle();
    file.primitive()["attributes"]["NORMAL"] = file.add_vectors({0, 0, 1, 0, 0, 1, 0, 0, 1});
    file.primitive()["targets"] = {{{"POSITION", file.add_vectors({0, 0, 1, 0, 0, 2, 0, 0, 3})}},
                                   {{"POSITION", file.add_vectors({5, 0, 0, 0, 0, 0, 0, 0, 0})},
                                    {"NORMAL", file.add_vectors({1, 0, 0, 0, 0, 0, 0, 0, 0})}}};
    return file;
}

/// Adds an animation of one channel.
inline void animate(GltfBuilder& file, const Json& target, const Floats& times, std::size_t output,
                    const char* interpolation = "LINEAR") {
    const std::size_t input = file.add_accessor(times, 5126, "SCALAR", 1);
    file.add("animations",
             {{"channels", {{{"sampler", 0}, {"target", target}}}},
              {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}}});
}

/// A figure with morph targets and animations of all kinds.
inline GltfBuilder moving_scene() {
    GltfBuilder file = figure();
    file.primitive()["targets"] = {{{"POSITION", file.add_vectors({0, 0, 1, 0, 0, 2, 0, 0, 3})}}};
    file.document["meshes"][0]["weights"] = {0.5};
    file.document["nodes"][0]["weights"] = {0.25};
    animate(file, {{"node", 2}, {"path", "translation"}}, {0, 1}, file.add_vectors({1, 0, 0, 1, 4, 0}));
    animate(file, {{"node", 1}, {"path", "rotation"}}, {0, 1},
            file.add_accessor(Floats{0, 0, 0, 1, 0, 0, 1, 0}, 5126, "VEC4", 4), "STEP");
    animate(file, {{"node", 0}, {"path", "weights"}}, {0, 1},
            file.add_accessor(Floats{0, 0, 1, 0, 1, 0}, 5126, "SCALAR", 1), "CUBICSPLINE");
    return file;
}

}  // namespace candela::test
