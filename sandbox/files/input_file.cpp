#include "sandbox/files/input_file.hpp"

#include <cerrno>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

namespace candela::sandbox {

std::string read_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        const std::string error = std::generic_category().message(errno);
        throw std::runtime_error(fmt::format("{}: cannot be read: {}", path.string(), error));
    }
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace candela::sandbox
