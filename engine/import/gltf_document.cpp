#include "engine/import/gltf_document.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include <candela/scene/scene_error.hpp>
#include "engine/import/gltf_compressed.hpp"
#include "engine/import/gltf_constants.hpp"
#include "engine/import/gltf_schema.hpp"
#include "engine/import/naming.hpp"
#include "engine/readable.hpp"

namespace candela::gltf {

namespace {

/// The two parts of a glTF file. A .gltf has no binary part.
struct Container {
    Bytes json;
    std::optional<Bytes> binary;
};

std::uint32_t read_u32(Bytes bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) {
        value = value << 8U | bytes[offset + i];
    }
    return value;
}

/// Removes one chunk of a .glb from the front of `rest` and returns its data.
Bytes take_chunk(Bytes& rest, std::string_view type) {
    if (rest.size() < 8) throw SceneError("the .glb ends inside a chunk's header");
    const std::uint32_t length = read_u32(rest, 0);
    if (!std::ranges::equal(rest.subspan(4, 4), type)) {
        throw SceneError(fmt::format("the .glb lacks its {} chunk", type.substr(0, type.find('\0'))));
    }
    if (length > rest.size() - 8) throw SceneError("the .glb ends inside a chunk");
    const Bytes chunk = rest.subspan(8, length);
    // The last chunk's padding may be missing; chunks in between are aligned to four bytes.
    rest = rest.subspan(std::min<std::size_t>(rest.size(), 8 + (std::size_t{length} + 3) / 4 * 4));
    return chunk;
}

/// Fails if no text begins with this byte.
void require_text(std::uint8_t first) {
    const bool is_space = first == ' ' || first == '\t' || first == '\r' || first == '\n';
    if (first > ' ' || is_space) return;
    throw SceneError(fmt::format(
        "is no glTF file: it begins with the byte {:#04x}, where text or the sign of a .glb has to be",
        first));
}

Container split(Bytes bytes) {
    using namespace std::string_view_literals;
    if (bytes.empty()) throw SceneError("the file is empty");
    if (bytes.size() < 4 || !std::ranges::equal(bytes.first(4), "glTF"sv)) {
        require_text(bytes.front());
        return {bytes, {}};
    }
    if (bytes.size() < 12) throw SceneError("the .glb ends inside its header");
    if (read_u32(bytes, 4) != 2) {
        throw SceneError(fmt::format("the .glb has version {}; only 2 is read", read_u32(bytes, 4)));
    }
    const std::uint32_t length = read_u32(bytes, 8);
    if (length < 12 || length > bytes.size()) {
        throw SceneError(
            fmt::format("the .glb says it has {} bytes, but {} are there", length, bytes.size()));
    }
    Bytes rest = bytes.subspan(12, length - 12);
    Container container{take_chunk(rest, "JSON"sv), {}};
    if (!rest.empty()) container.binary = take_chunk(rest, "BIN\0"sv);
    return container;
}

/// The names of extensions in one of the document's lists.
std::set<std::string> extensions_in(const Json& document, const char* member) {
    return list_in(document, member).get<std::set<std::string>>();
}

/// A warning for each extension that the file requires or uses and that is not supported.
std::vector<std::string> check_extensions(const Json& document) {
    const std::set<std::string> required = extensions_in(document, "extensionsRequired");
    std::set<std::string> used = extensions_in(document, "extensionsUsed");
    used.insert(required.begin(), required.end());
    std::vector<std::string> warnings;
    for (const std::string& name : used) {
        if (is_supported(name)) continue;
        if (is_approximated(name)) {
            warnings.push_back(fmt::format("{} is approximated by the base layer", name));
        } else if (required.contains(name)) {
            warnings.push_back(fmt::format(
                "it requires the extension {}, which is not supported: what is shown may be wrong",
                readable(name)));
        } else {
            warnings.push_back(
                fmt::format("the extension {} is not supported and is ignored", readable(name)));
        }
    }
    return warnings;
}

/// Whether nothing is read from the buffer: its views are decoded from another one, or it is not there for
/// who cannot do so.
bool is_placeholder(const Json& buffer) {
    const std::string path = fmt::format("extensions.{}.fallback", meshopt_extension);
    return value_in(buffer, path, false) && (is_supported(meshopt_extension) || !buffer.contains("uri"));
}

Buffer load_buffer(const Json& buffer, std::size_t index, const std::optional<Bytes>& binary,
                   ImportFiles& files) {
    const auto length = buffer.at("byteLength").get<std::size_t>();
    Buffer loaded;
    if (is_placeholder(buffer)) return loaded;
    if (const Json* const uri = find_member(buffer, "uri")) {
        loaded.content = files.read(uri->get_ref<const std::string&>());
        loaded.bytes = *loaded.content;
    } else if (index == 0 && binary) {
        loaded.bytes = *binary;
    } else {
        throw SceneError("it has neither a \"uri\" nor a binary chunk");
    }
    if (loaded.bytes.size() < length) {
        throw SceneError(fmt::format("it has {} of the {} bytes it declares", loaded.bytes.size(), length));
    }
    loaded.bytes = loaded.bytes.first(length);
    return loaded;
}

std::vector<Buffer> load_buffers(const Json& document, const std::optional<Bytes>& binary,
                                 ImportFiles& files) {
    std::vector<Buffer> buffers;
    for (const Json& description : list_in(document, "buffers")) {
        const std::size_t index = buffers.size();
        buffers.push_back(naming(fmt::format("buffer {}", index),
                                 [&] { return load_buffer(description, index, binary, files); }));
    }
    return buffers;
}

/// Whether any material has the member at `path`.
bool any_material(const Json& document, const std::string& path) {
    return std::ranges::any_of(list_in(document, "materials"),
                               [&](const Json& material) { return find_member(material, path) != nullptr; });
}

/// A warning for each kind of thing that the file asks for explicitly and the import leaves out.
std::vector<std::string> omissions(const Json& document) {
    std::vector<std::string> warnings;
    for (const char* texture : {"specularTexture", "specularColorTexture"}) {
        if (any_material(document, fmt::format("extensions.{}.{}", specular_extension, texture))) {
            warnings.push_back(fmt::format("{}s of {} are ignored", texture, specular_extension));
        }
    }
    if (any_material(document, fmt::format("extensions.{}.transmissionTexture", transmission_extension))) {
        warnings.push_back(fmt::format("transmissionTextures of {} are approximated by their factor",
                                       transmission_extension));
    }
    return warnings;
}

}  // namespace

Document read_document(Bytes bytes, ImportFiles& files, ImportBudget& budget) {
    const Container container = split(bytes);
    const auto* const text = reinterpret_cast<const char*>(container.json.data());
    Document document;
    document.json = parse_json({text, container.json.size()});
    const Json& json = document.json;
    check_schema(json);
    budget.check_nodes(document.all("nodes").size());
    document.warnings = check_extensions(json);
    document.is_quantized = extensions_in(json, "extensionsUsed").contains(quantization_extension);
    document.buffers = load_buffers(json, container.binary, files);
    decode_buffer_views(document, budget);
    std::ranges::move(omissions(json), std::back_inserter(document.warnings));
    return document;
}

}  // namespace candela::gltf
