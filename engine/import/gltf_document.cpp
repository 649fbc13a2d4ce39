#include "engine/import/gltf_document.hpp"
#include "engine/json_fault.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <candela/scene/scene_error.hpp>
#include "engine/import/gltf_schema.hpp"
#include "engine/readable.hpp"

namespace candela::gltf {

namespace {

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

/// The array of this name; empty if there is none.
const Json& list(const Json& document, const char* name) {
    static const Json none = Json::array();
    const auto found = document.find(name);
    return found == document.end() ? none : *found;
}

/// Throws for required extensions that are not supported; returns a warning for each other unsupported one.
std::vector<std::string> check_extensions(const Json& document) {
    const auto names = [&](const char* member) { return document.value(member, std::set<std::string>{}); };
    for (const std::string& name : names("extensionsRequired")) {
        if (!is_supported(name)) {
            throw SceneError(
                fmt::format("it requires the extension {}, which is not supported", readable(name)));
        }
    }
    std::vector<std::string> warnings;
    for (const std::string& name : names("extensionsUsed")) {
        if (!is_supported(name)) {
            warnings.push_back(
                fmt::format("the extension {} is not supported and is ignored", readable(name)));
        }
    }
    return warnings;
}

Buffer load_buffer(const Json& buffer, std::size_t index, const std::optional<Bytes>& binary,
                   ImportFiles& files) {
    const auto length = buffer.at("byteLength").get<std::size_t>();
    Buffer loaded;
    if (buffer.contains("uri")) {
        loaded.content = files.read(buffer.at("uri").get_ref<const std::string&>());
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
    for (const Json& description : list(document, "buffers")) {
        try {
            buffers.push_back(load_buffer(description, buffers.size(), binary, files));
        } catch (const SceneError& error) {
            throw SceneError(fmt::format("buffer {}: {}", buffers.size(), error.what()));
        }
    }
    return buffers;
}

std::vector<tinygltf::Image> describe_images(const Json& document) {
    const Json& descriptions = list(document, "images");
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

/// Removes extras and extensions that are not supported, for each of which TinyGLTF would make objects.
void remove_unread(Json& value) {
    if (value.is_object()) {
        value.erase("extras");
        if (const auto extensions = value.find("extensions");
            extensions != value.end() && extensions->is_object()) {
            for (auto each = extensions->begin(); each != extensions->end();) {
                each = is_supported(each.key()) ? std::next(each) : extensions->erase(each);
            }
        }
    }
    for (Json& member : value) {
        if (member.is_structured()) {
            remove_unread(member);
        }
    }
}

/// Counts the memory of TinyGLTF's objects, which is a multiple of that of the shortest JSON for them.
void count_objects(const Json& document, ImportBudget& budget) {
    const auto count = [&](const char* name, std::size_t bytes) {
        budget.add_memory(list(document, name).size() * bytes);
    };
    count("accessors", sizeof(tinygltf::Accessor));
    count("bufferViews", sizeof(tinygltf::BufferView));
    count("cameras", sizeof(tinygltf::Camera));
    count("images", sizeof(tinygltf::Image));
    count("materials", sizeof(tinygltf::Material));
    count("meshes", sizeof(tinygltf::Mesh));
    count("samplers", sizeof(tinygltf::Sampler));
    count("scenes", sizeof(tinygltf::Scene));
    count("textures", sizeof(tinygltf::Texture));
    for (const Json& mesh : list(document, "meshes")) {
        budget.add_memory(list(mesh, "primitives").size() * sizeof(tinygltf::Primitive));
    }
    const Json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
    if (document.contains(lights)) {
        budget.add_memory(document.at(lights).size() * sizeof(tinygltf::Light));
    }
}

/// The parser's messages, one per line, as one line.
std::string joined(std::string messages) {
    std::ranges::replace(messages, '\n', ' ');
    messages.erase(messages.find_last_not_of(" .") + 1);
    return messages;
}

/// Parses everything but buffers, images and nodes. Those are read here, with stricter checks than
/// TinyGLTF's.
tinygltf::Model parse_model(Json document) {
    for (const char* member : {"buffers", "images", "nodes", "animations", "skins"}) {
        document.erase(member);
    }
    remove_unread(document);
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
        throw SceneError(errors.empty() ? "it is not valid glTF" : joined(errors));
    }
    model.bufferViews.pop_back();
    for (tinygltf::Accessor& accessor : model.accessors) {
        if (accessor.bufferView == static_cast<int>(no_view)) {
            accessor.bufferView = -1;
        }
    }
    return model;
}

/// Whether any material has the member at `path`, with a value for which `counts` holds.
bool any_material(const Json& document, const char* path, bool (*counts)(const Json& value)) {
    const Json::json_pointer pointer(path);
    return std::ranges::any_of(list(document, "materials"), [&](const Json& material) {
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

}  // namespace

Document read_document(Bytes bytes, ImportFiles& files, ImportBudget& budget) {
    const Container container = split(bytes);
    Json json = parse_json(container.json);
    check_schema(json);
    budget.check_nodes(list(json, "nodes").size());
    count_objects(json, budget);
    Document document;
    document.warnings = check_extensions(json);
    document.buffers = load_buffers(json, container.binary, files);
    std::vector<tinygltf::Image> images = describe_images(json);
    std::ranges::move(omissions(json), std::back_inserter(document.warnings));
    document.nodes = std::move(json["nodes"]);
    if (document.nodes.is_null()) {
        document.nodes = Json::array();
    }
    document.model = parse_model(std::move(json));
    document.model.images = std::move(images);
    return document;
}

}  // namespace candela::gltf
