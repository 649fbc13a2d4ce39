#include "engine/import/export_draft.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>

#include <candela/scene/scene_error.hpp>
#include "engine/import/file_names.hpp"
#include "engine/import/gltf_schema.hpp"
#include "engine/import/shortest.hpp"

namespace candela::gltf {

namespace {

namespace fs = std::filesystem;

std::string percent_encoded(const std::string& name) {
    constexpr std::string_view plain =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";  // RFC 3986, unreserved
    std::string encoded;
    for (const char c : name) {
        encoded += plain.find(c) != std::string_view::npos
                       ? std::string(1, c)
                       : fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return encoded;
}

bool is_binary(const fs::path& path) {
    std::string extension = utf8_of(path.extension());
    std::ranges::transform(extension, extension.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    if (extension != ".gltf" && extension != ".glb") {
        throw SceneError("the file's name ends neither in .gltf nor in .glb");
    }
    return extension == ".glb";
}

std::vector<std::byte> to_bytes(std::string_view text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

std::string_view to_text(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void append_u32(std::string& file, std::size_t value) {
    for (unsigned int shift = 0; shift < 32; shift += 8) {
        file += static_cast<char>(value >> shift & 0xFFU);
    }
}

std::size_t padded(std::size_t size) {
    return (size + 3) / 4 * 4;
}

/// A chunk of a .glb: length, type and content, padded to four bytes.
void append_chunk(std::string& file, std::string_view type, std::string_view content, char padding) {
    append_u32(file, padded(content.size()));
    file += type;
    file += content;
    file.resize(padded(file.size()), padding);
}

/// The content of a .glb file. `buffer` may be empty.
std::string binary_container(const std::string& json, std::string_view buffer) {
    using namespace std::string_view_literals;
    std::string chunks;
    append_chunk(chunks, "JSON"sv, json, ' ');
    if (!buffer.empty()) append_chunk(chunks, "BIN\0"sv, buffer, '\0');
    constexpr std::size_t header = 12;
    if (chunks.size() > std::numeric_limits<std::uint32_t>::max() - header) {
        throw SceneError("a .glb file cannot exceed 4 GiB");
    }
    std::string file = "glTF";
    append_u32(file, 2);
    append_u32(file, header + chunks.size());
    return file + chunks;
}

}  // namespace

Json to_json(float number) {
    if (!std::isfinite(number)) throw SceneError("a number is not finite");
    return shortest(number);
}

Json to_json(const glm::vec3& vector) {
    return {to_json(vector.x), to_json(vector.y), to_json(vector.z)};
}

Json to_json(const glm::vec4& vector) {
    return {to_json(vector.x), to_json(vector.y), to_json(vector.z), to_json(vector.w)};
}

Json to_json(const glm::quat& rotation) {
    return to_json(glm::vec4(rotation.x, rotation.y, rotation.z, rotation.w));
}

Json bounds_of(std::span<const glm::vec3> positions) {
    glm::vec3 lower(std::numeric_limits<float>::infinity());
    glm::vec3 upper = -lower;
    for (const glm::vec3& position : positions) {
        lower = glm::min(lower, position);
        upper = glm::max(upper, position);
    }
    return {{"min", to_json(lower)}, {"max", to_json(upper)}};
}

Json to_json(const std::string& text) {
    Json json = text;
    try {
        static_cast<void>(json.dump());
    } catch (const Json::exception&) {
        throw SceneError("a name is not valid UTF-8");
    }
    return json;
}

Draft::Draft(const fs::path& path)
    : document{{"asset", {{"version", "2.0"}, {"generator", "Candela"}}}},
      path_(path),
      binary_(is_binary(path)) {}

std::size_t Draft::add(const char* list, Json item) {
    Json& items = document[list];
    items.push_back(std::move(item));
    return items.size() - 1;
}

std::size_t Draft::add_view(std::span<const std::byte> bytes, Json members) {
    buffer_.resize(padded(buffer_.size()));
    members.update({{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes.size()}});
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    return add("bufferViews", std::move(members));
}

std::size_t Draft::add_accessor(std::size_t view, int component_type, const char* type, std::size_t count,
                                Json members) {
    members.update(
        {{"bufferView", view}, {"componentType", component_type}, {"type", type}, {"count", count}});
    return add("accessors", std::move(members));
}

fs::path Draft::beside(std::string_view ending) const {
    fs::path path = path_.parent_path() / path_.stem();
    return path += ending;
}

Json Draft::add_picture(std::vector<std::byte> encoded, std::string_view ending) {
    if (binary_) return {{"bufferView", add_view(encoded)}};
    files_.push_back({beside(ending), std::move(encoded)});
    return {{"uri", percent_encoded(utf8_of(files_.back().path.filename()))}};
}

std::vector<OutputFile> Draft::finish() {
    if (!extensions_.empty()) document["extensionsUsed"] = extensions_;
    if (!buffer_.empty()) document["buffers"] = Json::array({Json{{"byteLength", buffer_.size()}}});
    if (!buffer_.empty() && !binary_) {
        files_.push_back({beside(".bin"), buffer_});
        document["buffers"][0]["uri"] = percent_encoded(utf8_of(files_.back().path.filename()));
    }
    const std::string json = document.dump(binary_ ? -1 : 1);
    check_schema(document);  // what the import would refuse is not written
    files_.push_back({path_, to_bytes(binary_ ? binary_container(json, to_text(buffer_)) : json)});
    return std::move(files_);
}

}  // namespace candela::gltf
