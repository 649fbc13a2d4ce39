#include "renderer/passes/scene/kept_layout.hpp"

#include <algorithm>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace candela {
namespace {

/// The numbers of the items that differ, also of those that only one of both has.
std::vector<std::uint32_t> changed_items(const SharedArray<SceneGeometry::Item>& before,
                                         const SharedArray<SceneGeometry::Item>& now) {
    std::vector<std::uint32_t> changed;
    visit_differences(before, now, [&](std::size_t i) { changed.push_back(static_cast<std::uint32_t>(i)); });
    const std::size_t most = std::max(before.size(), now.size());
    for (std::size_t i = std::min(before.size(), now.size()); i < most; ++i) {
        changed.push_back(static_cast<std::uint32_t>(i));
    }
    return changed;
}

}  // namespace

bool KeptLayout::update(Execution& run, const Buffers& buffers, const SceneGeometry& geometry,
                        const Deformations& deformed) {
    const bool other_items = layout_.geometry != geometry;
    if (other_items) {
        follow(geometry);
        drop_unused();
        materials_.upload(run, buffers.materials, buffers.texels, layout_);
    }
    const bool moved = meshes_.upload(*gpu_, run, buffers.vertices, buffers.indices, layout_, deformed);
    if (!other_items && !moved) return false;
    set_draws(moved);
    list_groups();
    return true;
}

/// Adds and removes drawables. Those of items that only have another number keep theirs.
void KeptLayout::follow(const SceneGeometry& geometry) {
    struct Before {
        SceneGeometry::Item item;
        std::uint32_t first;  // drawable
    };
    const std::vector<std::uint32_t> changed = changed_items(layout_.geometry.items, geometry.items);
    std::unordered_map<std::uint32_t, Before> before;  // by the entity's index
    for (const std::uint32_t i : changed) {
        if (i >= layout_.geometry.items.size() || !layout_.geometry.items[i].mesh) continue;
        const SceneGeometry::Item& item = layout_.geometry.items[i];
        before.insert({item.entity.index, {item, layout_.first_of_item[i]}});
    }
    layout_.first_of_item.resize(geometry.items.size());
    std::vector<std::uint32_t> added;
    for (const std::uint32_t i : changed) {
        if (i >= geometry.items.size()) continue;
        const auto found = before.find(geometry.items[i].entity.index);
        layout_.first_of_item.set(i, SceneLayout::none);
        if (found != before.end() && found->second.item == geometry.items[i]) {
            move(found->second.first, i);
            before.erase(found);
        } else if (geometry.items[i].mesh) {
            added.push_back(i);
        }
    }
    for (const auto& [entity, gone] : before) remove(gone.item, gone.first);
    for (const std::uint32_t i : added) add(geometry, i);
    layout_.geometry = geometry;
}

void KeptLayout::add(const SceneGeometry& geometry, std::uint32_t item) {
    const SceneGeometry::Item& added = geometry.items[item];
    const MeshTable::Primitives& primitives = meshes_.take(added.mesh, materials_);
    std::uint32_t next = SceneLayout::none;
    for (std::size_t i = primitives.size(); i-- > 0;) {  // from the end, as each one knows the next
        const std::shared_ptr<const DrawnPrimitive>& drawn = primitives[i];
        const std::uint32_t number = take_number();
        layout_.drawables.set(
            number,
            {.entity = added.entity, .item = item, .next = std::exchange(next, number), .drawn = drawn});
        order_.insert(group_of(*drawn, added.mirrored)->second.places, key_of(added.entity, *drawn), number);
        if (added.deformed) meshes_.add_deformed(number, *drawn);
    }
    layout_.first_of_item.set(item, next);
}

/// `first`: its first drawable.
void KeptLayout::remove(const SceneGeometry::Item& item, std::uint32_t first) {
    for (std::uint32_t number = first; number != SceneLayout::none;) {
        const Drawable gone = layout_.drawables[number];
        order_.remove(group_of(*gone.drawn, item.mirrored)->second.places, layout_.draw_of[number]);
        meshes_.remove_deformed(number);
        layout_.drawables.set(number, {});
        free_.push_back(number);
        number = gone.next;
    }
    meshes_.release(*item.mesh);
}

void KeptLayout::move(std::uint32_t first, std::uint32_t item) {
    layout_.first_of_item.set(item, first);
    for (std::uint32_t number = first; number != SceneLayout::none;) {
        Drawable moved = layout_.drawables[number];
        moved.item = item;
        layout_.drawables.set(std::exchange(number, moved.next), moved);
    }
}

std::uint32_t KeptLayout::take_number() {
    if (free_.empty()) {
        const auto number = static_cast<std::uint32_t>(layout_.drawables.size());
        layout_.drawables.push_back({});
        layout_.draw_of.push_back(0);
        return number;
    }
    const std::uint32_t number = free_.back();
    free_.pop_back();
    return number;
}

/// The group of a primitive's draws.
KeptLayout::Groups::iterator KeptLayout::group_of(const DrawnPrimitive& drawn, bool mirrored) {
    const Material& material = *drawn.primitive().material;
    const auto [group, is_new] = groups_.try_emplace({drawn_alpha(material), material.double_sided, mirrored,
                                                      emits(material), materials_.images_of(drawn.material)});
    if (is_new) {
        group->second.material =
            std::make_shared<const MaterialBinding>(materials_.binding_of(drawn.material));
    }
    return group;
}

void KeptLayout::drop_unused() {
    for (auto group = groups_.begin(); group != groups_.end();) {
        const bool is_empty = group->second.places.used == 0;
        if (is_empty) order_.drop(group->second.places);
        group = is_empty ? groups_.erase(group) : std::next(group);
    }
    meshes_.drop_unused(materials_);
    materials_.drop_unused();
    if (!order_.is_sparse()) return;
    std::vector<DrawOrder::Group*> groups;
    for (auto& [key, group] : groups_) groups.push_back(&group.places);
    order_.compact(groups);
}

/// `all`: not only at the places that have changed.
void KeptLayout::set_draws(bool all) {
    std::vector<std::uint32_t> places = order_.take_changed();
    if (all) {
        places.resize(order_.size());
        std::iota(places.begin(), places.end(), 0U);
    }
    layout_.draws.resize(order_.size());
    for (const std::uint32_t place : places) {
        const std::uint32_t number = order_.at(place);
        if (number == DrawOrder::none) {
            layout_.draws.set(place, {});
        } else {
            layout_.draws.set(place, meshes_.draw(number, *layout_.drawables[number].drawn));
            layout_.draw_of.set(number, place);
        }
    }
}

/// By the first things in them, as the numbers of their images depend on what has come and gone before.
void KeptLayout::list_groups() {
    std::vector<std::pair<DrawOrder::Key, Groups::const_iterator>> sorted;
    for (auto group = groups_.cbegin(); group != groups_.cend(); ++group) {
        sorted.emplace_back(order_.first_key(group->second.places), group);
    }
    std::ranges::sort(sorted, [](const auto& a, const auto& b) {
        return std::tie(a.second->first.alpha, a.first) < std::tie(b.second->first.alpha, b.first);
    });
    layout_.groups.clear();
    for (const auto& [key, group] : sorted) {
        layout_.groups.push_back({.first_draw = group->second.places.first,
                                  .draw_count = group->second.places.count,
                                  .material = group->second.material,
                                  .mirrored = group->first.mirrored});
    }
}

}  // namespace candela
