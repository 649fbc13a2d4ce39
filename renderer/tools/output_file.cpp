#include <candela/tools/output_file.hpp>

#include <algorithm>
#include <system_error>

#include <fmt/format.h>

#include <candela/scene/scene_error.hpp>
#include <candela/tools/tool_error.hpp>
#include "engine/import/output_files.hpp"

namespace candela::tools {

namespace {

namespace fs = std::filesystem;

void replace_file(const fs::path& path, std::span<const std::byte> bytes) {
    try {
        write_files(std::vector<OutputFile>{{path, {bytes.begin(), bytes.end()}}});
    } catch (const SceneError& error) {
        throw ToolError(error.what());
    }
}

}  // namespace

void write_file(const fs::path& path, std::span<const std::byte> bytes) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    if (!fs::exists(status)) return replace_file(path, bytes);
    // A symbolic link stays a link: its target is replaced.
    if (fs::is_regular_file(status)) return replace_file(fs::canonical(path), bytes);
    if (const std::error_code error = write_bytes(path, bytes)) {
        throw ToolError(fmt::format("{}: cannot be written: {}", path.string(), error.message()));
    }
}

void write_text(const fs::path& path, std::string_view text) {
    write_file(path, std::as_bytes(std::span(text)));
}

std::string lower_extension(const fs::path& path) {
    std::string extension = path.extension().string();
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    std::transform(extension.begin(), extension.end(), extension.begin(), lower);
    return extension;
}

}  // namespace candela::tools
