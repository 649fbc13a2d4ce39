#include <candela/scene/sky_picture.hpp>

#include <cstdlib>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <stb/stb_image.h>
#include <tinyexr.h>

#include "engine/import/file_names.hpp"
#include "engine/import/import_files.hpp"
#include "engine/import/naming.hpp"
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

bool is_exr(gltf::Bytes bytes) {
    return gltf::starts_with(bytes, "\x76\x2f\x31\x01");
}

PictureSize hdr_size(gltf::Bytes bytes) {
    if (bytes.size() > std::numeric_limits<int>::max()) throw SceneError("it exceeds 2 GiB");
    int width = 0;
    int height = 0;
    int channels = 0;
    if (stbi_info_from_memory(bytes.data(), static_cast<int>(bytes.size()), &width, &height, &channels) ==
        0) {
        throw SceneError("it is not a readable Radiance picture");
    }
    return {width, height};
}

SkyPicture read_hdr(gltf::Bytes bytes) {
    int width = 0;
    int height = 0;
    int channels = 0;
    const Texels texels(
        stbi_loadf_from_memory(bytes.data(), static_cast<int>(bytes.size()), &width, &height, &channels, 3));
    if (texels == nullptr) throw SceneError(fmt::format("it cannot be decoded: {}", stbi_failure_reason()));
    return to_picture(width, height, texels, 3);
}

/// Throws if the library reports an error. Takes over its message.
void check_exr(int result, const char* message) {
    if (result == TINYEXR_SUCCESS) return;
    std::string reason = message != nullptr ? message : "it is damaged or of an unsupported kind";
    std::erase(reason, '\n');
    FreeEXRErrorMessage(message);
    throw SceneError(fmt::format("it is not a readable OpenEXR picture: {}", reason));
}

PictureSize exr_size(gltf::Bytes bytes) {
    EXRVersion version{};
    check_exr(ParseEXRVersionFromMemory(&version, bytes.data(), bytes.size()), nullptr);
    EXRHeader header{};
    InitEXRHeader(&header);
    const char* message = nullptr;
    check_exr(ParseEXRHeaderFromMemory(&header, &version, bytes.data(), bytes.size(), &message), message);
    const EXRBox2i window = header.data_window;
    FreeEXRHeader(&header);
    return {std::int64_t{window.max_x} - window.min_x + 1, std::int64_t{window.max_y} - window.min_y + 1};
}

SkyPicture read_exr(gltf::Bytes bytes) {
    const char* message = nullptr;
    float* loaded = nullptr;
    int width = 0;
    int height = 0;
    const int result = LoadEXRFromMemory(&loaded, &width, &height, bytes.data(), bytes.size(), &message);
    const Texels texels(loaded);
    check_exr(result, message);
    return to_picture(width, height, texels, 4);
}

}  // namespace

void check_sky_size(std::int64_t width, std::int64_t height) {
    if (width != 2 * height || width <= 0) {
        throw SceneError(
            fmt::format("it has {} × {} pixels and is not twice as wide as high", width, height));
    }
    if (width > widest) throw SceneError(fmt::format("it is {} pixels wide; {} are possible", width, widest));
}

PictureSize sky_picture_size(gltf::Bytes bytes) {
    if (!is_exr(bytes) && !gltf::starts_with(bytes, "#?")) {
        throw SceneError("it is neither a Radiance (.hdr) nor an OpenEXR (.exr) picture");
    }
    const PictureSize size = is_exr(bytes) ? exr_size(bytes) : hdr_size(bytes);
    check_sky_size(size.width, size.height);
    return size;
}

std::shared_ptr<const SkyPicture> decode_sky_picture(gltf::Bytes bytes) {
    static_cast<void>(sky_picture_size(bytes));  // checks it
    SkyPicture picture = is_exr(bytes) ? read_exr(bytes) : read_hdr(bytes);
    gltf::check(fault_of(picture));
    return std::make_shared<const SkyPicture>(std::move(picture));
}

std::shared_ptr<const SkyPicture> load_sky_picture(const std::filesystem::path& path) {
    return gltf::naming_file(gltf::utf8_of(path), [&] {
        gltf::ImportBudget budget({});
        return decode_sky_picture(gltf::read_file(path, "the file", budget));
    });
}

}  // namespace candela
