#include "engine/import/gltf_compressed.hpp"

#if CANDELA_DRACO

#include <cstdint>
#include <cstring>
#include <exception>
#include <limits>
#include <memory>
#include <type_traits>
#include <vector>

#include <draco/compression/config/decoder_options.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/mesh/mesh.h>
#include <fmt/format.h>

#include <candela/scene/scene_error.hpp>
#include "engine/import/gltf_accessors.hpp"
#include "engine/import/gltf_constants.hpp"
#include "engine/import/naming.hpp"

namespace candela::gltf {

namespace {

/// Counts what the decoding of an attribute allocates: its values, the integers that they come from, and
/// these once more while they are predicted; and an index for each vertex.
void count_attributes(const draco::PointCloud& points, ImportBudget& budget) {
    for (int i = 0; i < points.num_attributes(); ++i) {
        const draco::PointAttribute& attribute = *points.attribute(i);
        const auto component = static_cast<std::uint64_t>(draco::DataTypeLength(attribute.data_type()));
        budget.add_memory(std::uint64_t{points.num_points()} *
                          (attribute.num_components() * (component + 8) + 4));
    }
}

/// Counts what the decoding of the triangles allocates; `start` is where they begin. See the bit stream's
/// specification, version 2.2, sections "Edgebreaker Decoder" and "Sequential Decoder". Returns false if it
/// is too short.
bool count_triangles(draco::DecoderBuffer start, bool is_edgebreaker, ImportBudget& budget) {
    std::uint32_t first = 0;
    std::uint32_t second = 0;
    std::uint8_t third = 0;
    if (!draco::DecodeVarint(&first, &start) || !draco::DecodeVarint(&second, &start) ||
        !start.Decode(&third)) {
        return false;
    }
    if (is_edgebreaker) {
        // The corners' vertices and opposite corners, the triangles' order, and the same for each attribute
        // that has seams.
        constexpr std::uint64_t bytes_by_triangle = 64;
        const std::uint32_t triangles = second;
        budget.add_memory(triangles * bytes_by_triangle * (1U + third));
    } else {
        const std::uint32_t triangles = first;
        const std::uint32_t vertices = second;
        budget.add_memory(std::uint64_t{triangles} * 3 * 4 + std::uint64_t{vertices} * 4);
    }
    return true;
}

/// One of Draco's decoders that counts memory before it allocates it.
template <class Decoder>
class CountingDecoder : public Decoder {
 public:
    explicit CountingDecoder(ImportBudget& budget) : budget_(budget) {}

    /// Throws SceneError.
    void decode_into(draco::Mesh& mesh, draco::DecoderBuffer& encoded) {
        const bool works = this->Decode(draco::DecoderOptions(), &encoded, &mesh).ok();
        if (failure_) std::rethrow_exception(failure_);
        if (!works) throw SceneError("its Draco data are damaged");
    }

 protected:
    bool DecodeConnectivity() override {
        constexpr bool is_edgebreaker = std::is_same_v<Decoder, draco::MeshEdgebreakerDecoder>;
        // The only version that the extension allows.
        return this->bitstream_version() == draco::kDracoMeshBitstreamVersion &&
               holds([&] { return count_triangles(*this->buffer(), is_edgebreaker, budget_); }) &&
               Decoder::DecodeConnectivity();
    }

    bool DecodeAllAttributes() override {
        const auto count = [&] {
            count_attributes(*this->point_cloud(), budget_);
            return true;
        };
        return holds(count) && Decoder::DecodeAllAttributes();
    }

 private:
    /// Keeps what is thrown: the library need not be made for exceptions that pass through it.
    template <class Check>
    bool holds(Check check) {
        try {
            return check();
        } catch (...) {
            failure_ = std::current_exception();
            return false;
        }
    }

    ImportBudget& budget_;
    std::exception_ptr failure_;
};

std::unique_ptr<draco::Mesh> decode_mesh(Bytes encoded, ImportBudget& budget) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(encoded.data()), encoded.size());
    draco::DecoderBuffer ahead = buffer;
    draco::DracoHeader header{};
    if (!draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok()) {
        throw SceneError("it holds no Draco data");
    }
    auto mesh = std::make_unique<draco::Mesh>();
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
        CountingDecoder<draco::MeshEdgebreakerDecoder>(budget).decode_into(*mesh, buffer);
    } else {
        CountingDecoder<draco::MeshSequentialDecoder>(budget).decode_into(*mesh, buffer);
    }
    return mesh;
}

/// The values at all vertices, as many components as the accessor has.
template <class Component>
std::vector<unsigned char> values_of(const draco::Mesh& mesh, const draco::PointAttribute& attribute,
                                     std::size_t components) {
    const std::size_t element_size = components * sizeof(Component);
    std::vector<unsigned char> bytes(mesh.num_points() * element_size);
    std::vector<Component> element(components);
    for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
        const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(i));
        if (value.value() >= attribute.size() ||
            !attribute.ConvertValue(value, static_cast<std::int8_t>(components), element.data())) {
            throw SceneError("its Draco data are damaged");
        }
        std::memcpy(bytes.data() + i * element_size, element.data(), element_size);
    }
    return bytes;
}

std::vector<unsigned char> attribute_bytes(const draco::Mesh& mesh, const draco::PointAttribute& attribute,
                                           const ElementLayout& layout) {
    switch (layout.component_type) {
        case signed_byte:
            return values_of<std::int8_t>(mesh, attribute, layout.components);
        case unsigned_byte:
            return values_of<std::uint8_t>(mesh, attribute, layout.components);
        case signed_short:
            return values_of<std::int16_t>(mesh, attribute, layout.components);
        case unsigned_short:
            return values_of<std::uint16_t>(mesh, attribute, layout.components);
        case floating_point:
            return values_of<float>(mesh, attribute, layout.components);
        default:
            return values_of<std::uint32_t>(mesh, attribute, layout.components);
    }
}

template <class Index>
std::vector<unsigned char> indices_of(const draco::Mesh& mesh) {
    if (mesh.num_points() > std::uint64_t{std::numeric_limits<Index>::max()} + 1) {
        throw SceneError("its Draco data have more vertices than its indices can tell apart");
    }
    std::vector<unsigned char> bytes(mesh.num_faces() * 3 * sizeof(Index));
    for (std::uint32_t i = 0; i < mesh.num_faces() * 3; ++i) {
        const auto index = static_cast<Index>(mesh.face(draco::FaceIndex(i / 3))[i % 3].value());
        std::memcpy(bytes.data() + i * sizeof(Index), &index, sizeof index);
    }
    return bytes;
}

std::vector<unsigned char> index_bytes(const draco::Mesh& mesh, const ElementLayout& layout) {
    switch (layout.component_type) {
        case unsigned_byte:
            return indices_of<std::uint8_t>(mesh);
        case unsigned_short:
            return indices_of<std::uint16_t>(mesh);
        default:
            return indices_of<std::uint32_t>(mesh);
    }
}

/// The accessor's layout, whose memory is counted, after a check that the decoded data fit.
ElementLayout checked_layout(const Document& document, int accessor, std::size_t decoded,
                             ImportBudget& budget) {
    const ElementLayout layout = layout_of(document, accessor);
    if (layout.count != decoded) {
        throw SceneError(fmt::format("accessor {} has {} elements, but its Draco data {}", accessor,
                                     layout.count, decoded));
    }
    budget.add_memory(std::uint64_t{layout.count} * layout.element_size);
    return layout;
}

/// Decodes what no accessor of the primitive has in another form.
void decode_primitive(Document& document, const Json& primitive, const Json& extension,
                      ImportBudget& budget) {
    const int indices = index_in(primitive, "indices");
    const int positions = index_in(primitive, "attributes.POSITION");
    if (indices < 0 || positions < 0)
        throw SceneError("its Draco data need accessors of positions and indices");
    if (has_data(document, indices) && has_data(document, positions)) return;
    const int view = extension.at("bufferView").get<int>();
    const auto mesh = naming(fmt::format("buffer view {}", view),
                             [&] { return decode_mesh(buffer_view_bytes(document, view), budget); });
    document.decoded_accessors[indices] =
        index_bytes(*mesh, checked_layout(document, indices, std::size_t{mesh->num_faces()} * 3, budget));
    for (const auto& [name, value] : extension.at("attributes").items()) {
        const int accessor = index_in(primitive.at("attributes"), name);
        const auto* const attribute = mesh->GetAttributeByUniqueId(value.get<std::uint32_t>());
        if (accessor < 0) continue;
        if (!attribute) throw SceneError(fmt::format("accessor {} is not in its Draco data", accessor));
        document.decoded_accessors[accessor] = attribute_bytes(
            *mesh, *attribute, checked_layout(document, accessor, mesh->num_points(), budget));
    }
}

}  // namespace

void decode_primitives(Document& document, const Json& mesh, ImportBudget& budget) {
    for (const Json& primitive : mesh.at("primitives")) {
        if (const Json* const draco = find_member(primitive, "extensions.KHR_draco_mesh_compression")) {
            decode_primitive(document, primitive, *draco, budget);
        }
    }
}

}  // namespace candela::gltf

#else

namespace candela::gltf {

void decode_primitives(Document& /*document*/, const Json& /*mesh*/, ImportBudget& /*budget*/) {}

}  // namespace candela::gltf

#endif
