#include "sandbox/window/view_commands.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <candela/graph/describe.hpp>

#include "sandbox/command_line/choose_configuration.hpp"

namespace candela::sandbox {

namespace {

/// The purposes come first in the list of named configurations.
void choose_preset(AppState& state, int number) {
    const auto named = named_configurations();
    const auto index = static_cast<std::size_t>(number - 1);
    if (index < named.size()) state.configuration = choose_named(state.configuration, named[index]);
}

void change_path(AppState& state, int step) {
    constexpr int count = static_cast<int>(all_shading_paths.size());
    const int next = (static_cast<int>(state.configuration.path) + step + count) % count;
    state.configuration.path = all_shading_paths.at(static_cast<std::size_t>(next));
}

void change_comparison(AppState& state) {
    Comparison& comparison = state.comparison;
    if (comparison.mode == CompareMode::off && comparison.other == Configuration{}) {
        comparison.other = state.configuration;
    }
    comparison.mode = static_cast<CompareMode>((static_cast<int>(comparison.mode) + 1) % 3);
}

/// The next texture or buffer of the graph; after the last one, the picture.
void change_resource(const GraphDescription& graph, GraphSelection& selection, int step) {
    std::vector<std::optional<std::string>> all{std::nullopt};
    for (std::size_t i = 0; i < graph.resources.size(); ++i) {
        if (can_be_shown(graph, i)) all.emplace_back(graph.resources[i].name);
    }
    const auto at = std::ranges::find(all, selection.resource);
    const auto index = at == all.end() ? 0 : at - all.begin();
    const auto count = static_cast<std::ptrdiff_t>(all.size());
    selection.resource = all[static_cast<std::size_t>((index + step + count) % count)];
}

}  // namespace

bool change_view(const Command& command, const GraphDescription& graph, AppState& state,
                 GraphSelection& selection) {
    switch (command.action) {
        case Action::panel:
            state.panel = !state.panel;
            return true;
        case Action::help:
            state.help = !state.help;
            return true;
        case Action::preset:
            choose_preset(state, command.number);
            return true;
        case Action::next_path:
            change_path(state, 1);
            return true;
        case Action::previous_path:
            change_path(state, -1);
            return true;
        case Action::compare:
            change_comparison(state);
            return true;
        case Action::next_resource:
            change_resource(graph, selection, 1);
            return true;
        case Action::previous_resource:
            change_resource(graph, selection, -1);
            return true;
        default:
            return false;
    }
}

}  // namespace candela::sandbox
