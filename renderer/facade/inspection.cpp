#include <candela/extension.hpp>
#include <candela/inspection.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstring>
#include <glm/common.hpp>
#include <span>
#include <stdexcept>
#include <typeindex>
#include <utility>

#include <candela/renderer.hpp>
#include "renderer/facade/gpu_of.hpp"
#include "renderer/passes/inspect/element_fields.hpp"
#include "renderer/passes/inspect/inspect.hpp"
#include "renderer/passes/inspect/inspect_histogram.hpp"
#include "renderer/passes/inspect/inspect_range.hpp"
#include "renderer/passes/inspect/inspect_texel.hpp"
#include "shaders/bindings.glsl"
#include "shaders/inspect/heat_colours.glsl"

namespace candela {
namespace {

constexpr std::string_view extension_name = "inspect";
constexpr std::string_view result_pass = "inspect-result";

/// What the passes found of all texels.
struct Statistics {
    glm::vec4 automatic{0.0F};  // low, high, number of faulty texels
    glm::vec4 values{0.0F};
    std::vector<std::uint32_t> histogram;
};

/// The picture of the last frame, and the buffers with what belongs to it.
struct Picture {
    Shown shown;
    bool lists = false;
    ObjectId texture = 0;
    ObjectId ranges = 0;
    ObjectId histogram = 0;
    ObjectId texel_values = 0;
    std::optional<glm::uvec2> texel{};
    std::optional<Statistics> statistics{};      // none: not read back yet
    std::optional<InspectedTexel> texel_read{};  // likewise
};

struct FoundElements {
    ObjectId buffer = 0;
    std::uint32_t stride = 1;
    std::uint64_t count = 0;
    std::type_index element = typeid(void);
};

std::string describe(const Picture& picture) {
    const Shown& shown = picture.shown;
    if (picture.lists) {
        const std::string tiles = fmt::format("lengths of light lists, {} × {} tiles of {} pixels",
                                              shown.texels.x, shown.texels.y, shown.texel_size);
        return shown.layers == 1 ? tiles : fmt::format("{}, {} slices", tiles, shown.layers);
    }
    const TextureDesc& desc = shown.desc;
    std::string text = fmt::format("{}, {} × {} texels", to_string(desc.format), desc.size.x, desc.size.y);
    if (desc.shape != TextureShape::flat) {
        text += fmt::format(", {} of {} layers", to_string(desc.shape), desc.layers);
    }
    return desc.mips == 1 ? text : fmt::format("{}, {} mips", text, desc.mips);
}

std::string_view unit_of(const Picture& picture) {
    if (picture.lists) return "lights";
    return picture.shown.depth_terms ? "m" : "";
}

FoundElements elements_of(const Execution& run, const FoundBuffer& buffer) {
    return {run.object(buffer.handle), buffer.stride, run.count(buffer.handle), buffer.element};
}

template <class T>
T number_at(std::span<const std::byte> bytes, std::size_t at) {
    T number{};
    std::memcpy(&number, &bytes[at], sizeof number);
    return number;
}

std::size_t bytes_of(NumberType type) {
    return type == NumberType::unorm16 || type == NumberType::snorm16 ? 2 : 4;
}

/// The number at a byte. The least number of snorm16 means -1, like the next one: OpenGL 4.5, 2.3.5.1.
double number_at(std::span<const std::byte> bytes, std::size_t at, NumberType type) {
    switch (type) {
        case NumberType::uint32:
            return number_at<std::uint32_t>(bytes, at);
        case NumberType::int32:
            return number_at<std::int32_t>(bytes, at);
        case NumberType::unorm16:
            return number_at<std::uint16_t>(bytes, at) / 65535.0;
        case NumberType::snorm16:
            return std::max(number_at<std::int16_t>(bytes, at) / 32767.0, -1.0);
        case NumberType::float32:
            break;
    }
    return static_cast<double>(number_at<float>(bytes, at));
}

template <class T>
std::vector<T> read_elements(const Gpu& gpu, ObjectId buffer, std::size_t count) {
    std::vector<T> elements(count);
    gl::read_buffer(gpu.gl(), buffer, std::as_writable_bytes(std::span(elements)));
    return elements;
}

/// Numbers that the picture shows of a texel: one for each channel of RGB, else one.
std::size_t shown_channels(const Shown& shown) {
    return shown.channels == static_cast<int>(Channels::rgb) && !shown.depth_terms ? 3 : 1;
}

Statistics read_statistics(const Gpu& gpu, const Picture& picture) {
    const std::vector<glm::vec4> ranges = read_elements<glm::vec4>(gpu, picture.ranges, 2);
    return {
        ranges[0], ranges[1],
        read_elements<std::uint32_t>(gpu, picture.histogram, INSPECT_BINS * shown_channels(picture.shown))};
}

InspectedTexel read_texel(const Gpu& gpu, const Picture& picture) {
    const std::vector<glm::vec4> values = read_elements<glm::vec4>(gpu, picture.texel_values, 2);
    const Shown& shown = picture.shown;
    InspectedTexel texel{.at = glm::min(*picture.texel, shown.texels - 1U), .channels = values[0]};
    if (!picture.lists) {
        texel.channel_count = static_cast<std::uint32_t>(gl::format_info(shown.desc.format).components);
    }
    if (shown.depth_terms) texel.metres = values[1].x;
    return texel;
}

}  // namespace

struct CANDELA_PRIVATE ResourceInspector::State : std::enable_shared_from_this<State> {
    Inspection wanted;
    bool declared = false;  // in the graph that is being declared
    Picture picture;
    FoundElements elements;

    void declare(FrameGraph& graph, Gpu& gpu, const ViewFrame& frame);
    /// What is to be seen, and which texel: of its own, because another one changes nothing else.
    struct Settings {
        ValueHandle<Inspection> inspection;
        ValueHandle<std::optional<glm::uvec2>> texel;
    };

    Settings add_settings(FrameGraph& graph);
    void add_picture(FrameGraph& graph, Gpu& gpu, const Inspected& inspected);
    void add_elements(FrameGraph& graph, const FoundBuffer& buffer);
};

/// Adds the passes for the resource, in the first view whose frame has it.
void ResourceInspector::State::declare(FrameGraph& graph, Gpu& gpu, const ViewFrame& frame) {
    declared &= frame.index > 0;
    const auto found = declared ? std::nullopt : find_inspected(graph, wanted.resource);
    if (!found) return;
    declared = true;
    if (found->has_picture()) {
        add_picture(graph, gpu, *found);
    } else {
        add_elements(graph, *found->buffer);
    }
}

/// Has a side effect because what is wanted changes from outside of the graph.
ResourceInspector::State::Settings ResourceInspector::State::add_settings(FrameGraph& graph) {
    return graph.add("inspect-settings", [&](Pass& pass) {
        pass.side_effect();
        const Settings settings{pass.write(graph.value<Inspection>("inspection")),
                                pass.write(graph.value<std::optional<glm::uvec2>>("inspected texel"))};
        pass.run([=, self = shared_from_this()](Execution& run) {
            Inspection inspection = self->wanted;
            inspection.texel.reset();
            run.set(settings.inspection, std::move(inspection));
            run.set(settings.texel, self->wanted.texel);
        });
        return settings;
    });
}

/// The last pass keeps the others in the graph, and makes their results known outside of it.
void ResourceInspector::State::add_picture(FrameGraph& graph, Gpu& gpu, const Inspected& inspected) {
    const auto [settings, texel] = add_settings(graph);
    const auto ranges = add_inspect_range(graph, gpu, inspected, settings);
    const auto drawn = add_inspect(graph, gpu, inspected, settings, ranges);
    const auto histogram = add_inspect_histogram(graph, gpu, inspected, settings, ranges);
    const auto values = add_inspect_texel(graph, gpu, inspected, settings, texel);
    graph.add(result_pass, [&, settings = settings, texel = texel](Pass& pass) {
        pass.side_effect();
        read_inspected(pass, inspected);
        pass.read(settings);
        pass.read(texel);
        pass.read(ranges, Usage::copy);
        pass.read(histogram, Usage::copy);
        pass.read(values, Usage::copy);
        pass.read(drawn, Usage::sampled);
        pass.run([=, self = shared_from_this()](Execution& run) {
            const bool same = !run.changed(ranges) && !run.changed(histogram);
            const bool same_texel = !run.changed(values) && !run.changed(texel);
            self->picture = {.shown = shown_of(run, inspected, run.value(settings)),
                             .lists = inspected.grid.has_value(),
                             .texture = run.object(drawn),
                             .ranges = run.object(ranges),
                             .histogram = run.object(histogram),
                             .texel_values = run.object(values),
                             .texel = run.value(texel),
                             .statistics = same ? self->picture.statistics : std::nullopt,
                             .texel_read = same_texel ? self->picture.texel_read : std::nullopt};
            if (inspected.buffer) self->elements = elements_of(run, *inspected.buffer);
        });
    });
}

void ResourceInspector::State::add_elements(FrameGraph& graph, const FoundBuffer& buffer) {
    graph.add(result_pass, [&](Pass& pass) {
        pass.side_effect();
        pass.read(buffer.handle, Usage::copy);
        pass.run(
            [=, self = shared_from_this()](Execution& run) { self->elements = elements_of(run, buffer); });
    });
}

ResourceInspector::ResourceInspector(Renderer& renderer) : renderer_(&renderer) {}

std::vector<std::string> ResourceInspector::show(std::optional<Inspection> wanted) {
    if (!wanted) {
        renderer_->remove_extension(extension_name);
        state_.reset();
        return {};
    }
    if (state_ && state_->wanted.resource == wanted->resource) {
        state_->wanted = std::move(*wanted);
        return {};
    }
    auto state = std::make_shared<State>();
    state->wanted = std::move(*wanted);
    Extension extension{.name = std::string(extension_name)};
    extension.declare = [state, &gpu = gpu_of(*renderer_)](FrameGraph& graph, ViewFrame& frame) {
        state->declare(graph, gpu, frame);
    };
    std::vector<std::string> errors = renderer_->extend(std::move(extension));
    if (errors.empty()) state_ = std::move(state);
    return errors;
}

std::optional<Inspection> ResourceInspector::shown() const {
    return state_ ? std::optional(state_->wanted) : std::nullopt;
}

/// Whether the last frame had the passes. The objects that they have reported exist until the next call of
/// the renderer.
bool ResourceInspector::has_run() const {
    return std::ranges::any_of(renderer_->last_passes(),
                               [](const PassRecord& pass) { return pass.name.starts_with(result_pass); });
}

InspectionResult ResourceInspector::result() const {
    InspectionResult result;
    if (!state_) return result;
    if (!has_run()) {
        const bool no_frame = renderer_->last_passes().empty();
        result.description = no_frame ? "no frame yet" : "not in this graph, or not before the tone map";
        return result;
    }
    Picture& picture = state_->picture;
    if (picture.texture == 0) {
        const FoundElements& elements = state_->elements;
        result.description =
            fmt::format("a buffer with room for {} elements of {} bytes", elements.count, elements.stride);
        return result;
    }
    const Gpu& gpu = gpu_of(*renderer_);
    if (!picture.statistics) picture.statistics = read_statistics(gpu, picture);
    if (picture.texel && !picture.texel_read) picture.texel_read = read_texel(gpu, picture);
    const Statistics& found = *picture.statistics;
    const ValueRange range = picture.shown.range.value_or(ValueRange{found.automatic.x, found.automatic.y});
    return {.texture = picture.texture,
            .size = picture.shown.picture,
            .description = describe(picture),
            .unit = unit_of(picture),
            .mapping = picture.shown.mapping,
            .low = range.low,
            .high = range.high,
            .mips = picture.shown.mips,
            .layers = picture.shown.layers,
            .extent = picture.shown.extent,
            .texel_size = picture.shown.texel_size,
            .least = found.values.x,
            .greatest = found.values.y,
            .faulty = static_cast<std::uint32_t>(found.values.z),
            .histogram = found.histogram,
            .texel = picture.texel_read};
}

BufferElements ResourceInspector::read_buffer(std::uint64_t first, std::uint64_t most) const {
    if (!state_ || !has_run() || state_->elements.buffer == 0) return {};
    const FoundElements& found = state_->elements;
    const std::uint64_t begin = std::min(first, found.count);
    BufferElements read{
        .bytes = {}, .stride = found.stride, .count = found.count, .fields = fields_of(found.element)};
    read.bytes.resize(std::min(most, found.count - begin) * found.stride);
    gl::read_buffer(gpu_of(*renderer_).gl(), found.buffer, read.bytes, begin * found.stride);
    return read;
}

std::vector<double> numbers_of(const BufferElements& elements, const ElementField& field, std::size_t index) {
    const std::size_t size = bytes_of(field.type);
    const std::size_t first = index * elements.stride + field.offset;
    if (first + field.count * size > elements.bytes.size()) {
        throw std::out_of_range("the element was not read");
    }
    std::vector<double> numbers;
    for (std::size_t i = 0; i < field.count; ++i) {
        numbers.push_back(number_at(elements.bytes, first + i * size, field.type));
    }
    return numbers;
}

glm::vec3 heat_colour(float at) {
    using glm::vec3;
    constexpr std::array<vec3, HEAT_COLOUR_COUNT> colours{HEAT_COLOURS};
    const float place = glm::clamp(at, 0.0F, 1.0F) * (HEAT_COLOUR_COUNT - 1);
    const auto first = std::min(static_cast<std::size_t>(place), std::size_t{HEAT_COLOUR_COUNT - 2});
    return glm::mix(colours.at(first), colours.at(first + 1), place - static_cast<float>(first));
}

}  // namespace candela
