#include "sandbox/panels/graph_panel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <candela/graph/describe.hpp>

#include "sandbox/panels/controls.hpp"

namespace candela::sandbox {

namespace {

constexpr ImU32 arc_colour = IM_COL32(120, 120, 120, 70);
constexpr ImU32 input_colour = IM_COL32(110, 190, 255, 255);
constexpr ImU32 output_colour = IM_COL32(255, 170, 80, 255);

/// From green to red with the share of the frame's time; grey for a pass that did not run.
ImU32 cost_colour(const PassCost& cost, double frame_ms) {
    if (!cost.ran) return IM_COL32(70, 70, 70, 255);
    const double share = frame_ms > 0.0 ? std::min(cost.last_ms() / frame_ms, 1.0) : 0.0;
    // The square root makes small shares visible.
    const auto heat = static_cast<float>(std::sqrt(share));
    return ImGui::ColorConvertFloat4ToU32({0.15F + 0.65F * heat, 0.5F - 0.3F * heat, 0.2F, 1.0F});
}

void draw_plot(const PassCost& cost) {
    const std::string label =
        fmt::format("{}: {:.2f} ms, mean {:.2f}", cost.name, cost.last_ms(), cost.mean_ms);
    ImGui::PlotLines("##costs", cost.history.data(), static_cast<int>(cost.history.size()), 0, label.c_str(),
                     0.0F, std::numeric_limits<float>::max(),
                     {ImGui::GetContentRegionAvail().x, 3.5F * ImGui::GetFontSize()});
    note_control("costs", "milliseconds of the last runs, the longer of CPU and GPU time");
}

const PassCost* cost_of(const PassCosts& costs, const std::string& pass) {
    const auto found = std::ranges::find(costs.passes(), pass, &PassCost::name);
    return found == costs.passes().end() ? nullptr : &*found;
}

void list_resource(const GraphDescription& graph, std::size_t index, std::string_view verb,
                   std::optional<std::string>& chosen) {
    const DescribedResource& resource = graph.resources[index];
    if (is_of_inspection(resource.name)) return;
    const std::string label = fmt::format("{} {}", verb, resource.name);
    if (!can_be_shown(graph, index)) {
        ImGui::TextDisabled("%s", label.c_str());
    } else if (ImGui::Selectable(label.c_str(), chosen == resource.name)) {
        if (chosen == resource.name) {
            chosen.reset();
        } else {
            chosen = resource.name;
        }
    }
    note_control(resource.name,
                 fmt::format("{}, {}", storage_text(resource), to_string(resource.lifetime)).c_str());
}

/// The resources of the chosen pass, those that it reads, then those that it writes; and why it runs after
/// others.
void list_pass(GraphSelection& selection, const GraphDescription& graph) {
    if (!selection.pass) return;
    const auto pass = std::ranges::find(graph.passes, *selection.pass, &DescribedPass::name);
    if (pass == graph.passes.end()) return;
    for (const bool write : {false, true}) {
        for (const DescribedAccess& access : pass->accesses) {
            if (access.write == write) {
                list_resource(graph, access.resource, write ? "writes" : "reads", selection.resource);
            }
        }
    }
    const auto position = static_cast<std::size_t>(pass - graph.passes.begin());
    for (const DescribedEdge& edge : graph.edges) {
        if (edge.to != position) continue;
        ImGui::TextDisabled("after %s", edge_text(graph, edge).c_str());
    }
}

/// A point at the left edge of the line of each pass that is drawn, in screen coordinates.
using Anchors = std::vector<std::optional<ImVec2>>;

void draw_arc(const Anchors& anchors, const DescribedEdge& edge, float space, ImU32 colour, float thickness) {
    if (!anchors[edge.from] || !anchors[edge.to]) return;
    const ImVec2 from = *anchors[edge.from];
    const ImVec2 to = *anchors[edge.to];
    // The further apart, the further out, up to the space at the left.
    const float reach = space * (1.0F - 1.0F / (1.0F + 0.02F * std::abs(to.y - from.y)));
    const float out = 4.0F / 3.0F * reach;  // a cubic curve reaches three quarters of its control points
    ImGui::GetWindowDrawList()->AddBezierCubic(from, {from.x - out, from.y}, {to.x - out, to.y}, to, colour,
                                               thickness);
}

void draw_arcs(const GraphDescription& graph, const Anchors& anchors, float space, std::size_t focus) {
    for (const DescribedEdge& edge : graph.edges) draw_arc(anchors, edge, space, arc_colour, 1.0F);
    for (const DescribedEdge& edge : graph.edges) {
        if (edge.to == focus) draw_arc(anchors, edge, space, input_colour, 2.0F);
        if (edge.from == focus) draw_arc(anchors, edge, space, output_colour, 2.0F);
    }
}

/// Returns whether the line is under the pointer.
bool draw_pass(const DescribedPass& pass, const PassCost* cost, double frame_ms,
               std::optional<std::string>& chosen) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    const float height = ImGui::GetTextLineHeight() + 2.0F;
    if (ImGui::InvisibleButton(pass.name.c_str(), {std::max(width, 1.0F), height})) {
        if (chosen == pass.name) {
            chosen.reset();
        } else {
            chosen = pass.name;
        }
    }
    const bool hovered = ImGui::IsItemHovered();
    note_control(pass.name, nullptr);
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImU32 fill = cost != nullptr ? cost_colour(*cost, frame_ms) : IM_COL32(70, 70, 70, 255);
    const float rounding = pass.gpu ? 0.0F : 0.5F * height;  // passes on the CPU have round ends
    list->AddRectFilled(corner, {corner.x + width, corner.y + height}, fill, rounding);
    if (hovered || chosen == pass.name) {
        list->AddRect(corner, {corner.x + width, corner.y + height}, IM_COL32_WHITE, rounding);
    }
    const float inset = 0.5F * ImGui::GetFontSize();
    list->AddText({corner.x + inset, corner.y + 1.0F}, IM_COL32_WHITE, pass.name.c_str());
    if (cost == nullptr || cost->history.empty()) return hovered;
    const std::string times = fmt::format("{:.2f}  {:.2f}", cost->last_ms(), cost->mean_ms);
    const float text = ImGui::CalcTextSize(times.c_str()).x;
    list->AddText({corner.x + width - text - inset, corner.y + 1.0F}, IM_COL32_WHITE, times.c_str());
    if (hovered) {
        ImGui::SetTooltip("%s pass, %s in the last frame\nlast run: CPU %.3f ms, GPU %.3f ms; mean %.3f ms",
                          pass.gpu ? "GPU" : "CPU", cost->ran ? "ran" : "did not run", cost->cpu_ms,
                          cost->gpu_ms, cost->mean_ms);
    }
    return hovered;
}

}  // namespace

bool is_of_inspection(std::string_view name) {
    return name.starts_with("inspect");
}

bool can_be_shown(const GraphDescription& graph, std::size_t resource) {
    const DescribedResource& described = graph.resources[resource];
    if (described.kind == ResourceKind::value || described.lifetime == Lifetime::imported ||
        is_of_inspection(described.name)) {
        return false;
    }
    return std::ranges::none_of(graph.passes, [&](const DescribedPass& pass) {
        const bool is_last = pass.name.starts_with("exposure") || pass.name.starts_with("tone-map");
        return is_last && std::ranges::any_of(pass.accesses, [&](const DescribedAccess& access) {
                   return access.write && access.resource == resource;
               });
    });
}

void draw_graph_panel(GraphSelection& selection, const GraphDescription& graph, const PassCosts& costs) {
    const PassCost* plotted = selection.pass ? cost_of(costs, *selection.pass) : nullptr;
    draw_plot(plotted != nullptr ? *plotted : costs.frame());
    list_pass(selection, graph);
    ImGui::TextDisabled("last and mean ms; round: CPU; blue: needs, orange: is needed by");

    const float space = 4.0F * ImGui::GetFontSize();
    Anchors anchors(graph.passes.size());
    std::size_t focus = graph.passes.size();
    ImGui::Indent(space);
    for (std::size_t i = 0; i < graph.passes.size(); ++i) {
        const DescribedPass& pass = graph.passes[i];
        if (is_of_inspection(pass.name)) continue;
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        anchors[i] = ImVec2(corner.x, corner.y + 0.5F * ImGui::GetTextLineHeight());
        const bool chosen = selection.pass == pass.name;
        if (draw_pass(pass, cost_of(costs, pass.name), costs.frame().last_ms(), selection.pass) ||
            (chosen && focus == graph.passes.size())) {
            focus = i;
        }
    }
    ImGui::Unindent(space);
    draw_arcs(graph, anchors, space, focus);

    if (!header("all resources", false)) return;
    for (std::size_t i = 0; i < graph.resources.size(); ++i) {
        list_resource(graph, i, "", selection.resource);
    }
}

}  // namespace candela::sandbox
