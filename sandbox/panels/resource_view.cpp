#include "sandbox/panels/resource_view.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

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
void draw_fitted(const InspectionResult& result, const Rectangle& space) {
    const glm::vec2 size(result.size);
    const float factor = std::min(space.size.x / size.x, space.size.y / size.y);
    const glm::vec2 corner = space.corner + 0.5F * (space.size - factor * size);
    draw_picture(result.texture, {corner, factor * size});
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
    if (result.texture != 0) draw_fitted(result, scene);
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
