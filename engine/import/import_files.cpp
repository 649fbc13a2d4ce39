#include "engine/import/import_files.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <candela/scene/scene_error.hpp>
#include "engine/import/file_names.hpp"
#include "engine/import/piece_error.hpp"
#include "engine/readable.hpp"

namespace candela::gltf {

namespace {

namespace fs = std::filesystem;

std::string percent_decoded(std::string_view uri) {
    std::string decoded;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned char code = 0;
        const char* digits = uri.data() + i + 1;
        if (uri[i] == '%' && uri.size() - i > 2 &&
            std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2) {
            decoded += static_cast<char>(code);
            i += 2;
        } else {
            decoded += uri[i];
        }
    }
    return decoded;
}

Content decode_data(const std::string& uri) {
    std::vector<unsigned char> bytes;
    std::string media_type;
    if (!tinygltf::DecodeDataURI(&bytes, media_type, uri, 0, false)) {
        throw PieceError(
            fmt::format("the data URI {}... is empty or of an unknown kind", readable(uri.substr(0, 40))));
    }
    return std::make_shared<const std::vector<unsigned char>>(std::move(bytes));
}

fs::path or_current(fs::path folder) {
    return folder.empty() ? "." : std::move(folder);
}

/// Whether the path begins with the folder; both are canonical.
bool is_below(const fs::path& path, const fs::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace

bool starts_with(Bytes bytes, std::string_view prefix) {
    return bytes.size() >= prefix.size() && std::memcmp(bytes.data(), prefix.data(), prefix.size()) == 0;
}

std::vector<unsigned char> read_file(const fs::path& path, std::string_view called, ImportBudget& budget) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found) throw PieceError(fmt::format("{} does not exist", called));
    if (!fs::is_regular_file(status)) throw PieceError(fmt::format("{} is not a file", called));
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    const std::streamoff size = file ? std::streamoff{file.tellg()} : 0;
    budget.add_file(static_cast<std::uint64_t>(size));
    std::vector<unsigned char> bytes(static_cast<std::size_t>(size));
    file.seekg(0).read(reinterpret_cast<char*>(bytes.data()), size);
    if (!file) throw PieceError(fmt::format("{} cannot be read", called));
    return bytes;
}

ImportFiles::ImportFiles(fs::path base_directory, fs::path root, ImportBudget& budget)
    : base_directory_(or_current(std::move(base_directory))),
      root_(or_current(std::move(root))),
      budget_(budget) {}

/// The canonical path of a file inside the root.
fs::path ImportFiles::resolve(const std::string& path, std::string_view called) const {
    if (path.find('\0') != std::string::npos) {
        throw SceneError(fmt::format("{} contains a NUL character", called));
    }
    const auto outside = [&] {
        return SceneError(fmt::format("{} is outside of the folder that files are read from", called));
    };
    const fs::path name = path_of(path);
    if (name.has_root_name()) throw outside();  // Windows would call a server of this name
    std::error_code error;
    fs::path found = fs::weakly_canonical(base_directory_ / name, error);
    const fs::path root = fs::weakly_canonical(root_, error);
    if (error) throw SceneError(fmt::format("{} cannot be read", called));
    if (!is_below(found, root)) throw outside();
    return found;
}

Content ImportFiles::read(const std::string& uri) {
    if (uri.starts_with("data:")) return decode_data(uri);
    const std::string called = readable(uri);
    const fs::path path = resolve(percent_decoded(uri), called);
    Content& content = files_[path];
    if (!content) {
        content = std::make_shared<const std::vector<unsigned char>>(read_file(path, called, budget_));
    }
    return content;
}

}  // namespace candela::gltf
