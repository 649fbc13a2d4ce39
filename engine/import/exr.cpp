#include "engine/import/exr.hpp"

#include <array>
#include <cstdlib>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <tinyexr.h>

#include <candela/scene/scene_error.hpp>

namespace candela {

namespace {

struct FreeBytes {
    void operator()(unsigned char* bytes) const { std::free(bytes); }  // NOLINT(cppcoreguidelines-no-malloc)
};

/// OpenEXR stores channels separately, sorted by name: blue, green, red.
std::array<std::vector<float>, 3> planes_bgr(std::span<const glm::vec3> texels) {
    std::array<std::vector<float>, 3> planes;
    for (int channel = 0; channel < 3; ++channel) {
        std::vector<float>& plane = planes[static_cast<std::size_t>(channel)];
        plane.reserve(texels.size());
        for (const glm::vec3& texel : texels) {
            plane.push_back(texel[2 - channel]);
        }
    }
    return planes;
}

}  // namespace

std::vector<std::byte> encode_exr(std::uint32_t width, std::uint32_t height,
                                  std::span<const glm::vec3> texels) {
    std::array<std::vector<float>, 3> planes = planes_bgr(texels);
    std::array<unsigned char*, 3> plane_bytes{};
    std::array<EXRChannelInfo, 3> channels{};
    std::array<int, 3> types{};
    types.fill(TINYEXR_PIXELTYPE_FLOAT);
    for (std::size_t i = 0; i < planes.size(); ++i) {
        plane_bytes[i] = reinterpret_cast<unsigned char*>(planes[i].data());
        channels[i].name[0] = "BGR"[i];
    }

    EXRImage image;
    InitEXRImage(&image);
    image.images = plane_bytes.data();
    image.width = static_cast<int>(width);
    image.height = static_cast<int>(height);
    image.num_channels = 3;
    EXRHeader header;
    InitEXRHeader(&header);
    header.num_channels = 3;
    header.channels = channels.data();
    header.pixel_types = types.data();
    header.requested_pixel_types = types.data();
    header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;

    unsigned char* memory = nullptr;
    const char* message = nullptr;
    const std::size_t length = SaveEXRImageToMemory(&image, &header, &memory, &message);
    const std::unique_ptr<unsigned char, FreeBytes> file(memory);
    if (length == 0) {
        const std::string reason = message != nullptr ? message : "unknown error";
        FreeEXRErrorMessage(message);
        throw SceneError(fmt::format("cannot be encoded as OpenEXR: {}", reason));
    }
    const auto* const first = reinterpret_cast<const std::byte*>(memory);
    return {first, first + length};
}

}  // namespace candela
