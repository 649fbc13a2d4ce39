#include "engine/import/gltf_document.hpp"
#include "engine/json_fault.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <candela/scene/scene_error.hpp>
#include "engine/import/gltf_schema.hpp"

namespace candela::gltf {

namespace {

using Bytes = std::span<const unsigned char>;
using Json = nlohmann::json;

// TinyGLTF parses extensions and extras recursively, so deep nesting could overflow the stack. glTF's own
// members are nested at most 8 deep.
constexpr int deepest_nesting = 256;

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
    if (rest.size() < 8) {
        throw SceneError("the .glb ends inside a chunk's header");
    }
    const std::uint32_t length = read_u32(rest, 0);
    if (!std::ranges::equal(rest.subspan(4, 4), type)) {
        throw SceneError(fmt::format("the .glb lacks its {} chunk", type.substr(0, type.find('\0'))));
    }
    if (length > rest.size() - 8) {
        throw SceneError("the .glb ends inside a chunk");
    }
    const Bytes chunk = rest.subspan(8, length);
    // The last chunk's padding may be missing; chunks in between are aligned to four bytes.
    rest = rest.subspan(std::min<std::size_t>(rest.size(), 8 + (std::size_t{length} + 3) / 4 * 4));
    return chunk;
}

Container split(Bytes bytes) {
    using namespace std::string_view_literals;
    if (bytes.empty()) {
        throw SceneError("the file is empty");
    }
    if (bytes.size() < 4 || !std::ranges::equal(bytes.first(4), "glTF"sv)) {
        return {bytes, {}};
    }
    if (bytes.size() < 12) {
        throw SceneError("the .glb ends inside its header");
    }
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
    if (!rest.empty()) {
        container.binary = take_chunk(rest, "BIN\0"sv);
    }
    return container;
}

/// Runs before any parser. The depth is exact for valid JSON; invalid JSON is reported later by the parser.
void check_nesting(Bytes text) {
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const unsigned char c = text[i];
        if (c == '"') {
            in_string = !in_string;
        }
        if (in_string) {
            i += c == '\\' ? 1 : 0;
            continue;
        }
        if (c == '[' || c == '{') {
            ++depth;
        }
        if (c == ']' || c == '}') {
            --depth;
        }
        if (depth > deepest_nesting) {
            throw SceneError("its JSON is nested too deeply");
        }
    }
}

Json parse_json(Bytes text) {
    check_nesting(text);
    try {
        return Json::parse(text.begin(), text.end());
    } catch (const Json::exception& error) {
        throw SceneError(json_fault(error));
    }
}

bool is_supported(std::string_view extension) {
    return std::ranges::find(supported_extensions, extension) != supported_extensions.end();
}

/// Throws for required extensions that are not supported; returns a warning for each other unsupported one.
std::vector<std::string> check_extensions(const Json& document) {
    const auto names = [&](const char* member) { return document.value(member, std::set<std::string>{}); };
    for (const std::string& name : names("extensionsRequired")) {
        if (!is_supported(name)) {
            throw SceneError(fmt::format("it requires the extension {}, which is not supported", name));
        }
    }
    std::vector<std::string> warnings;
    for (const std::string& name : names("extensionsUsed")) {
        if (!is_supported(name)) {
            warnings.push_back(fmt::format("the extension {} is not supported and is ignored", name));
        }
    }
    return warnings;
}

std::vector<unsigned char> load_buffer(const Json& buffer, std::size_t index,
                                       const std::optional<Bytes>& binary,
                                       const std::filesystem::path& base_directory) {
    const auto length = buffer.at("byteLength").get<std::size_t>();
    std::vector<unsigned char> data;
    if (buffer.contains("uri")) {
        data = read_uri(buffer.at("uri").get_ref<const std::string&>(), base_directory);
    } else if (index == 0 && binary) {
        data.assign(binary->begin(), binary->end());
    } else {
        throw SceneError("it has neither a \"uri\" nor a binary chunk");
    }
    if (data.size() < length) {
        throw SceneError(fmt::format("it has {} of the {} bytes it declares", data.size(), length));
    }
    data.resize(length);
    return data;
}

std::vector<tinygltf::Buffer> load_buffers(const Json& document, const std::optional<Bytes>& binary,
                                           const std::filesystem::path& base_directory) {
    const Json descriptions = document.value("buffers", Json::array());
    std::vector<tinygltf::Buffer> buffers(descriptions.size());
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        try {
            buffers[i].data = load_buffer(descriptions[i], i, binary, base_directory);
        } catch (const SceneError& error) {
            throw SceneError(fmt::format("buffer {}: {}", i, error.what()));
        }
    }
    return buffers;
}

std::vector<tinygltf::Image> describe_images(const Json& document) {
    const Json descriptions = document.value("images", Json::array());
    std::vector<tinygltf::Image> images(descriptions.size());
    for (std::size_t i = 0; i < images.size(); ++i) {
        images[i].name = descriptions[i].value("name", "");
        images[i].uri = descriptions[i].value("uri", "");
        images[i].bufferView = descriptions[i].value("bufferView", -1);
        if (images[i].uri.empty() == (images[i].bufferView < 0)) {
            throw SceneError(fmt::format(R"(image {} needs either a "uri" or a "bufferView")", i));
        }
    }
    return images;
}

std::vector<bool> find_named_nodes(const Json& document) {
    std::vector<bool> named;
    for (const Json& node : document.value("nodes", Json::array())) {
        named.push_back(node.contains("name"));
    }
    return named;
}

/// Adds two defaults that TinyGLTF 2.5 does not handle: byte offsets that a sparse accessor leaves out, and
/// the buffer view of an accessor without one (TinyGLTF then writes out of bounds). Such accessors get an
/// extra buffer view after those of the file; its index is returned.
std::size_t write_defaults(Json& document) {
    Json& views = document["bufferViews"];
    views.push_back({{"buffer", 0}, {"byteLength", 1}});
    const std::size_t none = views.size() - 1;
    if (document.contains("accessors")) {
        for (Json& accessor : document["accessors"]) {
            accessor.emplace("bufferView", none);
            if (accessor.contains("sparse")) {
                accessor["sparse"]["indices"].emplace("byteOffset", 0);
                accessor["sparse"]["values"].emplace("byteOffset", 0);
            }
        }
    }
    return none;
}

/// Parses everything but buffers and images. Those are read here, with stricter checks than TinyGLTF's.
tinygltf::Model parse_model(Json document) {
    for (const char* member : {"buffers", "images", "animations", "skins"}) {
        document.erase(member);
    }
    const std::size_t no_view = write_defaults(document);
    const std::string text = document.dump();
    if (text.size() > std::numeric_limits<unsigned int>::max()) {
        throw SceneError("its JSON exceeds 4 GiB");
    }

    tinygltf::Model model;
    std::string errors;
    std::string warnings;
    tinygltf::TinyGLTF parser;
    const bool parsed = parser.LoadASCIIFromString(&model, &errors, &warnings, text.data(),
                                                   static_cast<unsigned int>(text.size()), {});
    if (!parsed || !errors.empty()) {
        throw SceneError(errors.empty() ? "it is not valid glTF" : errors);
    }
    model.bufferViews.pop_back();
    for (tinygltf::Accessor& accessor : model.accessors) {
        if (accessor.bufferView == static_cast<int>(no_view)) {
            accessor.bufferView = -1;
        }
    }
    return model;
}

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

}  // namespace

bool starts_with(Bytes bytes, std::string_view prefix) {
    return bytes.size() >= prefix.size() && std::memcmp(bytes.data(), prefix.data(), prefix.size()) == 0;
}

std::vector<unsigned char> read_file(const std::filesystem::path& path, std::string_view called) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
        throw SceneError(fmt::format("{} does not exist", called));
    }
    if (!std::filesystem::is_regular_file(path, ignored)) {
        throw SceneError(fmt::format("{} is not a file", called));
    }
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    std::vector<unsigned char> bytes(file ? static_cast<std::size_t>(file.tellg()) : 0);
    file.seekg(0).read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!file) {
        throw SceneError(fmt::format("{} cannot be read", called));
    }
    return bytes;
}

std::vector<unsigned char> read_uri(const std::string& uri, const std::filesystem::path& base_directory) {
    if (!uri.starts_with("data:")) {
        return read_file(base_directory / percent_decoded(uri), uri);
    }
    std::vector<unsigned char> bytes;
    std::string media_type;
    if (!tinygltf::DecodeDataURI(&bytes, media_type, uri, 0, false)) {
        throw SceneError(fmt::format("the data URI {:.40}... is empty or of an unknown kind", uri));
    }
    return bytes;
}

/// Whether any material has the member at `path`, with a value for which `counts` holds.
bool any_material(const Json& document, const char* path, bool (*counts)(const Json& value)) {
    const Json::json_pointer pointer(path);
    const Json none = Json::array();
    const Json& materials = document.contains("materials") ? document.at("materials") : none;
    return std::ranges::any_of(materials, [&](const Json& material) {
        return material.contains(pointer) && counts(material.at(pointer));
    });
}

/// A warning for each kind of thing that the file asks for explicitly and the import leaves out.
std::vector<std::string> omissions(const Json& document) {
    const auto any = [](const Json&) { return true; };
    const auto above_0 = [](const Json& value) { return value.get<double>() > 0.0; };
    const auto below_1 = [](const Json& value) { return value.get<double>() < 1.0; };
    std::vector<std::string> warnings;
    for (const char* member : {"animations", "skins"}) {
        if (document.contains(member)) {
            warnings.push_back(fmt::format("{} are ignored", member));
        }
    }
    if (any_material(document, "/pbrMetallicRoughness/metallicFactor", above_0) ||
        any_material(document, "/pbrMetallicRoughness/metallicRoughnessTexture", any)) {
        warnings.emplace_back("metalness is ignored: all surfaces are diffuse");
    }
    if (any_material(document, "/pbrMetallicRoughness/roughnessFactor", below_1)) {
        warnings.emplace_back("roughness is ignored: all surfaces are diffuse");
    }
    if (any_material(document, "/normalTexture", any)) {
        warnings.emplace_back("normal maps are ignored");
    }
    if (any_material(document, "/occlusionTexture", any)) {
        warnings.emplace_back("occlusion textures are ignored");
    }
    return warnings;
}

Document read_document(Bytes bytes, const std::filesystem::path& base_directory) {
    const Container container = split(bytes);
    Json json = parse_json(container.json);
    check_schema(json);
    Document document;
    document.warnings = check_extensions(json);
    std::vector<tinygltf::Buffer> buffers = load_buffers(json, container.binary, base_directory);
    std::vector<tinygltf::Image> images = describe_images(json);
    std::ranges::move(omissions(json), std::back_inserter(document.warnings));
    document.node_has_name = find_named_nodes(json);
    document.model = parse_model(std::move(json));
    document.model.buffers = std::move(buffers);
    document.model.images = std::move(images);
    return document;
}

}  // namespace candela::gltf
