#include "tests/sandbox/picture_reader.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cerrno>
#include <cstddef>
#include <cstdint>
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
#include <tinyexr.h>

namespace candela::sandbox {

namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "PFM is read as memory holds floats");

/// Memory allocated by a C library.
template <typename T>
using CMemory = std::unique_ptr<T, decltype(&std::free)>;

[[noreturn]] void fail(const fs::path& path, std::string_view error) {
    throw std::runtime_error(fmt::format("{}: {}", path.string(), error));
}

std::size_t pixel_count(glm::ivec2 size) {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
}

std::string read_bytes(const fs::path& path) {
    if (fs::is_directory(path)) fail(path, "cannot be read: is a folder");
    std::ifstream file(path, std::ios::binary);
    if (!file) fail(path, fmt::format("cannot be read: {}", std::generic_category().message(errno)));
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Throws with the message of tinyexr, and frees it.
[[noreturn]] void fail_exr(const fs::path& path, std::string_view action, const char* message) {
    const std::string error = message != nullptr ? message : "unknown error";
    FreeEXRErrorMessage(message);
    fail(path, fmt::format("{}: {}", action, error));
}

/// The bytes in reverse order.
std::uint32_t swapped(std::uint32_t bits) {
    return bits << 24 | (bits & 0xff00U) << 8 | (bits >> 8 & 0xff00U) | bits >> 24;
}

struct FloatMapHeader {
    std::size_t channels = 0;
    glm::ivec2 size{0};
    bool big_endian = false;
    std::size_t length = 0;  ///< bytes before the pixels
};

FloatMapHeader read_float_map_header(const fs::path& path, const std::string& file) {
    std::istringstream stream(file);
    std::string kind;
    FloatMapHeader header;
    float scale = 0.0F;
    stream >> kind >> header.size.x >> header.size.y >> scale;
    // One white-space character ends the header; then the pixels follow.
    const bool ends = stream && std::isspace(stream.get()) != 0;
    if (!ends || (kind != "PF" && kind != "Pf") || header.size.x <= 0 || header.size.y <= 0 ||
        scale == 0.0F) {
        fail(path, "is no PFM picture");
    }
    header.channels = kind == "PF" ? 3 : 1;
    header.big_endian = scale > 0.0F;
    header.length = static_cast<std::size_t>(stream.tellg());
    return header;
}

/// The floats of a PFM file, in file order.
std::vector<float> floats_of(const fs::path& path, const std::string& file, const FloatMapHeader& header) {
    const std::size_t length = file.size() - header.length;
    const std::size_t pixel_length = header.channels * sizeof(float);
    if (length % pixel_length != 0 || length / pixel_length != pixel_count(header.size)) {
        fail(path, fmt::format("does not hold the {}x{} pixels that its header announces", header.size.x,
                               header.size.y));
    }
    std::vector<std::uint32_t> bits(length / sizeof(float));
    std::memcpy(bits.data(), file.data() + header.length, length);
    if (header.big_endian) std::transform(bits.begin(), bits.end(), bits.begin(), swapped);
    std::vector<float> floats(bits.size());
    std::memcpy(floats.data(), bits.data(), length);
    return floats;
}

}  // namespace

tools::Picture read_exr(const fs::path& path) {
    const std::string file = read_bytes(path);
    float* memory = nullptr;
    const char* message = nullptr;
    tools::Picture picture;
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

tools::Picture read_pfm(const fs::path& path) {
    const std::string file = read_bytes(path);
    const FloatMapHeader header = read_float_map_header(path, file);
    const std::vector<float> floats = floats_of(path, file, header);
    tools::Picture picture{header.size, {}};
    picture.pixels.reserve(pixel_count(header.size));
    const std::size_t row_length = static_cast<std::size_t>(header.size.x) * header.channels;
    for (std::size_t row = floats.size(); row > 0; row -= row_length) {
        for (std::size_t i = row - row_length; i < row; i += header.channels) {
            const std::size_t last = header.channels - 1;  // 0 in grey: all three channels are the same float
            picture.pixels.emplace_back(floats[i], floats[i + last / 2], floats[i + last]);
        }
    }
    return picture;
}

}  // namespace candela::sandbox
