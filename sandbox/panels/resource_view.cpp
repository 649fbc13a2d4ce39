#include "sandbox/panels/resource_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "sandbox/panels/controls.hpp"
#include "sandbox/window/gui.hpp"

namespace candela::sandbox {

namespace {

std::string_view to_string(Mapping mapping) {
    constexpr std::array<std::string_view, 4> names{"automatic", "colour", "depth", "heat"};
    return names.at(static_cast<std::size_t>(mapping));
}

std::string_view to_string(Channels channels) {
    constexpr std::array<std::string_view, 5> names{"red", "green", "blue", "alpha", "rgb"};
    return names.at(static_cast<std::size_t>(channels));
}

template <class Enum, std::size_t N>
void choose(const char* label, Enum& value, const std::array<Enum, N>& choices, const char* tip) {
    const bool open = ImGui::BeginCombo(label, std::string(to_string(value)).c_str());
    note_control(label, tip);
    if (!open) return;
    for (const Enum candidate : choices) {
        const std::string name(to_string(candidate));
        if (ImGui::Selectable(name.c_str(), candidate == value)) value = candidate;
        note_control(name, nullptr);
    }
    ImGui::EndCombo();
}

/// As large as possible with the picture's proportions.
Rectangle fitted(const InspectionResult& result, const Rectangle& space) {
    const glm::vec2 size(result.size);
    const float factor = std::min(space.size.x / size.x, space.size.y / size.y);
    return {space.corner + 0.5F * (space.size - factor * size), factor * size};
}

/// The bars of the channels over each other, as high as the root of their share of the highest: few values
/// are seen beside many.
void draw_histogram(const InspectionResult& result) {
    constexpr std::size_t bins = 64;
    constexpr std::array colours{IM_COL32(230, 90, 90, 150), IM_COL32(90, 200, 90, 150),
                                 IM_COL32(100, 140, 255, 150)};
    const std::size_t channels = result.histogram.size() / bins;
    const std::uint32_t most = channels == 0 ? 0 : std::ranges::max(result.histogram);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = 18.0F * ImGui::GetFontSize() / bins;
    const float height = 4.0F * ImGui::GetFontSize();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(corner, {corner.x + width * bins, corner.y + height}, IM_COL32(0, 0, 0, 120));
    for (std::size_t channel = 0; channel < channels && most > 0; ++channel) {
        const ImU32 colour = channels == 1 ? IM_COL32(200, 200, 200, 255) : colours.at(channel);
        for (std::size_t bin = 0; bin < bins; ++bin) {
            const auto count = static_cast<float>(result.histogram[channel * bins + bin]);
            const float left = corner.x + width * static_cast<float>(bin);
            const float top = height * (1.0F - std::sqrt(count / static_cast<float>(most)));
            list.AddRectFilled({left, corner.y + top}, {left + width, corner.y + height}, colour);
        }
    }
    ImGui::Dummy({width * bins, height});
    note_control("histogram",
                 "how often the values are in each of 64 parts of the range; a bar half as high stands for a "
                 "quarter as many");
    const std::string unit = result.unit.empty() ? "" : fmt::format(" {}", result.unit);
    text(fmt::format("values: {:.4g} to {:.4g}{}", result.least, result.greatest, unit));
    if (result.faulty > 0) {
        ImGui::TextColored({1.0F, 0.4F, 1.0F, 1.0F}, "%u texels have infinite values or no numbers",
                           result.faulty);
    }
}

void draw_texel(const InspectionResult& result) {
    if (!result.texel) return ImGui::TextDisabled("point at a texel to see its values");
    text(words_of(*result.texel, result.unit));
}

void draw_range(Inspection& inspection, const InspectionResult& result) {
    bool automatic = !inspection.range;
    const std::string unit = result.unit.empty() ? "" : fmt::format(" {}", result.unit);
    if (checkbox("automatic range", automatic, "from the least to the greatest value of what is shown")) {
        inspection.range = automatic ? std::nullopt : std::optional(ValueRange{result.low, result.high});
    }
    if (!inspection.range) return text(fmt::format("{:.4g} to {:.4g}{}", result.low, result.high, unit));
    constexpr float any = 1e30F;
    const float speed = std::max(0.005F * (inspection.range->high - inspection.range->low), 1e-6F);
    drag("low", inspection.range->low, speed, -any, any, "value at the low end of the colours");
    drag("high", inspection.range->high, speed, -any, any, "value at the high end of the colours");
}

/// The colours of the heat map, from the low to the high end of the range.
void draw_ramp(const InspectionResult& result) {
    constexpr int steps = 64;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x / steps;
    const float height = 0.7F * ImGui::GetFontSize();
    for (int i = 0; i < steps; ++i) {
        const glm::vec3 colour = heat_colour((static_cast<float>(i) + 0.5F) / steps);
        const float left = corner.x + static_cast<float>(i) * width;
        ImGui::GetWindowDrawList()->AddRectFilled(
            {left, corner.y}, {left + width, corner.y + height},
            ImGui::ColorConvertFloat4ToU32({colour.r, colour.g, colour.b, 1.0F}));
    }
    ImGui::Dummy({steps * width, height});
    note_control("heat", fmt::format("{:.4g} to {:.4g} {}", result.low, result.high, result.unit).c_str());
}

void draw_texture_controls(Inspection& inspection, const InspectionResult& result) {
    int mip = static_cast<int>(inspection.mip);
    int layer = static_cast<int>(inspection.layer);
    if (result.mips > 1 && slide("mip level", mip, 0, static_cast<int>(result.mips) - 1, "0: the largest")) {
        inspection.mip = static_cast<std::uint32_t>(mip);
    }
    if (result.layers > 1 && slide("layer", layer, 0, static_cast<int>(result.layers) - 1,
                                   "of an array; the face of a cube; the slice of clusters")) {
        inspection.layer = static_cast<std::uint32_t>(layer);
    }
    choose("colours", inspection.mapping,
           std::array{Mapping::automatic, Mapping::colour, Mapping::depth, Mapping::heat},
           "how values become colours; depth is in metres where its meaning is known");
    choose("channels", inspection.channels,
           std::array{Channels::rgb, Channels::red, Channels::green, Channels::blue, Channels::alpha},
           "which of the texture's channels are shown");
    draw_range(inspection, result);
    if (result.mapping == Mapping::heat) draw_ramp(result);
    draw_histogram(result);
    draw_texel(result);
}

/// A table with a line for each element that was read, and a column for each field.
void draw_elements(const BufferElements& elements) {
    const std::size_t read = elements.bytes.size() / std::max(elements.stride, 1U);
    text(fmt::format("{} elements of {} bytes; the first {}:", elements.count, elements.stride, read));
    if (elements.fields.empty()) return text("The fields of this buffer are not known.");
    constexpr ImGuiTableFlags plain = ImGuiTableFlags_ScrollX | ImGuiTableFlags_ScrollY |
                                      ImGuiTableFlags_BordersInnerV | ImGuiTableFlags_RowBg |
                                      ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_NoSavedSettings;
    const int columns = static_cast<int>(elements.fields.size()) + 1;
    const float height = ImGui::GetTextLineHeightWithSpacing() * static_cast<float>(read + 2);
    const ImVec2 room = ImGui::GetIO().DisplaySize;
    if (!ImGui::BeginTable("elements", columns, plain, {0.5F * room.x, std::min(height, 0.6F * room.y)})) {
        return;
    }
    ImGui::TableSetupScrollFreeze(1, 1);
    ImGui::TableSetupColumn("");
    for (const ElementField& field : elements.fields) ImGui::TableSetupColumn(field.name.c_str());
    ImGui::TableHeadersRow();
    ImGuiListClipper lines;
    lines.Begin(static_cast<int>(read));
    while (lines.Step()) {
        for (int line = lines.DisplayStart; line < lines.DisplayEnd; ++line) {
            ImGui::TableNextColumn();
            text(fmt::format("{}", line));
            for (const ElementField& field : elements.fields) {
                ImGui::TableNextColumn();
                text(words_of(elements, field, static_cast<std::size_t>(line)));
            }
        }
    }
    ImGui::EndTable();
}

}  // namespace

std::optional<glm::uvec2> texel_at(const InspectionResult& result, const Rectangle& picture,
                                   glm::vec2 pointer) {
    if (!picture.contains(pointer) || result.texel_size == 0) return std::nullopt;
    glm::vec2 share = (pointer - picture.corner) / picture.size;
    share.y = 1.0F - share.y;  // the bottom row is the first
    const glm::vec2 place = glm::max(share * glm::vec2(result.extent), glm::vec2(0.0F));
    return glm::min(glm::uvec2(place), glm::max(result.extent, 1U) - 1U) / result.texel_size;
}

std::string words_of(const InspectedTexel& texel, std::string_view unit) {
    std::string words = fmt::format("texel {}, {}:", texel.at.x, texel.at.y);
    for (std::uint32_t i = 0; i < std::min(texel.channel_count, 4U); ++i) {
        words += fmt::format(" {:.5g}", texel.channels[static_cast<glm::length_t>(i)]);
    }
    if (!texel.metres) return unit.empty() ? words : fmt::format("{} {}", words, unit);
    return *texel.metres > 0.0F ? fmt::format("{}, {:.4g} m", words, *texel.metres) : words + ", no surface";
}

std::string words_of(const BufferElements& elements, const ElementField& field, std::size_t index) {
    const bool is_whole = field.type == NumberType::uint32 || field.type == NumberType::int32;
    std::string words;
    for (const double number : numbers_of(elements, field, index)) {
        if (!words.empty()) words += ' ';
        words += is_whole ? fmt::format("{:.0f}", number) : fmt::format("{:.4g}", number);
    }
    return words;
}

void draw_resource(const std::string& name, Inspection& inspection, const InspectionResult& result,
                   const BufferElements& elements, const Rectangle& scene) {
    if (result.texture != 0) {
        const Rectangle picture = fitted(result, scene);
        draw_picture(result.texture, picture);
        const ImGuiIO& io = ImGui::GetIO();
        // Beside the picture the last values stay.
        const auto pointed = texel_at(result, picture, {io.MousePos.x, io.MousePos.y});
        if (pointed && !io.WantCaptureMouse) inspection.texel = pointed;
    }
    const float inset = 0.6F * ImGui::GetFontSize();
    const bool is_buffer = result.texture == 0 && elements.count > 0;
    ImGui::SetNextWindowPos({scene.corner.x + inset, scene.corner.y + inset});
    ImGui::SetNextWindowSizeConstraints({0.0F, 0.0F},
                                        {scene.size.x - 2.0F * inset, scene.size.y - 2.0F * inset});
    ImGui::SetNextWindowBgAlpha(0.85F);
    constexpr ImGuiWindowFlags fixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove |
                                       ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                                       ImGuiWindowFlags_NoFocusOnAppearing;
    if (ImGui::Begin("resource", nullptr, fixed)) {
        ImGui::PushItemWidth(12.0F * ImGui::GetFontSize());
        text(fmt::format("{}: {}", name, result.description));
        ImGui::TextDisabled("Esc: back to the picture; N: the next resource");
        if (result.texture != 0) draw_texture_controls(inspection, result);
        if (is_buffer) draw_elements(elements);
        ImGui::PopItemWidth();
    }
    ImGui::End();
}

}  // namespace candela::sandbox
