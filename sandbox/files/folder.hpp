#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace candela::sandbox {

/// Whether the app can open a file with this name: a scene or a sky.
[[nodiscard]] bool can_be_opened(const std::filesystem::path& file);

/// A file or a folder in a folder.
struct FolderEntry {
    std::string name;
    bool is_folder = false;
    bool operator==(const FolderEntry&) const = default;
};

/// What a user may pick in a folder.
struct Folder {
    std::filesystem::path path;        ///< absolute
    std::vector<FolderEntry> entries;  ///< folders, then files that can be opened, by name; none are hidden
    std::string fault;                 ///< why it cannot be read, one line with its path; else empty
};

/// Reads a folder. Throws nothing because of the file system.
[[nodiscard]] Folder read_folder(const std::filesystem::path& path);

/// A folder that a user goes through, and a name that is typed there. The name may lead into other folders:
/// "../lamps/old", "/tmp/" and "~/scenes/" are names, too.
class FolderBrowser {
 public:
    explicit FolderBrowser(const std::filesystem::path& folder);

    /// Goes to a folder, with nothing typed.
    void enter(const std::filesystem::path& folder);
    /// Goes to the folder around the present one.
    void leave();
    /// Replaces what is typed. The folder that is listed follows it.
    void type(std::string text);
    [[nodiscard]] const std::string& typed() const { return typed_; }
    /// What Tab makes of it: as much more as all matches have in common; of a single match all of it.
    [[nodiscard]] std::string completed() const;

    /// The folder that is listed.
    [[nodiscard]] const Folder& folder() const { return listed_; }
    /// The entries that begin with the end of what is typed; upper and lower case are the same.
    [[nodiscard]] const std::vector<FolderEntry>& matches() const { return matches_; }

    /// Marks the match that many places further down; at the ends it stays. The first step down marks the
    /// first one.
    void mark(std::ptrdiff_t steps);
    [[nodiscard]] const FolderEntry* marked() const;

    /// The path of what Return picks: the marked match, else what is typed; empty if there is neither. If
    /// that is a folder, `enter` it.
    [[nodiscard]] std::filesystem::path picked() const;

 private:
    void list();
    [[nodiscard]] std::filesystem::path absolute(std::string_view typed) const;

    std::filesystem::path start_;
    std::string typed_;
    Folder listed_;
    std::vector<FolderEntry> matches_;
    std::ptrdiff_t marked_ = -1;
};

}  // namespace candela::sandbox
