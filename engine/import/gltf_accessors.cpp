#include "engine/import/gltf_accessors.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <tuple>

#include <fmt/format.h>

#include <candela/scene/scene_error.hpp>
#include "engine/import/gltf_constants.hpp"

namespace candela::gltf {

namespace {

struct Accessor {
    int component_type = 0;
    int components = 0;       ///< of SCALAR 1, of VEC2 to VEC4 2 to 4, of MAT4 16; 0 for smaller matrices
    std::size_t count = 0;    ///< elements
    bool normalized = false;  ///< integers stand for fractions of the largest
};

int components_of(std::string_view type) {
    if (type == "SCALAR") return 1;
    if (type == "MAT4") return 16;
    return type.starts_with("VEC") ? type.back() - '0' : 0;
}

Accessor accessor_at(const Document& document, int index) {
    const Json& json = document.at("accessors", index);
    return {json.at("componentType").get<int>(), components_of(json.at("type").get<std::string>()),
            json.at("count").get<std::size_t>(), value_in(json, "normalized", false)};
}

template <class T>
T load(const unsigned char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

/// Elements at a constant stride (bytes) in one buffer view.
struct Elements {
    const unsigned char* first;
    std::size_t stride;

    const unsigned char* operator[](std::size_t i) const { return first + i * stride; }
};

/// The `count` elements of an accessor, or of a part of its sparse ones, which has the same members.
/// `owner` names it in messages; sizes in bytes.
Elements locate(const Document& document, const Json& source, const std::string& owner, std::size_t count,
                std::size_t component, std::size_t element_size) {
    const int buffer_view = index_in(source, "bufferView");
    const auto offset = value_in(source, "byteOffset", std::size_t{0});
    const Bytes bytes = buffer_view_bytes(document, buffer_view);
    const Json& view = document.at("bufferViews", buffer_view);
    const std::size_t stride = value_in(view, "byteStride", element_size);
    if (stride < element_size) {
        throw SceneError(
            fmt::format("{} has elements of {} bytes, more than the stride of {} of buffer view {}", owner,
                        element_size, stride, buffer_view));
    }
    const bool fits = offset <= bytes.size() && element_size <= bytes.size() - offset &&
                      count - 1 <= (bytes.size() - offset - element_size) / stride;
    if (!fits) throw SceneError(fmt::format("{} reads past the end of buffer view {}", owner, buffer_view));
    if ((value_in(view, "byteOffset", std::size_t{0}) + offset) % component != 0) {
        throw SceneError(fmt::format("{} is not aligned to its components of {} bytes", owner, component));
    }
    return {bytes.data() + offset, stride};
}

constexpr std::size_t component_size(int component_type) {
    switch (component_type) {
        case signed_byte:
        case unsigned_byte:
            return 1;
        case signed_short:
        case unsigned_short:
            return 2;
        default:
            return 4;  // UNSIGNED_INT or FLOAT: callers have checked the type
    }
}

std::uint32_t load_unsigned(const unsigned char* bytes, int component_type) {
    switch (component_type) {
        case unsigned_byte:
            return *bytes;
        case unsigned_short:
            return load<std::uint16_t>(bytes);
        default:
            return load<std::uint32_t>(bytes);
    }
}

bool is_unsigned(int component_type) {
    return component_type == unsigned_byte || component_type == unsigned_short ||
           component_type == unsigned_int;
}

/// Replaces the selected elements that the sparse part of the accessor lists.
template <class Element, class Decode>
void apply_sparse(const Document& document, int index, const Json& sparse, const Selection& selection,
                  Decode decode, std::size_t element_size, std::vector<Element>& elements) {
    const Accessor accessor = accessor_at(document, index);
    const auto count = sparse.at("count").get<std::size_t>();
    const int index_type = sparse.at("indices").at("componentType").get<int>();
    if (!is_unsigned(index_type)) {
        throw SceneError(fmt::format("accessor {} has sparse indices that are not unsigned integers", index));
    }
    const std::size_t index_size = component_size(index_type);
    const Elements indices =
        locate(document, sparse.at("indices"), fmt::format("accessor {} (its sparse indices)", index), count,
               index_size, index_size);
    const Elements values =
        locate(document, sparse.at("values"), fmt::format("accessor {} (its sparse values)", index), count,
               component_size(accessor.component_type), element_size);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t at = load_unsigned(indices[i], index_type);
        if (at >= accessor.count) {
            throw SceneError(
                fmt::format("accessor {} has a sparse index out of its {} elements", index, accessor.count));
        }
        if (const std::size_t place = selection.place(at); place < selection.count()) {
            elements[place] = decode(values[i]);
        }
    }
}

/// Whether the accessor has elements beside those of its sparse part.
bool has_elements(const Document& document, int index) {
    return document.at("accessors", index).contains("bufferView") ||
           document.decoded_accessors.contains(index);
}

/// The selected elements, each converted from its bytes by `decode`. The caller has checked the accessor's
/// types. An accessor without a buffer view is all zeros.
template <class Element, class Decode>
std::vector<Element> read(const Document& document, int index, const Selection& selection, Decode decode) {
    const Json& json = document.at("accessors", index);
    const Accessor accessor = accessor_at(document, index);
    const std::size_t component = component_size(accessor.component_type);
    const std::size_t size = component * static_cast<std::size_t>(accessor.components);

    std::vector<Element> elements{};
    if (!has_elements(document, index)) {
        elements.resize(selection.count(), Element{});
    } else {
        const auto decoded = document.decoded_accessors.find(index);
        const Elements source =
            decoded != document.decoded_accessors.end()
                ? Elements{decoded->second.data(), size}
                : locate(document, json, fmt::format("accessor {}", index), accessor.count, component, size);
        elements.reserve(selection.count());
        for (std::size_t i = 0; i < selection.count(); ++i) {
            elements.push_back(decode(source[selection[i]]));
        }
    }
    if (const Json* const sparse = find_member(json, "sparse")) {
        apply_sparse(document, index, *sparse, selection, decode, size, elements);
    }
    return elements;
}

/// An integer as it is, or as a fraction of the largest (glTF 2.0, section 3.6.2.2): -128 and -127 are -1.
template <class Integer>
float load_integer(const unsigned char* bytes, bool normalized) {
    const auto value = static_cast<float>(load<Integer>(bytes));
    constexpr auto one = static_cast<float>(std::numeric_limits<Integer>::max());
    return normalized ? std::max(value / one, -1.0F) : value;
}

/// Component `i` of an element whose components are FLOAT or integers of 8 or 16 bits.
float real_component(const unsigned char* element, std::size_t i, const Accessor& accessor) {
    const int type = accessor.component_type;
    const unsigned char* const bytes = element + i * component_size(type);
    switch (type) {
        case signed_byte:
            return load_integer<std::int8_t>(bytes, accessor.normalized);
        case unsigned_byte:
            return load_integer<std::uint8_t>(bytes, accessor.normalized);
        case signed_short:
            return load_integer<std::int16_t>(bytes, accessor.normalized);
        case unsigned_short:
            return load_integer<std::uint16_t>(bytes, accessor.normalized);
        default:
            return load<float>(bytes);
    }
}

bool allows(const Use& use, const Document& document, const Accessor& accessor) {
    const int type = accessor.component_type;
    if (type == floating_point) return true;
    if (type > unsigned_short) return false;
    const bool is_signed = type == signed_byte || type == signed_short;
    if (accessor.normalized && (is_signed ? use.signed_fractions : use.unsigned_fractions)) return true;
    const bool is_direction = accessor.normalized && is_signed;
    return document.is_quantized && (use.quantized_numbers || (use.quantized_directions && is_direction));
}

SceneError misfit(int index, std::string_view plural, std::string_view type) {
    return SceneError(fmt::format("accessor {} holds {}, but is not {}", index, plural, type));
}

SceneError misfit(int index, const Use& use, const Document& document) {
    std::string type = fmt::format("{} of FLOAT", use.type);
    if (use.unsigned_fractions && use.signed_fractions) {
        type += " or of normalised integers of 8 or 16 bits";
    } else if (use.unsigned_fractions) {
        type += " or of normalised UNSIGNED_BYTE or UNSIGNED_SHORT";
    } else if (use.signed_fractions) {
        type += " or of normalised BYTE or SHORT";
    }
    if (document.is_quantized && (use.quantized_numbers || use.quantized_directions)) {
        type += ", or of a type of KHR_mesh_quantization";
    }
    return misfit(index, use.plural, type);
}

/// The components, one after the other.
template <class Vector>
std::vector<float> numbers_of(const std::vector<Vector>& vectors) {
    std::vector<float> numbers;
    numbers.reserve(vectors.size() * static_cast<std::size_t>(Vector::length()));
    for (const Vector& vector : vectors) {
        for (int i = 0; i < Vector::length(); ++i) numbers.push_back(vector[i]);
    }
    return numbers;
}

}  // namespace

std::size_t Selection::place(std::size_t element) const {
    if (indices_.empty()) return element;
    const auto found = std::ranges::lower_bound(indices_, element);
    const bool is_selected = found != indices_.end() && *found == element;
    return is_selected ? static_cast<std::size_t>(found - indices_.begin()) : count_;
}

Bytes buffer_view_bytes(const Document& document, int buffer_view) {
    const auto decoded = document.decoded_views.find(buffer_view);
    if (decoded != document.decoded_views.end()) return decoded->second;
    const Json& view = document.at("bufferViews", buffer_view);
    if (find_member(view, fmt::format("extensions.{}", meshopt_extension)) &&
        document.buffers[view.at("buffer").get<std::size_t>()].bytes.empty()) {
        throw SceneError(fmt::format("buffer view {} is compressed by {}, which is not supported",
                                     buffer_view, meshopt_extension));
    }
    return buffer_bytes(document, view, buffer_view);
}

Bytes buffer_bytes(const Document& document, const Json& range, int buffer_view) {
    const auto buffer = range.at("buffer").get<std::size_t>();
    const auto length = range.at("byteLength").get<std::size_t>();
    const auto offset = value_in(range, "byteOffset", std::size_t{0});
    const Bytes bytes = document.buffers[buffer].bytes;
    if (offset > bytes.size() || length > bytes.size() - offset) {
        throw SceneError(fmt::format("buffer view {} reads past the end of buffer {}", buffer_view, buffer));
    }
    return bytes.subspan(offset, length);
}

ElementLayout layout_of(const Document& document, int index) {
    const Accessor accessor = accessor_at(document, index);
    const auto components = static_cast<std::size_t>(accessor.components);
    const int type = accessor.component_type;
    return {type, components, accessor.count, components * component_size(type)};
}

std::size_t element_count(const Document& document, int accessor) {
    return document.at("accessors", accessor).at("count").get<std::size_t>();
}

bool has_data(const Document& document, int accessor) {
    return has_elements(document, accessor) || document.at("accessors", accessor).contains("sparse");
}

void check_count(const Document& document, const Json& primitive, int accessor, std::string_view plural) {
    const std::size_t positions = element_count(document, index_in(primitive, "attributes.POSITION"));
    const std::size_t count = element_count(document, accessor);
    if (count != positions) {
        throw SceneError(fmt::format("it has {} positions, but {} {}", positions, count, plural));
    }
}

template <class Element>
std::vector<Element> read_reals(const Document& document, int index, const Selection& selection,
                                const Use& use) {
    using Parts = std::array<float, sizeof(Element) / component_size(floating_point)>;
    constexpr int most = std::tuple_size_v<Parts>;
    const Accessor accessor = accessor_at(document, index);
    const bool fits = accessor.components == most || (use.has_optional_alpha && accessor.components == 3);
    if (!fits || !allows(use, document, accessor)) throw misfit(index, use, document);
    auto elements = read<Element>(document, index, selection, [&accessor](const unsigned char* element) {
        Parts parts;
        parts.fill(1.0F);
        for (int i = 0; i < accessor.components; ++i) {
            const auto part = static_cast<std::size_t>(i);
            parts[part] = real_component(element, part, accessor);
        }
        return std::bit_cast<Element>(parts);
    });
    const auto is_finite = [](float part) { return std::isfinite(part); };
    for (std::size_t i = 0; i < elements.size(); ++i) {
        if (std::ranges::all_of(std::bit_cast<Parts>(elements[i]), is_finite)) continue;
        throw SceneError(fmt::format("accessor {} has a NaN or infinity in element {}", index, selection[i]));
    }
    return elements;
}

template std::vector<float> read_reals(const Document&, int, const Selection&, const Use&);
template std::vector<glm::vec2> read_reals(const Document&, int, const Selection&, const Use&);
template std::vector<glm::vec3> read_reals(const Document&, int, const Selection&, const Use&);
template std::vector<glm::vec4> read_reals(const Document&, int, const Selection&, const Use&);
template std::vector<glm::mat4> read_reals(const Document&, int, const Selection&, const Use&);

std::vector<glm::u16vec4> read_joints(const Document& document, int index, const Selection& selection) {
    const Accessor accessor = accessor_at(document, index);
    const int type = accessor.component_type;
    const bool is_known = (type == unsigned_byte || type == unsigned_short) && !accessor.normalized;
    if (accessor.components != 4 || !is_known) {
        throw misfit(index, "joints", "VEC4 of UNSIGNED_BYTE or UNSIGNED_SHORT");
    }
    return read<glm::u16vec4>(document, index, selection, [type](const unsigned char* element) {
        const auto joint = [&](std::size_t i) {
            return static_cast<std::uint16_t>(load_unsigned(element + i * component_size(type), type));
        };
        return glm::u16vec4(joint(0), joint(1), joint(2), joint(3));
    });
}

std::vector<float> read_key_values(const Document& document, int index, std::size_t components,
                                   bool may_be_integers) {
    const std::string type = components == 1 ? "SCALAR" : fmt::format("VEC{}", components);
    const Use use{.plural = "values of keys",
                  .type = type,
                  .unsigned_fractions = may_be_integers,
                  .signed_fractions = may_be_integers};
    const Selection whole(element_count(document, index));
    if (components == 1) return read_reals<float>(document, index, whole, use);
    if (components == 3) return numbers_of(read_reals<glm::vec3>(document, index, whole, use));
    return numbers_of(read_reals<glm::vec4>(document, index, whole, use));
}

std::vector<std::uint32_t> read_indices(const Document& document, int index, std::size_t vertex_count) {
    const Accessor accessor = accessor_at(document, index);
    const int type = accessor.component_type;
    if (accessor.components != 1 || !is_unsigned(type)) {
        throw misfit(index, "indices", "SCALAR of an unsigned integer");
    }
    auto indices =
        read<std::uint32_t>(document, index, Selection(accessor.count),
                            [type](const unsigned char* bytes) { return load_unsigned(bytes, type); });
    const auto outside = std::ranges::find_if(indices, [&](std::uint32_t i) { return i >= vertex_count; });
    if (outside != indices.end()) {
        throw SceneError(fmt::format("accessor {} has an index beyond the {} vertices in element {}", index,
                                     vertex_count, outside - indices.begin()));
    }
    return indices;
}

}  // namespace candela::gltf
