#pragma once

#include <cstddef>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/import/gltf_values.hpp"
#include "engine/import/output_files.hpp"

namespace candela::gltf {

/// Numbers with the fewest digits that are read back as the same floats. These functions throw SceneError if
/// a number is not finite.
[[nodiscard]] Json to_json(float number);
[[nodiscard]] Json to_json(const glm::vec3& vector);
[[nodiscard]] Json to_json(const glm::vec4& vector);
[[nodiscard]] Json to_json(const glm::quat& rotation);  ///< [x, y, z, w]

/// The members "min" and "max" that glTF requires of accessors of positions, also of offsets of these.
[[nodiscard]] Json bounds_of(std::span<const glm::vec3> positions);

/// Throws SceneError if it is not UTF-8, which JSON requires.
[[nodiscard]] Json to_json(const std::string& text);

/// A glTF file under construction: the document, its only buffer, and the files beside it.
class Draft {
 public:
    /// The file's extension decides: .gltf has its buffer and pictures in files beside it, .glb contains
    /// them. Throws SceneError if it is another.
    explicit Draft(const std::filesystem::path& path);

    Json document;
    std::vector<std::string> warnings;

    /// Appends an item to one of the document's lists and returns its index.
    std::size_t add(const char* list, Json item);

    /// Appends bytes to the buffer, as a view with further members of glTF's bufferView. Returns its index.
    std::size_t add_view(std::span<const std::byte> bytes, Json members = Json::object());

    /// Adds an accessor of so many elements of a view, with further members. Returns its index.
    std::size_t add_accessor(std::size_t view, int component_type, const char* type, std::size_t count,
                             Json members = Json::object());

    /// The members of an image or an environment that refer to this picture, an encoded file: `uri`, of a
    /// file whose name ends in `ending`, or `bufferView`.
    [[nodiscard]] Json add_picture(std::vector<std::byte> encoded, std::string_view ending);

    void use_extension(const char* name) { extensions_.insert(name); }

    /// The finished files, the glTF file last. Throws SceneError if it would be too large.
    [[nodiscard]] std::vector<OutputFile> finish();

 private:
    [[nodiscard]] std::filesystem::path beside(std::string_view ending) const;

    std::filesystem::path path_;
    bool binary_;
    std::vector<std::byte> buffer_;
    std::vector<OutputFile> files_;
    std::set<std::string> extensions_;
};

}  // namespace candela::gltf
