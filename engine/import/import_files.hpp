#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/import/import_budget.hpp"

namespace candela::gltf {

using Bytes = std::span<const unsigned char>;

/// Bytes that several parts of a document may share.
using Content = std::shared_ptr<const std::vector<unsigned char>>;

/// Whether a file of these bytes begins with `prefix`, which tells what kind of file it is.
[[nodiscard]] bool starts_with(Bytes bytes, std::string_view prefix);

/// Reads a whole regular file, whose bytes it adds to the budget first. Throws PieceError if there is none or
/// it cannot be read, SceneError if it exceeds the budget; both name the file as `called`.
[[nodiscard]] std::vector<unsigned char> read_file(const std::filesystem::path& path, std::string_view called,
                                                   ImportBudget& budget);

/// The files that a document refers to. Each is read once, whatever it is called.
class ImportFiles {
 public:
    /// URIs are relative to `base_directory`. Only files in `root`, or below it, are read; links are followed
    /// first. Both may be empty for the current directory. `budget` must outlive this object.
    ImportFiles(std::filesystem::path base_directory, std::filesystem::path root, ImportBudget& budget);

    /// The bytes behind a URI: a base64 data URI, or a percent-encoded file path. Throws PieceError if
    /// there are none, SceneError for a path that leads out of the root; both name the URI.
    [[nodiscard]] Content read(const std::string& uri);

 private:
    [[nodiscard]] std::filesystem::path resolve(const std::string& path, std::string_view called) const;

    std::filesystem::path base_directory_;
    std::filesystem::path root_;
    ImportBudget& budget_;
    std::map<std::filesystem::path, Content> files_;  // by canonical path
};

}  // namespace candela::gltf
