#include "sandbox/output_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

namespace candela::sandbox {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::error_code& error) {
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", path.string(), error.message()));
}

std::error_code last_error() {
    return {errno, std::generic_category()};
}

std::error_code write_bytes(const fs::path& path, const char* mode, std::span<const std::byte> bytes) {
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), mode), &std::fclose);
    if (!file) return last_error();
    if (std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) return last_error();
    // Buffered bytes are written on close, so only fclose reports that the disk is full.
    return std::fclose(file.release()) == 0 ? std::error_code{} : last_error();
}

void replace_file(const fs::path& path, std::span<const std::byte> bytes) {
    fs::path fresh = path;
    fresh += fmt::format(".{}.part", ::getpid());
    std::error_code error = write_bytes(fresh, "wb", bytes);
    if (!error) fs::rename(fresh, path, error);
    if (!error) return;
    std::error_code ignored;
    fs::remove(fresh, ignored);
    fail(path, error);
}

}  // namespace

void write_file(const fs::path& path, std::span<const std::byte> bytes) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    if (!fs::exists(status)) return replace_file(path, bytes);
    // A symbolic link stays a link: its target is replaced.
    if (fs::is_regular_file(status)) return replace_file(fs::canonical(path), bytes);
    if (const std::error_code error = write_bytes(path, "wb", bytes)) fail(path, error);
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

}  // namespace candela::sandbox
