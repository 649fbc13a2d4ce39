#include "sandbox/files/recent_files.hpp"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include <candela/tools/output_file.hpp>

namespace candela::sandbox {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_path = 4096;  // bytes; Linux's PATH_MAX

/// Empty unless it is absolute, as the XDG Base Directory Specification demands.
fs::path folder_from(const char* variable) {
    const char* value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nothing sets variables
    const fs::path folder = value != nullptr ? value : "";
    return folder.is_absolute() ? folder : fs::path();
}

bool is_listable(const std::string& path) {
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' '; };
    return path.starts_with('/') && path.size() < longest_path &&
           std::none_of(path.begin(), path.end(), is_control);
}

/// Also those that do not exist.
std::vector<fs::path> read_list(const fs::path& list) {
    std::string text(most_recent_files * longest_path, '\0');
    std::ifstream file(list, std::ios::binary);
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));

    std::vector<fs::path> paths;
    std::size_t begin = 0;
    while (begin < text.size() && paths.size() < most_recent_files) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        std::string line = text.substr(begin, end - begin);
        if (is_listable(line)) paths.emplace_back(std::move(line));
        begin = end + 1;
    }
    return paths;
}

void write_list(const fs::path& list, const std::vector<fs::path>& paths) {
    std::string text;
    for (const fs::path& path : paths) text += path.string() + '\n';
    fs::create_directories(list.parent_path());
    tools::write_text(list, text);
}

}  // namespace

fs::path recent_files_list() {
    const fs::path state = folder_from("XDG_STATE_HOME");
    if (!state.empty()) return state / "candela/recent";
    const fs::path home = folder_from("HOME");
    return home.empty() ? home : home / ".local/state/candela/recent";
}

std::vector<fs::path> recent_files(const fs::path& list) {
    std::vector<fs::path> paths = read_list(list);
    std::erase_if(paths, [](const fs::path& path) {
        std::error_code ignored;
        return !fs::is_regular_file(path, ignored);
    });
    return paths;
}

void add_recent_file(const fs::path& list, const fs::path& scene) {
    if (list.empty()) return;
    try {
        const fs::path added = fs::absolute(scene).lexically_normal();
        if (!is_listable(added.string())) return;
        std::vector<fs::path> paths = read_list(list);
        std::erase(paths, added);
        paths.insert(paths.begin(), added);
        paths.resize(std::min(paths.size(), most_recent_files));
        write_list(list, paths);
    } catch (const std::exception&) {
        // A list that cannot be written is no reason to disturb the user.
    }
}

}  // namespace candela::sandbox
