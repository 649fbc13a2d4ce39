#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <candela/ecs/world.hpp>
#include <candela/scene/gltf.hpp>
#include "tests/new_folder.hpp"

namespace candela::test {

using Json = nlohmann::json;
using Bytes = std::vector<unsigned char>;

/// Appends to Bytes what stb_image_write hands over.
inline void append(void* bytes, void* data, int size) {
    const auto* first = static_cast<unsigned char*>(data);
    static_cast<Bytes*>(bytes)->insert(static_cast<Bytes*>(bytes)->end(), first, first + size);
}

/// A new directory, removed with its contents on destruction.
class TemporaryDirectory {
 public:
    TemporaryDirectory() = default;
    TemporaryDirectory(const TemporaryDirectory&) = delete;
    TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
    ~TemporaryDirectory() { std::filesystem::remove_all(path_); }

    [[nodiscard]] std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
    std::filesystem::path path_ = new_folder();
};

inline void write_file(const std::filesystem::path& path, const Bytes& bytes) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

inline std::string base64(const Bytes& bytes) {
    constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = i; k < i + 3; ++k) {
            group = group << 8U | (k < bytes.size() ? bytes[k] : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k <= bytes.size() ? digits[group >> (18U - 6U * k) & 63U] : '=';
        }
    }
    return text;
}

/// Two pixels of 16-bit RGB: FFFF 8000 00FF and 1234 0000 ABCD.
inline constexpr const char* sixteen_bit_png =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABEAIAAAAr0DSeAAAAFUlEQVR42mP4/7+BgeG/"
    "kAkDw+qzACaCBTwobBa7AAAAAElFTkSuQmCC";

inline Bytes to_bytes(const std::string& text) {
    return {text.begin(), text.end()};
}

/// A glTF file under construction: a JSON document that tests may edit, and its only buffer.
struct GltfBuilder {
    Json document = Json::parse(R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
                                    "nodes": [{"mesh": 0}], "meshes": [{"primitives": []}]})");
    Bytes data;

    std::size_t add(const char* list, Json item) {
        document[list].push_back(std::move(item));
        return document[list].size() - 1;
    }

    template <class T>
    std::size_t add_view(const std::vector<T>& values) {
        data.resize((data.size() + 3) / 4 * 4);
        const std::size_t offset = data.size();
        data.resize(offset + values.size() * sizeof(T));
        std::memcpy(data.data() + offset, values.data(), values.size() * sizeof(T));
        return add("bufferViews",
                   {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", values.size() * sizeof(T)}});
    }

    /// Tightly packed, in a separate buffer view.
    template <class T>
    std::size_t add_accessor(const std::vector<T>& values, int component_type, const char* type,
                             std::size_t components) {
        const std::size_t view = add_view(values);
        return add("accessors", {{"bufferView", view},
                                 {"componentType", component_type},
                                 {"count", values.size() / components},
                                 {"type", type}});
    }
    std::size_t add_vectors(const std::vector<float>& values) {
        return add_accessor(values, 5126, "VEC3", 3);
    }
    std::size_t add_indices(const std::vector<std::uint16_t>& values) {
        return add_accessor(values, 5123, "SCALAR", 1);
    }

    Json& primitive(std::size_t index = 0) { return document["meshes"][0]["primitives"][index]; }

    /// Adds a primitive to the first mesh.
    Json& add_primitive(const std::vector<float>& positions) {
        const std::size_t accessor = add_vectors(positions);
        Json& primitives = document["meshes"][0]["primitives"];
        primitives.push_back({{"attributes", {{"POSITION", accessor}}}});
        return primitives.back();
    }

    [[nodiscard]] Json buffer(const std::string& uri) const {
        return {{"byteLength", data.size()}, {"uri", uri}};
    }

    /// The document with its buffer as a data URI.
    [[nodiscard]] Bytes gltf() const {
        Json complete = document;
        if (!data.empty()) {
            complete["buffers"].push_back(buffer("data:application/octet-stream;base64," + base64(data)));
        }
        return to_bytes(complete.dump());
    }

    /// The document with its buffer, if any, as a binary chunk.
    [[nodiscard]] Bytes glb() const {
        Json complete = document;
        if (!data.empty()) complete["buffers"].push_back({{"byteLength", data.size()}});
        const std::string json = complete.dump();

        Bytes chunks;
        append_chunk(chunks, 0x4E4F534A, to_bytes(json), ' ');
        if (!data.empty()) append_chunk(chunks, 0x004E4942, data, 0);
        Bytes file;
        for (const std::size_t word : {std::size_t{0x46546C67}, std::size_t{2}, 12 + chunks.size()}) {
            append_u32(file, word);
        }
        file.insert(file.end(), chunks.begin(), chunks.end());
        return file;
    }

 private:
    static void append_u32(Bytes& bytes, std::size_t value) {
        for (unsigned int shift = 0; shift < 32; shift += 8) {
            bytes.push_back(static_cast<unsigned char>(value >> shift));
        }
    }

    static void append_chunk(Bytes& bytes, std::uint32_t type, Bytes content, unsigned char padding) {
        content.resize((content.size() + 3) / 4 * 4, padding);
        append_u32(bytes, content.size());
        append_u32(bytes, type);
        bytes.insert(bytes.end(), content.begin(), content.end());
    }
};

/// One right triangle in the plane z = 0, facing +Z, without indices, normals or material.
inline GltfBuilder right_triangle() {
    GltfBuilder file;
    file.add_primitive({0, 0, 0, 1, 0, 0, 0, 1, 0});
    return file;
}

/// A world with the contents of a file, and the import report.
struct Imported {
    World world;
    ImportReport report;

    explicit Imported(const Bytes& file, const std::filesystem::path& directory = {})
        : report(import_gltf(file, directory, "test.gltf", world)) {}
    explicit Imported(const GltfBuilder& file) : Imported(file.gltf()) {}

    [[nodiscard]] Entity find(const std::string& name) const {
        for (auto [entity, called] : world.view<Name>()) {
            if (called.value == name) return entity;
        }
        return {};
    }
    [[nodiscard]] const Mesh& mesh() const { return *world.get<MeshInstance>(report.entities.front()).mesh; }
    [[nodiscard]] const Primitive& primitive() const { return mesh().primitives.at(0); }

    /// The corners of the first primitive's triangles, in order.
    [[nodiscard]] std::vector<Vertex> corners() const {
        std::vector<Vertex> corners;
        for (const std::uint32_t index : primitive().indices) {
            corners.push_back(primitive().vertices.at(index));
        }
        return corners;
    }
    [[nodiscard]] std::vector<glm::vec3> positions() const {
        std::vector<glm::vec3> positions;
        for (const Vertex& corner : corners()) {
            positions.push_back(corner.position);
        }
        return positions;
    }
};

}  // namespace candela::test
