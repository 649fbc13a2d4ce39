#include "sandbox/files/folder.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include <candela/tools/output_file.hpp>

namespace candela::sandbox {

namespace {

namespace fs = std::filesystem;

char lower(char letter) {
    return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
}

std::string lower(std::string_view text) {
    std::string result(text);
    std::ranges::transform(result, result.begin(), [](char letter) { return lower(letter); });
    return result;
}

/// The part of what is typed up to its last slash, and the part behind it.
std::pair<std::string_view, std::string_view> split(std::string_view typed) {
    const std::size_t slash = typed.rfind('/');
    const std::size_t begin = slash == std::string_view::npos ? 0 : slash + 1;
    return {typed.substr(0, begin), typed.substr(begin)};
}

/// "folder/" has an empty name, and would be its own parent.
fs::path without_slash(const fs::path& path) {
    return !path.has_filename() && path.has_relative_path() ? path.parent_path() : path;
}

bool comes_before(const FolderEntry& a, const FolderEntry& b) {
    if (a.is_folder != b.is_folder) return a.is_folder;
    return std::pair(lower(a.name), a.name) < std::pair(lower(b.name), b.name);
}

}  // namespace

bool can_be_opened(const fs::path& file) {
    constexpr std::array<std::string_view, 4> extensions{".gltf", ".glb", ".hdr", ".exr"};
    return std::ranges::count(extensions, tools::lower_extension(file)) > 0;
}

Folder read_folder(const fs::path& path) {
    std::error_code error;
    Folder folder{fs::absolute(path, error).lexically_normal(), {}, {}};
    fs::directory_iterator at(folder.path, error);
    while (!error && at != fs::directory_iterator()) {
        std::string name = at->path().filename().string();
        std::error_code broken;  // a link to nothing is no folder
        const bool is_folder = at->is_directory(broken);
        if (!name.starts_with('.') && (is_folder || can_be_opened(name))) {
            folder.entries.push_back({std::move(name), is_folder});
        }
        at.increment(error);
    }
    if (error) folder.fault = fmt::format("{}: {}", folder.path.string(), error.message());
    std::ranges::sort(folder.entries, comes_before);
    return folder;
}

FolderBrowser::FolderBrowser(const fs::path& folder) {
    enter(folder);
}

void FolderBrowser::enter(const fs::path& folder) {
    std::error_code ignored;
    start_ = without_slash(fs::absolute(folder, ignored).lexically_normal());
    listed_ = {};
    type({});
}

void FolderBrowser::leave() {
    enter(listed_.path / "..");
}

void FolderBrowser::type(std::string text) {
    typed_ = std::move(text);
    marked_ = -1;
    list();
}

void FolderBrowser::list() {
    const auto [folder, begin] = split(typed_);
    const fs::path wanted = without_slash(absolute(folder).lexically_normal());
    if (listed_.path != wanted) listed_ = read_folder(wanted);
    matches_.clear();
    const std::string wanted_begin = lower(begin);
    std::ranges::copy_if(listed_.entries, std::back_inserter(matches_), [&](const FolderEntry& entry) {
        return lower(entry.name).starts_with(wanted_begin);
    });
}

/// "~" is the user's own folder.
fs::path FolderBrowser::absolute(std::string_view typed) const {
    if (typed.starts_with("~/")) {
        const char* home = std::getenv("HOME");  // NOLINT(concurrency-mt-unsafe): nothing sets variables
        if (home != nullptr) return fs::path(home) / typed.substr(2);
    }
    return start_ / typed;
}

std::string FolderBrowser::completed() const {
    if (matches_.empty()) return typed_;
    const auto [folder, begin] = split(typed_);
    std::string common = matches_.front().name;
    for (const FolderEntry& match : matches_) {
        const auto ends =
            std::ranges::mismatch(common, match.name, [](char a, char b) { return lower(a) == lower(b); });
        common.erase(ends.in1, common.end());
    }
    if (matches_.size() == 1 && matches_.front().is_folder) common += '/';
    return std::string(folder) + common;
}

void FolderBrowser::mark(std::ptrdiff_t steps) {
    const auto last = static_cast<std::ptrdiff_t>(matches_.size()) - 1;
    marked_ = std::min(std::max<std::ptrdiff_t>(marked_ + steps, 0), last);
}

const FolderEntry* FolderBrowser::marked() const {
    return marked_ < 0 ? nullptr : &matches_[static_cast<std::size_t>(marked_)];
}

fs::path FolderBrowser::picked() const {
    if (const FolderEntry* entry = marked()) return listed_.path / entry->name;
    return typed_.empty() ? fs::path() : absolute(typed_).lexically_normal();
}

}  // namespace candela::sandbox
