#include "renderer/passes/inspect/element_fields.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include <candela/extension.hpp>
#include <candela/scene/components.hpp>
#include "renderer/gpu/gpu_types.hpp"

namespace candela {
namespace {

struct GlslType {
    std::string_view name;
    NumberType number;
    std::uint32_t count;
    std::uint32_t alignment;  // bytes
};

constexpr std::array<GlslType, 9> glsl_numbers{{{"float", NumberType::float32, 1, 4},
                                                {"uint", NumberType::uint32, 1, 4},
                                                {"vec2", NumberType::float32, 2, 8},
                                                {"vec3", NumberType::float32, 3, 16},
                                                {"vec4", NumberType::float32, 4, 16},
                                                {"mat4", NumberType::float32, 16, 16},
                                                {"uvec2", NumberType::uint32, 2, 8},
                                                {"uvec3", NumberType::uint32, 3, 16},
                                                {"uvec4", NumberType::uint32, 4, 16}}};

/// The first word, which is removed, with what is between it and the next one.
std::string_view take_word(std::string_view& text) {
    constexpr std::string_view spaces = " \t\n";
    text.remove_prefix(std::min(text.find_first_not_of(spaces), text.size()));
    const std::size_t end = std::min(text.find_first_of(" \t\n;[(/"), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(end);
    return word;
}

/// Numbers of elements in brackets that follow a name; 1 without brackets.
std::uint32_t array_length(std::string_view rest) {
    std::uint32_t length = 1;
    if (rest.starts_with('[')) std::from_chars(rest.data() + 1, rest.data() + rest.size(), length);
    return length;
}

/// The members between the braces of a struct; nothing if there is no such struct.
std::optional<std::string_view> body_of(std::string_view source, std::string_view name) {
    const std::string head = "struct " + std::string(name) + " {";
    const std::size_t begin = source.find(head);
    if (begin == std::string_view::npos) return std::nullopt;
    const std::string_view rest = source.substr(begin + head.size());
    return rest.substr(0, rest.find("};"));
}

/// Names in shaders/types.glsl.
const std::map<std::type_index, std::string_view>& glsl_names() {
    static const std::map<std::type_index, std::string_view> names{
        {typeid(gpu::CellConstants), "CellConstants"},
        {typeid(gpu::CellLight), "CellLight"},
        {typeid(gpu::CellPoint), "CellPoint"},
        {typeid(gpu::ChangedBox), "ChangedBox"},
        {typeid(gpu::DirectPoint), "DirectPoint"},
        {typeid(gpu::FluxAccount), "FluxAccount"},
        {typeid(gpu::Instance), "Instance"},
        {typeid(gpu::Light), "Light"},
        {typeid(gpu::LightConstants), "LightConstants"},
        {typeid(gpu::LightReceiver), "LightReceiver"},
        {typeid(gpu::LitEmitter), "LitEmitter"},
        {typeid(gpu::LitPoint), "LitPoint"},
        {typeid(gpu::LitSurfel), "LitSurfel"},
        {typeid(gpu::Material), "Material"},
        {typeid(gpu::Path), "Path"},
        {typeid(gpu::Shadow), "Shadow"},
        {typeid(gpu::SkyPatch), "SkyPatch"},
        {typeid(gpu::Surfel), "Surfel"},
        {typeid(gpu::TileDepth), "TileDepth"},
        {typeid(gpu::TraceTriangle), "TraceTriangle"},
        {typeid(gpu::TracedVpl), "TracedVpl"},
        {typeid(gpu::ViewConstants), "ViewConstants"},
        {typeid(gpu::VplConstants), "VplConstants"},
        {typeid(gpu::VplRecord), "VplRecord"},
        {typeid(gpu::WideNode), "WideNode"}};
    return names;
}

/// Those that GLSL does not know as structs.
const std::map<std::type_index, std::vector<ElementField>>& other_fields() {
    using enum NumberType;
    using gpu::DrawCommand;
    static const std::map<std::type_index, std::vector<ElementField>> fields{
        {typeid(float), {{"", float32, 1, 0}}},
        {typeid(glm::vec2), {{"", float32, 2, 0}}},
        {typeid(glm::vec3), {{"", float32, 3, 0}}},
        {typeid(glm::vec4), {{"", float32, 4, 0}}},
        {typeid(std::uint32_t), {{"", uint32, 1, 0}}},
        {typeid(glm::uvec2), {{"", uint32, 2, 0}}},
        {typeid(glm::uvec4), {{"", uint32, 4, 0}}},
        {typeid(Vertex),
         {{"position", float32, 3, offsetof(Vertex, position)},
          {"normal", float32, 3, offsetof(Vertex, normal)},
          {"uv", float32, 2, offsetof(Vertex, uv)},
          {"colour", unorm16, 4, offsetof(Vertex, colour)},
          {"tangent", snorm16, 4, offsetof(Vertex, tangent)}}},
        {typeid(DrawCommand),
         {{"index_count", uint32, 1, offsetof(DrawCommand, index_count)},
          {"instance_count", uint32, 1, offsetof(DrawCommand, instance_count)},
          {"first_index", uint32, 1, offsetof(DrawCommand, first_index)},
          {"base_vertex", int32, 1, offsetof(DrawCommand, base_vertex)},
          {"base_instance", uint32, 1, offsetof(DrawCommand, base_instance)}}}};
    return fields;
}

}  // namespace

std::vector<ElementField> fields_of_struct(std::string_view source, std::string_view name) {
    std::vector<ElementField> fields;
    std::string_view body = body_of(source, name).value_or(std::string_view());
    std::uint32_t end = 0;  // of the member before
    while (!body.empty()) {
        std::string_view line = body.substr(0, body.find('\n'));
        body.remove_prefix(std::min(line.size() + 1, body.size()));
        const std::string_view type_name = take_word(line);
        if (type_name.empty()) continue;  // an empty line, or a comment
        const auto* const type = std::ranges::find(glsl_numbers, type_name, &GlslType::name);
        if (type == glsl_numbers.end()) return {};
        const std::string_view member = take_word(line);
        const std::uint32_t length = array_length(line);
        const std::uint32_t offset = (end + type->alignment - 1) / type->alignment * type->alignment;
        end = offset + 4 * type->count * length;
        if (!member.starts_with("pad")) {
            fields.push_back({std::string(member), type->number, type->count * length, offset});
        }
    }
    return fields;
}

std::vector<ElementField> fields_of(std::type_index element) {
    const auto other = other_fields().find(element);
    if (other != other_fields().end()) return other->second;
    const auto name = glsl_names().find(element);
    if (name == glsl_names().end()) return {};
    return fields_of_struct(glsl_types(), name->second);
}

}  // namespace candela
