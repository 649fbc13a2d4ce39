#include "engine/import/gltf_compressed.hpp"

#if CANDELA_MESHOPT

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <candela/scene/scene_error.hpp>
#include "engine/import/gltf_accessors.hpp"
#include "engine/import/gltf_constants.hpp"
#include "engine/import/naming.hpp"

namespace candela::gltf {

namespace {

/// What the extension says of a buffer view.
struct Compressed {
    std::string mode;
    std::string filter;
    std::size_t count;   ///< elements
    std::size_t stride;  ///< bytes of each
};

/// The strides that the extension allows; the library relies on them.
bool is_stride_allowed(const Compressed& compressed) {
    const std::size_t stride = compressed.stride;
    if (compressed.mode != "ATTRIBUTES") return stride == 2 || stride == 4;
    if (compressed.filter == "OCTAHEDRAL") return stride == 4 || stride == 8;
    if (compressed.filter == "QUATERNION") return stride == 8;
    return stride % 4 == 0;
}

void check_sizes(const Compressed& compressed, std::size_t view_length) {
    if (!is_stride_allowed(compressed)) {
        throw SceneError(fmt::format("its stride of {} does not go with {} and {}", compressed.stride,
                                     compressed.mode, compressed.filter));
    }
    if (compressed.mode != "ATTRIBUTES" && compressed.filter != "NONE") {
        throw SceneError(
            fmt::format("its filter {} does not go with {}", compressed.filter, compressed.mode));
    }
    if (compressed.mode == "TRIANGLES" && compressed.count % 3 != 0) {
        throw SceneError(fmt::format("its {} indices make no whole number of triangles", compressed.count));
    }
    if (compressed.count * compressed.stride != view_length) {
        throw SceneError(fmt::format("its {} elements of {} bytes are not the {} bytes it declares",
                                     compressed.count, compressed.stride, view_length));
    }
}

/// 0 if it works.
int decode(const Compressed& compressed, Bytes encoded, std::vector<unsigned char>& decoded) {
    unsigned char* const to = decoded.data();
    const auto [count, stride] = std::pair(compressed.count, compressed.stride);
    if (compressed.mode == "ATTRIBUTES") {
        return meshopt_decodeVertexBuffer(to, count, stride, encoded.data(), encoded.size());
    }
    if (compressed.mode == "TRIANGLES") {
        return meshopt_decodeIndexBuffer(to, count, stride, encoded.data(), encoded.size());
    }
    return meshopt_decodeIndexSequence(to, count, stride, encoded.data(), encoded.size());
}

void apply_filter(const Compressed& compressed, std::vector<unsigned char>& decoded) {
    if (compressed.filter == "OCTAHEDRAL") {
        meshopt_decodeFilterOct(decoded.data(), compressed.count, compressed.stride);
    } else if (compressed.filter == "QUATERNION") {
        meshopt_decodeFilterQuat(decoded.data(), compressed.count, compressed.stride);
    } else if (compressed.filter == "EXPONENTIAL") {
        meshopt_decodeFilterExp(decoded.data(), compressed.count, compressed.stride);
    }
}

std::vector<unsigned char> decode_view(const Document& document, int index, const Json& extension,
                                       ImportBudget& budget) {
    const Compressed compressed{text_in(extension, "mode"), text_in(extension, "filter", "NONE"),
                                extension.at("count").get<std::size_t>(),
                                extension.at("byteStride").get<std::size_t>()};
    check_sizes(compressed, document.at("bufferViews", index).at("byteLength").get<std::size_t>());
    const Bytes encoded = buffer_bytes(document, extension, index);
    budget.add_memory(compressed.count * compressed.stride);
    std::vector<unsigned char> decoded(compressed.count * compressed.stride);
    if (decode(compressed, encoded, decoded) != 0) throw SceneError("its compressed data are damaged");
    apply_filter(compressed, decoded);
    return decoded;
}

}  // namespace

void decode_buffer_views(Document& document, ImportBudget& budget) {
    const std::string path = fmt::format("extensions.{}", meshopt_extension);
    const Json& views = document.all("bufferViews");
    for (int i = 0; i < static_cast<int>(views.size()); ++i) {
        if (const Json* const extension = find_member(document.at("bufferViews", i), path)) {
            document.decoded_views[i] = naming(fmt::format("buffer view {}", i),
                                               [&] { return decode_view(document, i, *extension, budget); });
        }
    }
}

}  // namespace candela::gltf

#else

namespace candela::gltf {

void decode_buffer_views(Document& /*document*/, ImportBudget& /*budget*/) {}

}  // namespace candela::gltf

#endif
