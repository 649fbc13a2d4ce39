#include "sandbox/files/input_file.hpp"

#include <cerrno>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

namespace candela::sandbox {

std::string read_file(const std::filesystem::path& path) {
    namespace fs = std::filesystem;
    const auto fail = [&](std::string_view what) {
        throw std::runtime_error(fmt::format("{}: {}", path.string(), what));
    };
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (fs::exists(status) && !fs::is_regular_file(status)) fail("is not a regular file");
    std::ifstream file(path, std::ios::binary);
    if (!file) fail("cannot be read: " + std::generic_category().message(errno));
    const std::uintmax_t size = fs::file_size(path, error);
    if (!error && size > largest_text) {
        fail(fmt::format("has {} bytes; {} are read at most", size, largest_text));
    }
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace candela::sandbox
