#include "tests/renderer/exhibits.hpp"

#include <stb/stb_image_write.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <type_traits>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

namespace candela::test {

namespace {

using Points = std::vector<glm::vec3>;

constexpr int type_float = 5126;
constexpr int type_byte = 5121;
constexpr int type_short = 5122;
constexpr int type_unsigned_short = 5123;
constexpr int type_unsigned_int = 5125;
constexpr int mode_strip = 5;
constexpr int wrap_mirrored = 33648;

/// The tick's corners in the order of a strip, in the plane z = 0; metres.
const Points tick{{-0.5F, 0.25F, 0},  {-0.75F, 0, 0},   {-0.25F, 0, 0},
                  {-0.25F, -0.5F, 0}, {0.5F, 0.75F, 0}, {0.75F, 0.5F, 0}};
constexpr std::array tick_triangles{0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4};

/// Of a node: moved, turned by a quarter, and scaled in its own ways along x and y.
const glm::vec3 moved{0.5F, -0.25F, 0.125F};
const glm::quat turned = glm::angleAxis(glm::radians(90.0F), glm::vec3(0, 0, 1));
const glm::vec3 scaled{0.5F, 2.0F, 1.0F};
const glm::vec3 away{100.0F, 0.0F, 0.0F};  // out of the camera's sight

std::vector<float> flat(const Points& points) {
    std::vector<float> values;
    for (const glm::vec3& point : points) {
        values.insert(values.end(), {point.x, point.y, point.z});
    }
    return values;
}

/// The file that shows an exhibit, as it grows.
class Writer {
 public:
    explicit Writer(const Exhibit& exhibit) : exhibit_(exhibit) {}

    GltfBuilder write() {
        file_.document = Json::parse(R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
            "nodes": [{"children": [1]}, {"mesh": 0}], "meshes": [{"primitives": [{"attributes": {}}]}]})");
        // All is larger by `unit`, but for the scene as a whole.
        node(0)["scale"] = vector(glm::vec3(1.0F / unit()));
        place();
        shape();
        colour();
        return std::move(file_);
    }

 private:
    using Order = Exhibit::Order;
    using Layout = Exhibit::Layout;
    using Place = Exhibit::Place;
    using Colour = Exhibit::Colour;
    using Motion = Exhibit::Motion;

    Json& node(std::size_t index) { return file_.document["nodes"][index]; }
    Json& attributes() { return file_.primitive()["attributes"]; }
    [[nodiscard]] static Json vector(const glm::vec3& v) { return {v.x, v.y, v.z}; }

    /// Integers can hold small lengths then.
    [[nodiscard]] float unit() const { return exhibit_.layout == Layout::quantized ? 4096.0F : 1.0F; }

    void use_extension(const char* name) { file_.document["extensionsUsed"].push_back(name); }

    /// From the space of the file's mesh to that of the tick.
    [[nodiscard]] glm::mat4 tick_from_mesh() const {
        if (exhibit_.motion == Motion::skinned) {
            // The node's own place does not count, but that of its parent, where the joints are.
            return exhibit_.place == Place::below_another ? glm::mat4_cast(turned) : glm::mat4(1.0F);
        }
        switch (exhibit_.place) {
            case Place::parts:
            case Place::matrix:
                return glm::scale(glm::translate(glm::mat4(1.0F), moved) * glm::mat4_cast(turned), scaled);
            case Place::mirrored:
                return glm::scale(glm::mat4(1.0F), {-1.0F, 1.0F, 1.0F});
            case Place::below_another:
                return glm::translate(glm::mat4_cast(turned), moved);
            case Place::instanced:
                return glm::translate(glm::mat4(1.0F), moved);
            default:
                return glm::mat4(1.0F);
        }
    }

    void place() {
        const glm::vec3 move = moved * unit();
        switch (exhibit_.place) {
            case Place::identity:
                break;
            case Place::parts:
                node(1)["translation"] = vector(move);
                node(1)["rotation"] = {turned.x, turned.y, turned.z, turned.w};
                node(1)["scale"] = vector(scaled);
                break;
            case Place::matrix: {
                const glm::mat4 matrix =
                    glm::scale(glm::translate(glm::mat4(1.0F), move) * glm::mat4_cast(turned), scaled);
                node(1)["matrix"] = std::vector<float>(glm::value_ptr(matrix), glm::value_ptr(matrix) + 16);
                break;
            }
            case Place::mirrored:
                node(1)["scale"] = {-1, 1, 1};
                break;
            case Place::below_another:
                node(0)["rotation"] = {turned.x, turned.y, turned.z, turned.w};
                node(1)["translation"] = vector(move);
                break;
            case Place::instanced: {
                const std::size_t places = file_.add_vectors(flat({move, away * unit()}));
                node(1)["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = places;
                use_extension("EXT_mesh_gpu_instancing");
                break;
            }
            case Place::twice:
                file_.add("nodes", {{"mesh", 0}, {"translation", vector(away * unit())}});
                node(0)["children"] = {1, 2};
                break;
            case Place::of_second_scene:
                file_.add("nodes", {{"mesh", 0}, {"translation", {0.1F, 0.1F, 0.1F}}});
                file_.document["scenes"] = Json::parse(R"([{"nodes": [2]}, {"nodes": [0]}])");
                file_.document["scene"] = 1;
                break;
        }
    }

    /// The vertices' values in the order of the file.
    template <class T>
    [[nodiscard]] std::vector<T> in_order(const std::vector<T>& of_corners) const {
        if (exhibit_.order != Order::none) return of_corners;
        std::vector<T> values;
        for (const std::size_t corner : triangles()) {
            values.push_back(of_corners[corner]);
        }
        return values;
    }
    template <class T>
    [[nodiscard]] std::vector<T> for_each_vertex(const std::vector<T>& value) const {
        std::vector<T> values;
        for (std::size_t i = 0; i < in_order(tick).size(); ++i) {
            values.insert(values.end(), value.begin(), value.end());
        }
        return values;
    }

    /// By glTF, triangles are counter-clockwise in the space of the mesh, also if a transform mirrors it.
    [[nodiscard]] bool is_reversed() const { return glm::determinant(tick_from_mesh()) < 0.0F; }

    [[nodiscard]] std::vector<std::uint32_t> triangles() const {
        std::vector<std::uint32_t> corners(tick_triangles.begin(), tick_triangles.end());
        for (std::size_t i = 0; is_reversed() && i < corners.size(); i += 3) {
            std::swap(corners[i], corners[i + 1]);
        }
        return corners;
    }

    void shape() {
        Points corners;
        for (const glm::vec3& corner : tick) {
            corners.push_back(unit() * glm::vec3(glm::inverse(tick_from_mesh()) * glm::vec4(corner, 1.0F)));
        }
        if (exhibit_.motion == Motion::morphed) morph(corners);
        if (exhibit_.motion == Motion::skinned) skin(corners);
        lay_out(in_order(corners));
        order();
    }

    template <class Index>
    void add_indices(int type) {
        std::vector<Index> indices;
        for (const std::uint32_t corner : triangles()) {
            indices.push_back(static_cast<Index>(corner));
        }
        file_.primitive()["indices"] = file_.add_accessor(indices, type, "SCALAR", 1);
    }

    void order() {
        switch (exhibit_.order) {
            case Order::indices_16:
                return add_indices<std::uint16_t>(type_unsigned_short);
            case Order::indices_8:
                return add_indices<std::uint8_t>(type_byte);
            case Order::indices_32:
                return add_indices<std::uint32_t>(type_unsigned_int);
            case Order::none:
                return;
            case Order::strip: {
                // The first corner twice is a triangle without area, after which all turn the other way.
                std::vector<std::uint16_t> indices{0, 0, 1, 2, 3, 4, 5};
                if (!is_reversed()) indices.erase(indices.begin());
                file_.primitive()["indices"] = file_.add_indices(indices);
                file_.primitive()["mode"] = mode_strip;
                return;
            }
        }
    }

    void lay_out(const Points& positions) {
        const Points normals(positions.size(), glm::vec3(0, 0, 1));
        switch (exhibit_.layout) {
            case Layout::packed:
                attributes()["POSITION"] = file_.add_vectors(flat(positions));
                break;
            case Layout::interleaved:
                return interleave(positions, normals);
            case Layout::sparse: {
                // Every third one is wrong.
                Points base = positions;
                for (std::size_t i = 0; i < base.size(); i += 3) {
                    base[i] += away;
                }
                attributes()["POSITION"] = file_.add_vectors(flat(base));
                correct(attributes()["POSITION"], positions, 3);
                break;
            }
            case Layout::sparse_without_base: {
                Json accessor{{"componentType", type_float}, {"type", "VEC3"}};
                accessor["count"] = positions.size();
                attributes()["POSITION"] = file_.add("accessors", accessor);
                correct(attributes()["POSITION"], positions, 1);
                break;
            }
            case Layout::quantized:
                quantize(positions);
                break;
        }
        attributes()["NORMAL"] = file_.add_vectors(flat(normals));
    }

    /// Replaces every `step`-th element of an accessor.
    void correct(const Json& accessor, const Points& elements, std::size_t step) {
        std::vector<std::uint16_t> indices;
        Points values;
        for (std::size_t i = 0; i < elements.size(); i += step) {
            indices.push_back(static_cast<std::uint16_t>(i));
            values.push_back(elements[i]);
        }
        Json sparse{{"count", indices.size()}};
        sparse["indices"] = {{"bufferView", file_.add_view(indices)}, {"componentType", type_unsigned_short}};
        sparse["values"] = {{"bufferView", file_.add_view(flat(values))}};
        file_.document["accessors"][accessor.get<std::size_t>()]["sparse"] = sparse;
    }

    /// Position, normal and a number that means nothing, after a gap of two numbers.
    void interleave(const Points& positions, const Points& normals) {
        std::vector<float> rows{7.0F, 7.0F};
        for (std::size_t i = 0; i < positions.size(); ++i) {
            for (const glm::vec3& v : {positions[i], normals[i]}) {
                rows.insert(rows.end(), {v.x, v.y, v.z});
            }
            rows.push_back(7.0F);
        }
        const std::size_t view = file_.add_view(rows);
        file_.document["bufferViews"][view]["byteStride"] = 7 * sizeof(float);
        for (const auto& [name, offset] : {std::pair{"POSITION", 2}, std::pair{"NORMAL", 5}}) {
            Json accessor{{"bufferView", view}, {"componentType", type_float}, {"type", "VEC3"}};
            accessor["count"] = positions.size();
            accessor["byteOffset"] = static_cast<std::size_t>(offset) * sizeof(float);
            attributes()[name] = file_.add("accessors", accessor);
        }
    }

    /// As integers, in rows that are aligned to four bytes.
    void quantize(const Points& positions) {
        std::vector<std::int16_t> rows;
        for (const glm::vec3& position : positions) {
            for (int axis = 0; axis < 3; ++axis) {
                rows.push_back(static_cast<std::int16_t>(std::lround(position[axis])));
            }
            rows.push_back(7);
        }
        attributes()["POSITION"] = add_rows(rows, type_short, "VEC3", 4, false);
        use_extension("KHR_mesh_quantization");
    }

    template <class T>
    std::size_t add_rows(const std::vector<T>& rows, int type, const char* shape, std::size_t length,
                         bool normalized) {
        const std::size_t view = file_.add_view(rows);
        file_.document["bufferViews"][view]["byteStride"] = length * sizeof(T);
        Json accessor{{"bufferView", view}, {"componentType", type}, {"type", shape}};
        accessor["count"] = rows.size() / length;
        if (normalized) accessor["normalized"] = true;
        return file_.add("accessors", accessor);
    }

    /// Two targets, whose weights at the node count and not those at the mesh.
    void morph(Points& corners) {
        Points first;
        Points second;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            first.push_back(unit() * glm::vec3(0.25F * static_cast<float>(i), 0.5F, 0.0F));
            second.push_back(unit() * glm::vec3(0.0F, -0.5F * static_cast<float>(i % 2), 1.0F));
            corners[i] -= 0.5F * first[i] + 0.25F * second[i];
        }
        for (const Points& target : {first, second}) {
            file_.primitive()["targets"].push_back({{"POSITION", file_.add_vectors(flat(in_order(target)))}});
        }
        file_.document["meshes"][0]["weights"] = {1.0F, 0.0F};
        for (Json& any : file_.document["nodes"]) {
            if (any.contains("mesh")) any["weights"] = {0.5F, 0.25F};
        }
    }

    /// Two joints, one below the other. The tick's left part follows the first, its right part the second,
    /// and the middle both.
    void skin(Points& corners) {
        const std::size_t first = file_.add("nodes", {{"translation", vector(moved * unit())}});
        Json turned_joint{{"translation", vector(-2.0F * moved * unit())}};
        turned_joint["rotation"] = {turned.x, turned.y, turned.z, turned.w};
        const std::size_t second = file_.add("nodes", turned_joint);
        node(first)["children"] = {second};
        node(0)["children"].push_back(first);
        const glm::mat4 bound = glm::translate(glm::mat4(1.0F), glm::vec3(0.0F, 0.25F * unit(), 0.0F));
        const glm::mat4 of_first = glm::translate(glm::mat4(1.0F), moved * unit());
        const glm::mat4 of_second =
            glm::translate(of_first, -2.0F * moved * unit()) * glm::mat4_cast(turned) * bound;
        std::vector<float> inverse_binds;
        for (const glm::mat4& matrix : {glm::mat4(1.0F), bound}) {
            inverse_binds.insert(inverse_binds.end(), glm::value_ptr(matrix), glm::value_ptr(matrix) + 16);
        }
        Json skin{{"joints", {first, second}}};
        skin["inverseBindMatrices"] = file_.add_accessor(inverse_binds, type_float, "MAT4", 16);
        file_.add("skins", skin);
        for (Json& any : file_.document["nodes"]) {
            if (any.contains("mesh")) any["skin"] = 0;
        }

        const std::vector<float> shares{0.0F, 0.0F, 0.5F, 0.5F, 1.0F, 1.0F};
        std::vector<float> weights;
        for (const float share : in_order(shares)) {
            weights.insert(weights.end(), {1.0F - share, share, 0.0F, 0.0F});
        }
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const glm::mat4 mean = (1.0F - shares[i]) * of_first + shares[i] * of_second;
            corners[i] = glm::vec3(glm::inverse(mean) * glm::vec4(corners[i], 1.0F));
        }
        attributes()["WEIGHTS_0"] = file_.add_accessor(weights, type_float, "VEC4", 4);
        attributes()["JOINTS_0"] =
            file_.add_accessor(for_each_vertex<std::uint8_t>({0, 1, 0, 0}), type_byte, "VEC4", 4);
    }

    void colour() {
        const bool by_factor = exhibit_.colour == Colour::factor;
        Json material = Json::parse(R"({"extensions": {"KHR_materials_specular": {"specularFactor": 0}},
                                        "pbrMetallicRoughness": {"metallicFactor": 0}})");
        use_extension("KHR_materials_specular");
        if (by_factor) material["pbrMetallicRoughness"]["baseColorFactor"] = {0, 1, 0, 1};
        switch (exhibit_.colour) {
            case Colour::factor:
                break;
            case Colour::vertices_float:
                attributes()["COLOR_0"] =
                    file_.add_accessor(for_each_vertex<float>({0, 1, 0}), type_float, "VEC3", 3);
                break;
            case Colour::vertices_byte:
                attributes()["COLOR_0"] =
                    add_rows(for_each_vertex<std::uint8_t>({0, 255, 0, 255}), type_byte, "VEC4", 4, true);
                break;
            case Colour::vertices_short:
                attributes()["COLOR_0"] = add_rows(for_each_vertex<std::uint16_t>({0, 65535, 0, 7}),
                                                   type_unsigned_short, "VEC3", 4, true);
                break;
            default:
                add_texture(material);
                break;
        }
        file_.add("materials", material);
        file_.primitive()["material"] = 0;
        if (exhibit_.colour == Colour::mask) hide_another();
    }

    /// The green half of a picture whose other half is red and, for a mask, transparent.
    void add_texture(Json& material) {
        const bool masked = exhibit_.colour == Colour::mask;
        constexpr int width = 16;  // so that filters do not reach the other half
        Bytes texels;
        for (int x = 0; x < width; ++x) {
            const Bytes green{0, 255, 0, 255};
            const Bytes red{255, 0, 0, static_cast<unsigned char>(masked ? 0 : 255)};
            const Bytes& texel = x < width / 2 ? red : green;
            texels.insert(texels.end(), texel.begin(), texel.end());
        }
        Bytes png;
        stbi_write_png_to_func(append, &png, width, 1, 4, texels.data(), 4 * width);
        file_.add("images", {{"bufferView", file_.add_view(png)}, {"mimeType", "image/png"}});
        file_.add("textures", {{"source", 0}});
        Json use{{"index", 0}};
        float u = 0.75F;
        if (exhibit_.colour == Colour::moved_texture) {
            u = 0.25F;
            use["extensions"]["KHR_texture_transform"]["offset"] = {0.5F, 0.0F};
            use_extension("KHR_texture_transform");
        }
        if (exhibit_.colour == Colour::mirrored_texture) {
            u = 1.25F;
            file_.add("samplers", {{"wrapS", wrap_mirrored}});
            file_.document["textures"][0]["sampler"] = 0;
        }
        if (exhibit_.colour == Colour::texture_of_second_set) {
            use["texCoord"] = 1;
            add_coordinates("TEXCOORD_1", u);
            u = 0.25F;
        }
        if (masked) material["alphaMode"] = "MASK";
        material["pbrMetallicRoughness"]["baseColorTexture"] = use;
        add_coordinates("TEXCOORD_0", u);
    }

    void add_coordinates(const char* name, float u) {
        attributes()[name] = file_.add_accessor(for_each_vertex<float>({u, 0.5F}), type_float, "VEC2", 2);
    }

    /// A triangle in front of all, in the transparent part of the picture.
    void hide_another() {
        const float wide = 2.0F * unit();
        Json& primitive =
            file_.add_primitive({-wide, -wide, wide / 4, wide, -wide, wide / 4, 0, wide, wide / 4});
        primitive["material"] = 0;
        const std::vector<float> coordinates{0.25F, 0.5F, 0.25F, 0.5F, 0.25F, 0.5F};
        const std::size_t accessor = file_.add_accessor(coordinates, type_float, "VEC2", 2);
        file_.primitive(1)["attributes"]["TEXCOORD_0"] = accessor;
    }

    const Exhibit& exhibit_;
    GltfBuilder file_;
};

template <class Way>
std::vector<Way> ways(Way last) {
    std::vector<Way> all;
    for (int i = 0; i <= static_cast<int>(last); ++i) {
        all.push_back(static_cast<Way>(i));
    }
    return all;
}

/// By glTF, or by what the words mean, these do not go together.
bool is_possible(const Exhibit& exhibit) {
    if (exhibit.motion == Exhibit::Motion::none) return true;
    // The other primitive of the mask would need targets and joints, too.
    if (exhibit.colour == Exhibit::Colour::mask) return false;
    const bool is_skinned = exhibit.motion == Exhibit::Motion::skinned;
    return !is_skinned ||
           (exhibit.place != Exhibit::Place::instanced && exhibit.place != Exhibit::Place::mirrored);
}

template <class A, class B>
void add_pairs(std::vector<Exhibit>& all, A Exhibit::*a, A last_a, B Exhibit::*b, B last_b) {
    for (const A way_a : ways(last_a)) {
        for (const B way_b : ways(last_b)) {
            Exhibit exhibit;
            exhibit.*a = way_a;
            exhibit.*b = way_b;
            if (is_possible(exhibit)) all.push_back(exhibit);
        }
    }
}

}  // namespace

GltfBuilder Exhibit::file() const {
    return Writer(*this).write();
}

std::vector<Exhibit> all_exhibits() {
    using E = Exhibit;
    constexpr auto order = E::Order::strip;
    constexpr auto layout = E::Layout::quantized;
    constexpr auto place = E::Place::of_second_scene;
    constexpr auto colour = E::Colour::mask;
    constexpr auto motion = E::Motion::skinned;
    std::vector<E> all;
    add_pairs(all, &E::order, order, &E::layout, layout);
    add_pairs(all, &E::order, order, &E::place, place);
    add_pairs(all, &E::order, order, &E::colour, colour);
    add_pairs(all, &E::order, order, &E::motion, motion);
    add_pairs(all, &E::layout, layout, &E::place, place);
    add_pairs(all, &E::layout, layout, &E::colour, colour);
    add_pairs(all, &E::layout, layout, &E::motion, motion);
    add_pairs(all, &E::place, place, &E::colour, colour);
    add_pairs(all, &E::place, place, &E::motion, motion);
    add_pairs(all, &E::colour, colour, &E::motion, motion);
    return all;
}

}  // namespace candela::test
