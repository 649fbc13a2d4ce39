#pragma once

#include <vector>

#include "tests/engine/gltf_builder.hpp"

namespace candela::test {

/// One way for each thing that a file can tell in several. All exhibits show the same: a green tick in front
/// of a camera that looks along -z, lit by the sun, on black. Wherever a reader takes what the file does not
/// mean, such as a part of a buffer that is not the accessor's, the tick is elsewhere or red.
struct Exhibit {
    enum class Order { indices_16, indices_8, indices_32, none, strip };
    enum class Layout { packed, interleaved, sparse, sparse_without_base, quantized };
    enum class Place { identity, parts, matrix, mirrored, below_another, instanced, twice, of_second_scene };
    enum class Colour {
        factor,
        vertices_float,
        vertices_byte,
        vertices_short,
        texture,
        moved_texture,
        mirrored_texture,
        texture_of_second_set,
        mask
    };
    enum class Motion { none, morphed, skinned };

    Order order = Order::indices_16;
    Layout layout = Layout::packed;
    Place place = Place::identity;
    Colour colour = Colour::factor;
    Motion motion = Motion::none;

    [[nodiscard]] GltfBuilder file() const;
};

/// All pairs of ways that two different members can have, beside the first way of the others.
[[nodiscard]] std::vector<Exhibit> all_exhibits();

}  // namespace candela::test
