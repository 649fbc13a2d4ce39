#include "sandbox/picture.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <stb/stb_image_write.h>
#include <tinyexr.h>

#include "sandbox/output_file.hpp"

namespace candela::sandbox {

namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "PFM is read and written as memory holds floats");
static_assert(sizeof(glm::vec3) == 3 * sizeof(float));

/// Memory that a C library allocated.
template <typename T>
using CMemory = std::unique_ptr<T, decltype(&std::free)>;

[[noreturn]] void fail(const fs::path& path, std::string_view fault) {
    throw std::runtime_error(fmt::format("{}: {}", path.string(), fault));
}

std::size_t pixel_count(glm::ivec2 size) {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
}

void require_size(const fs::path& path, glm::ivec2 size, std::size_t pixels) {
    if (size.x > 0 && size.y > 0 && pixel_count(size) == pixels) return;
    fail(path, fmt::format("{} pixels do not make a picture of {}x{}", pixels, size.x, size.y));
}

std::string read_bytes(const fs::path& path) {
    if (fs::is_directory(path)) fail(path, "cannot be read: is a folder");
    std::ifstream file(path, std::ios::binary);
    if (!file) fail(path, fmt::format("cannot be read: {}", std::generic_category().message(errno)));
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Throws with tinyexr's own words, which it hands over in memory to be freed.
[[noreturn]] void fail_exr(const fs::path& path, std::string_view action, const char* message) {
    const std::string fault = message != nullptr ? message : "unknown fault";
    FreeEXRErrorMessage(message);
    fail(path, fmt::format("{}: {}", action, fault));
}

/// OpenEXR stores channels apart, in the order of their names: blue, green, red.
std::array<std::vector<float>, 3> planes_bgr(const Picture& picture) {
    std::array<std::vector<float>, 3> planes;
    for (int channel = 0; channel < 3; ++channel) {
        std::vector<float>& plane = planes[static_cast<std::size_t>(channel)];
        plane.reserve(picture.pixels.size());
        for (const glm::vec3& pixel : picture.pixels) plane.push_back(pixel[2 - channel]);
    }
    return planes;
}

}  // namespace

void write_png(const fs::path& path, glm::ivec2 size, std::span<const std::uint8_t> rgb) {
    require_size(path, size, rgb.size() / 3);
    std::vector<char> png;
    const auto store = [](void* context, void* data, int length) {
        const auto* bytes = static_cast<const char*>(data);
        static_cast<std::vector<char>*>(context)->assign(bytes, bytes + length);
    };
    if (stbi_write_png_to_func(store, &png, size.x, size.y, 3, rgb.data(), 3 * size.x) == 0) {
        fail(path, "cannot be encoded as PNG");
    }
    write_file(path, std::as_bytes(std::span(png)));
}

void write_exr(const fs::path& path, const Picture& picture) {
    require_size(path, picture.size, picture.pixels.size());
    std::array<std::vector<float>, 3> planes = planes_bgr(picture);
    std::array<unsigned char*, 3> plane_bytes{};
    std::array<EXRChannelInfo, 3> channels{};
    std::array<int, 3> types{};
    types.fill(TINYEXR_PIXELTYPE_FLOAT);
    for (std::size_t i = 0; i < planes.size(); ++i) {
        plane_bytes[i] = reinterpret_cast<unsigned char*>(planes[i].data());
        channels[i].name[0] = "BGR"[i];
    }

    EXRImage exr;
    InitEXRImage(&exr);
    exr.images = plane_bytes.data();
    exr.width = picture.size.x;
    exr.height = picture.size.y;
    exr.num_channels = 3;
    EXRHeader header;
    InitEXRHeader(&header);
    header.num_channels = 3;
    header.channels = channels.data();
    header.pixel_types = types.data();
    header.requested_pixel_types = types.data();
    header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;

    unsigned char* memory = nullptr;
    const char* message = nullptr;
    const std::size_t length = SaveEXRImageToMemory(&exr, &header, &memory, &message);
    const CMemory<unsigned char> file(memory, &std::free);
    if (length == 0) fail_exr(path, "cannot be encoded as OpenEXR", message);
    write_file(path, std::as_bytes(std::span(file.get(), length)));
}

void write_pfm(const fs::path& path, const Picture& picture) {
    require_size(path, picture.size, picture.pixels.size());
    std::string file = fmt::format("PF\n{} {}\n-1.0\n", picture.size.x, picture.size.y);
    const auto row_length = static_cast<std::size_t>(picture.size.x);
    for (std::size_t row = picture.pixels.size(); row > 0; row -= row_length) {
        const auto* floats = reinterpret_cast<const char*>(&picture.pixels[row - row_length]);
        file.append(floats, row_length * sizeof(glm::vec3));
    }
    write_file(path, std::as_bytes(std::span(file)));
}

Picture read_exr(const fs::path& path) {
    const std::string file = read_bytes(path);
    float* memory = nullptr;
    const char* message = nullptr;
    Picture picture;
    const int status =
        LoadEXRFromMemory(&memory, &picture.size.x, &picture.size.y,
                          reinterpret_cast<const unsigned char*>(file.data()), file.size(), &message);
    const CMemory<float> rgba(memory, &std::free);
    if (status != TINYEXR_SUCCESS) fail_exr(path, "cannot be read as OpenEXR", message);
    picture.pixels.reserve(pixel_count(picture.size));
    for (std::size_t i = 0; i < pixel_count(picture.size); ++i) {
        const float* pixel = rgba.get() + 4 * i;
        picture.pixels.emplace_back(pixel[0], pixel[1], pixel[2]);
    }
    return picture;
}

Picture read_pfm(const fs::path& path) {
    const std::string file = read_bytes(path);
    std::istringstream header(file);
    std::string magic;
    Picture picture;
    float scale = 0.0F;
    header >> magic >> picture.size.x >> picture.size.y >> scale;
    if (!header || magic != "PF" || picture.size.x <= 0 || picture.size.y <= 0)
        fail(path, "is no PFM picture in colour");
    if (scale >= 0.0F) fail(path, "is a big-endian PFM; only little-endian ones are read");

    // One white-space character, then the pixels to the end.
    const auto start = static_cast<std::size_t>(header.tellg()) + 1;
    const std::size_t length = file.size() - std::min(start, file.size());
    if (length % sizeof(glm::vec3) != 0 || length / sizeof(glm::vec3) != pixel_count(picture.size)) {
        fail(path, fmt::format("does not hold the {}x{} pixels that its header announces", picture.size.x,
                               picture.size.y));
    }
    picture.pixels.resize(pixel_count(picture.size));
    const auto row_length = static_cast<std::size_t>(picture.size.x);
    const char* source = file.data() + start;
    for (std::size_t row = picture.pixels.size(); row > 0; row -= row_length) {
        std::memcpy(&picture.pixels[row - row_length], source, row_length * sizeof(glm::vec3));
        source += row_length * sizeof(glm::vec3);
    }
    return picture;
}

}  // namespace candela::sandbox
