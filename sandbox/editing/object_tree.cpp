#include "sandbox/editing/object_tree.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <tuple>
#include <utility>

#include <candela/scene/components.hpp>
#include "sandbox/scene/scene.hpp"

namespace candela::sandbox {

namespace {

std::string without_case(std::string_view text) {
    std::string lower(text);
    std::ranges::transform(lower, lower.begin(), [](unsigned char letter) {
        return static_cast<char>(letter < 128 ? std::tolower(letter) : letter);
    });
    return lower;
}

Entity parent_of(const World& world, Entity entity) {
    const auto* transform = world.find<Transform>(entity);
    return transform != nullptr && world.alive(transform->parent) ? transform->parent : Entity{};
}

std::map<Entity, std::string_view> kinds_of(const World& world) {
    std::map<Entity, std::string_view> kinds;
    for (auto [entity, mesh] : world.view<MeshInstance>()) kinds[entity] = "mesh";
    visit_lights(world, [&]<class Light>(Entity entity, const Light& /*light*/) {
        kinds[entity] = light_traits<Light>.name;
    });
    std::vector<Entity> ahead;
    ahead.reserve(kinds.size());
    for (const auto& [entity, kind] : kinds) ahead.push_back(entity);
    while (!ahead.empty()) {
        const Entity parent = parent_of(world, ahead.back());
        ahead.pop_back();
        if (parent != Entity{} && kinds.emplace(parent, "group").second) ahead.push_back(parent);
    }
    return kinds;
}

using Children = std::map<Entity, std::vector<ObjectRow>>;

/// Depth first, without recursion: files may nest deeply.
std::vector<ObjectRow> in_order(Children children) {
    std::vector<ObjectRow> rows;
    const auto put = [](std::vector<ObjectRow>& stack, std::vector<ObjectRow> siblings, int depth) {
        std::ranges::sort(siblings, [](const ObjectRow& a, const ObjectRow& b) {
            return std::tie(b.name, b.entity) < std::tie(a.name, a.entity);
        });
        for (ObjectRow& row : siblings) {
            row.depth = depth;
            stack.push_back(std::move(row));
        }
    };
    std::vector<ObjectRow> stack;
    put(stack, std::exchange(children[Entity{}], {}), 0);
    while (!stack.empty()) {
        rows.push_back(std::move(stack.back()));
        stack.pop_back();
        const auto below = children.find(rows.back().entity);
        if (below != children.end()) put(stack, std::exchange(below->second, {}), rows.back().depth + 1);
    }
    return rows;
}

}  // namespace

std::vector<ObjectRow> object_rows(const World& world, std::string_view find) {
    Children children;
    const std::string wanted = without_case(find);
    for (const auto& [entity, kind] : kinds_of(world)) {
        ObjectRow row{entity, name_of(world, entity), kind, 0};
        if (!wanted.empty() && without_case(row.name).find(wanted) == std::string::npos) continue;
        children[wanted.empty() ? parent_of(world, entity) : Entity{}].push_back(std::move(row));
    }
    return in_order(std::move(children));
}

const std::vector<ObjectRow>& ObjectTree::rows(const World& world) {
    if (made_at_ != world.revision() || made_for_ != find) {
        made_at_ = world.revision();
        made_for_ = find;
        rows_ = object_rows(world, find);
    }
    return rows_;
}

}  // namespace candela::sandbox
