#include "tests/study/scene_hash.hpp"

#include <fmt/format.h>

#include <candela/scene/scene_error.hpp>
#include "engine/import/gltf_document.hpp"

namespace candela::study {
namespace {

/// Adds the length first, so that moving bytes from one content to the next changes the hash.
std::uint64_t add(std::uint64_t state, gltf::Bytes content) {
    state = fnv1a(fmt::format("{};", content.size()), state);
    return fnv1a({reinterpret_cast<const char*>(content.data()), content.size()}, state);
}

std::uint64_t hash_contents(const std::filesystem::path& scene) {
    gltf::ImportBudget budget({});
    const std::vector<unsigned char> bytes = gltf::read_file(scene, "the file", budget);
    gltf::ImportFiles files(scene.parent_path(), scene.parent_path(), budget);
    const gltf::Document document = gltf::read_document(bytes, files, budget);
    std::uint64_t state = add(fnv1a_basis, bytes);
    for (const gltf::Buffer& buffer : document.buffers) {
        state = add(state, buffer.bytes);
    }
    for (const gltf::Json& image : document.all("images")) {
        if (const std::string uri = gltf::text_in(image, "uri"); !uri.empty()) {
            state = add(state, *files.read(uri));
        }
    }
    return state;
}

}  // namespace

std::uint64_t fnv1a(std::string_view bytes, std::uint64_t state) {
    for (const char byte : bytes) {
        state = (state ^ static_cast<unsigned char>(byte)) * 0x100000001b3U;
    }
    return state;
}

std::string scene_hash(const std::filesystem::path& scene) {
    try {
        return fmt::format("{:016x}", hash_contents(scene));
    } catch (const std::runtime_error& error) {
        throw SceneError(fmt::format("{}: {}", scene.string(), error.what()));
    }
}

}  // namespace candela::study
