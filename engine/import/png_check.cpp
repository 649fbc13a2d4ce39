#include "engine/import/png_check.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <stb/stb_image.h>

#include <candela/scene/scene_error.hpp>

namespace candela::gltf {

namespace {

constexpr std::size_t signature_size = 8;
constexpr std::size_t chunk_header_size = 8;  // length and type
constexpr std::size_t checksum_size = 4;

struct Chunk {
    Bytes type;
    Bytes data;
};

/// The chunk at the beginning of `rest`, without its checksum; nothing at the end.
std::optional<Chunk> first_chunk(Bytes rest) {
    if (rest.size() < chunk_header_size) {
        return std::nullopt;
    }
    const std::size_t length = std::size_t{rest[0]} << 24U | std::size_t{rest[1]} << 16U |
                               std::size_t{rest[2]} << 8U | std::size_t{rest[3]};
    const Bytes data = rest.subspan(chunk_header_size);
    if (length > data.size()) {
        throw SceneError(
            fmt::format("it is cut short: of a chunk of {} bytes, {} are left", length, data.size()));
    }
    return Chunk{rest.subspan(4, 4), data.first(length)};
}

/// The contents of all IDAT chunks: one stream in zlib's format.
std::vector<char> compressed_data(Bytes png) {
    std::vector<char> all;
    Bytes rest = png.subspan(std::min(signature_size, png.size()));
    while (const std::optional<Chunk> chunk = first_chunk(rest)) {
        if (starts_with(chunk->type, "IEND")) {
            break;
        }
        if (starts_with(chunk->type, "IDAT")) {
            all.insert(all.end(), chunk->data.begin(), chunk->data.end());
        }
        const std::size_t size = chunk_header_size + chunk->data.size() + checksum_size;
        rest = rest.subspan(std::min(size, rest.size()));
    }
    return all;
}

}  // namespace

void check_png(Bytes png, std::uint64_t width, std::uint64_t height) {
    const std::vector<char> compressed = compressed_data(png);
    // A pixel has at most four channels of 16 bits, and each row begins with one byte. Interlaced pictures
    // have fewer than 2 height + 7 rows.
    const std::uint64_t needed = 8 * width * height + 2 * height + 7;
    const auto most = static_cast<int>(std::min<std::uint64_t>(needed, std::numeric_limits<int>::max()));
    const auto decompressed = std::make_unique_for_overwrite<char[]>(static_cast<std::size_t>(most));
    if (stbi_zlib_decode_buffer(decompressed.get(), most, compressed.data(),
                                static_cast<int>(compressed.size())) < 0) {
        throw SceneError(
            fmt::format("its data are corrupt, or more than {} x {} pixels need", width, height));
    }
}

}  // namespace candela::gltf
