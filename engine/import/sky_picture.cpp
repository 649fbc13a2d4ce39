#include <candela/scene/sky_picture.hpp>

#include <cstdlib>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <stb/stb_image.h>
#include <tinyexr.h>

#include "engine/import/gltf_document.hpp"
#include "engine/import/sky_picture_size.hpp"
#include "engine/scene/check.hpp"

namespace candela {
namespace {

constexpr std::int64_t widest = 16384;

struct Free {
    void operator()(float* texels) const { std::free(texels); }  // NOLINT(cppcoreguidelines-no-malloc)
};
/// Texels that a library has allocated with malloc.
using Texels = std::unique_ptr<float, Free>;

/// `channels`: floats of a texel, of which the first three are used.
SkyPicture to_picture(int width, int height, const Texels& texels, std::size_t channels) {
    SkyPicture picture{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
    const std::size_t count = std::size_t{picture.width} * picture.height;
    picture.texels.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const float* const texel = texels.get() + channels * i;
        picture.texels.emplace_back(texel[0], texel[1], texel[2]);
    }
    return picture;
}

SkyPicture read_hdr(gltf::Bytes bytes) {
    if (bytes.size() > std::numeric_limits<int>::max()) {
        throw SceneError("it exceeds 2 GiB");
    }
    const int size = static_cast<int>(bytes.size());
    int width = 0;
    int height = 0;
    int channels = 0;
    if (stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) == 0) {
        throw SceneError("it is not a readable Radiance picture");
    }
    check_sky_size(width, height);
    const Texels texels(stbi_loadf_from_memory(bytes.data(), size, &width, &height, &channels, 3));
    if (texels == nullptr) {
        throw SceneError(fmt::format("it cannot be decoded: {}", stbi_failure_reason()));
    }
    return to_picture(width, height, texels, 3);
}

/// Throws if the library reports an error. Takes over its message.
void check_exr(int result, const char* message) {
    if (result == TINYEXR_SUCCESS) {
        return;
    }
    std::string reason = message != nullptr ? message : "it is damaged or of an unsupported kind";
    std::erase(reason, '\n');
    FreeEXRErrorMessage(message);
    throw SceneError(fmt::format("it is not a readable OpenEXR picture: {}", reason));
}

SkyPicture read_exr(gltf::Bytes bytes) {
    EXRVersion version{};
    check_exr(ParseEXRVersionFromMemory(&version, bytes.data(), bytes.size()), nullptr);
    EXRHeader header{};
    InitEXRHeader(&header);
    const char* message = nullptr;
    check_exr(ParseEXRHeaderFromMemory(&header, &version, bytes.data(), bytes.size(), &message), message);
    const EXRBox2i window = header.data_window;
    FreeEXRHeader(&header);
    check_sky_size(window.max_x - window.min_x + 1, window.max_y - window.min_y + 1);
    float* loaded = nullptr;
    int width = 0;
    int height = 0;
    const int result = LoadEXRFromMemory(&loaded, &width, &height, bytes.data(), bytes.size(), &message);
    const Texels texels(loaded);
    check_exr(result, message);
    return to_picture(width, height, texels, 4);
}

std::shared_ptr<const SkyPicture> checked(SkyPicture picture) {
    if (const Fault fault = fault_of(picture)) {
        throw SceneError(*fault);
    }
    return std::make_shared<const SkyPicture>(std::move(picture));
}

}  // namespace

void check_sky_size(std::int64_t width, std::int64_t height) {
    if (width != 2 * height || width <= 0) {
        throw SceneError(
            fmt::format("it has {} × {} pixels and is not twice as wide as high", width, height));
    }
    if (width > widest) {
        throw SceneError(fmt::format("it is {} pixels wide; {} are possible", width, widest));
    }
}

std::shared_ptr<const SkyPicture> decode_sky_picture(gltf::Bytes bytes) {
    if (gltf::starts_with(bytes, "\x76\x2f\x31\x01")) {
        return checked(read_exr(bytes));
    }
    if (gltf::starts_with(bytes, "#?")) {
        return checked(read_hdr(bytes));
    }
    throw SceneError("it is neither a Radiance (.hdr) nor an OpenEXR (.exr) picture");
}

std::shared_ptr<const SkyPicture> load_sky_picture(const std::filesystem::path& path) {
    try {
        return decode_sky_picture(gltf::read_file(path, "the file"));
    } catch (const std::bad_alloc&) {
        throw SceneError(fmt::format("{}: it does not fit into memory", path.string()));
    } catch (const std::exception& error) {
        throw SceneError(fmt::format("{}: {}", path.string(), error.what()));
    }
}

}  // namespace candela
