#include "renderer/passes/surfels/surfel_visibility.hpp"

#include <algorithm>
#include <optional>
#include <unordered_map>

#include <candela/graph/execute.hpp>
#include "renderer/gpu/compute_steps.hpp"
#include "renderer/gpu/growing_buffer.hpp"
#include "renderer/passes/scene/changed_boxes.hpp"
#include "renderer/passes/scene/traced_content.hpp"

namespace candela {
namespace {

/// What rays between surfels depend on besides these and the scene.
struct VisibilityKey {
    float ray_offset = 0.0F;  // metres
    bool planned = false;     // VisibilityNode::planned
    bool operator==(const VisibilityKey&) const = default;
};

struct VisibilityPrograms {
    const gl::Program& kept;
    const gl::Program& factors;
    const gl::Program& cover;
    const gl::Program& rows;
};

/// Resources of the node.
struct VisibilityNode {
    Tracing tracing;
    ValueHandle<SceneMotion> motion;
    SurfelVisibility out;
    BufferHandle<std::uint32_t> cover;   // COVER_PARTS numbers of hits per surfel
    BufferHandle<std::uint32_t> kept;    // KeptSurfels::last
    BufferHandle<std::uint32_t> tasks;   // SurfelTasks::of
    BufferHandle<std::uint32_t> listed;  // ListedSurfels
    BufferHandle<std::uint32_t> last_form_factors;
    BufferHandle<std::uint32_t> last_cover;
    TracedContent<VisibilityKey> known;
    ChangedBoxes changed;
    ValueHandle<std::vector<std::uint64_t>> known_ids;  // Surfels::ids, or with planned tasks Surfels::cells
    std::optional<ValueHandle<SurfelTasks>> planned;
    float most_scale;  // of a form factor: surfel_rows.comp
    VisibilityPrograms programs;
};

/// Where the form factors are that may have changed.
struct ListedSurfels {
    std::vector<std::uint32_t> rows;
    std::vector<std::uint32_t> pairs;  // of columns
};

/// What is to be traced.
struct Outdated {
    std::optional<std::vector<Box>> changed;  // see changed_boxes; none: nothing is known
    ListedSurfels listed;
    bool has_tasks = false;        // they are known
    bool in_place = true;          // KeptSurfels
    std::uint32_t last_count = 0;  // of surfels
};

/// Last round of scaling. Even, so that its results are in the first half of the rows.
constexpr std::uint32_t last_round = 4;

std::uint64_t factor_words(std::uint32_t surfels) {
    return std::uint64_t{surfels} * surfel_columns(surfels).count / 2;
}

std::vector<ObjectId> objects_of(const Execution& run, const VisibilityNode& node) {
    return {run.object(node.out.form_factors), run.object(node.cover)};
}

void reserve_results(Execution& run, const VisibilityNode& node, std::uint32_t count) {
    run.reserve(node.out.form_factors, factor_words(count));
    run.reserve(node.out.rows, 2 * std::uint64_t{count});
    run.reserve(node.cover, std::uint64_t{count} * COVER_PARTS);
}

/// All that has changed.
std::vector<std::uint32_t> tasks_of(const KeptSurfels& kept) {
    std::vector<std::uint32_t> tasks;
    tasks.reserve(kept.last.size());
    for (const std::uint32_t last : kept.last) {
        tasks.push_back(last == NO_SURFEL ? SURFEL_WHOLE | SURFEL_COLUMN : SURFEL_CHANGED);
    }
    return tasks;
}

/// `cleared`: where nothing is to be traced, form factors are 0 already.
ListedSurfels listed_surfels(const std::vector<std::uint32_t>& tasks, bool has_moved, bool cleared) {
    const std::uint32_t stride = surfel_columns(static_cast<std::uint32_t>(tasks.size())).stride;
    const std::uint32_t to_clear = cleared ? 0U : SURFEL_NO_FACTORS;
    const std::uint32_t of_rows = SURFEL_WHOLE | to_clear | (has_moved ? SURFEL_CHANGED : 0U);
    ListedSurfels listed;
    for (std::uint32_t i = 0; i < tasks.size(); ++i) {
        if ((tasks[i] & of_rows) != 0) listed.rows.push_back(i);
        const std::uint32_t pair = i / stride / 2;
        const bool has_column = (tasks[i] & (SURFEL_COLUMN | to_clear)) != 0;
        if (has_column && (listed.pairs.empty() || listed.pairs.back() != pair)) listed.pairs.push_back(pair);
    }
    return listed;
}

void upload_tasks(const Gpu& gpu, Execution& run, const VisibilityNode& node, const KeptSurfels& kept,
                  const std::vector<std::uint32_t>& tasks, const ListedSurfels& surfels) {
    upload<std::uint32_t>(gpu, run, node.kept, kept.last);
    upload<std::uint32_t>(gpu, run, node.tasks, tasks);
    std::vector<std::uint32_t> listed = surfels.rows;
    listed.insert(listed.end(), surfels.pairs.begin(), surfels.pairs.end());
    upload<std::uint32_t>(gpu, run, node.listed, listed);
}

void copy_results(const Gpu& gpu, Execution& run, const VisibilityNode& node, std::uint32_t count) {
    copy_content(gpu, run, node.out.form_factors, node.last_form_factors, factor_words(count));
    copy_content(gpu, run, node.cover, node.last_cover, std::uint64_t{count} * COVER_PARTS);
}

/// If all surfels are new ones, all results become 0, and only what is traced now is written.
void clear_results(const Gpu& gpu, const Execution& run, const VisibilityNode& node, Outdated& outdated) {
    const std::uint32_t none = 0;
    // The graph plans the barriers for shaders only.
    gpu.gl().MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    for (const ObjectId object : objects_of(run, node)) {
        gpu.gl().ClearNamedBufferData(object, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &none);
    }
    outdated.changed = std::vector<Box>{};
    outdated.in_place = true;
}

/// What has changed, and what is to be traced of each surfel.
struct OutdatedParts {
    std::optional<std::vector<Box>> boxes;  // see changed_boxes; none: nothing is known
    std::vector<std::uint32_t> tasks;       // SurfelTasks::of
};

/// Since the results were traced that are in the objects `held`.
OutdatedParts outdated_parts(Execution& run, const VisibilityNode& node, const KeptSurfels& kept,
                             const std::vector<ObjectId>& held) {
    const VisibilityKey key{run.value(node.tracing.metrics).ray_offset(), node.planned.has_value()};
    const std::vector<ObjectId> objects = objects_of(run, node);
    if (!node.planned) {
        return {node.known.outdated(run, run.value(node.motion), key, held, objects), tasks_of(kept)};
    }
    const SurfelTasks& tasks = run.value(*node.planned);
    switch (node.known.tasks_done(run, tasks.number, key, held, objects)) {
        case TasksDone::all:
            return {std::vector<Box>{}, std::vector<std::uint32_t>(tasks.of.size())};
        case TasksDone::all_before:
            return {tasks.changed, tasks.of};
        case TasksDone::none:
            break;
    }
    return {std::nullopt, tasks.of};
}

/// Makes room for the results, and keeps the last ones where the shaders find them.
Outdated prepare_results(const Gpu& gpu, Execution& run, const VisibilityNode& node) {
    const Surfels& surfels = node.out.surfels;
    const std::vector<std::uint64_t>& ids = run.value(node.planned ? surfels.cells : surfels.ids);
    const auto* const known = run.previous(node.known_ids);
    const KeptSurfels kept = kept_surfels(known != nullptr ? *known : std::vector<std::uint64_t>{}, ids);
    const auto count = static_cast<std::uint32_t>(ids.size());
    Outdated outdated{.changed = {}, .listed = {}, .in_place = kept.in_place, .last_count = kept.last_count};
    if (kept.keeps_factors() && !kept.in_place) copy_results(gpu, run, node, kept.last_count);
    const std::vector<ObjectId> held = objects_of(run, node);
    reserve_results(run, node, count);
    auto [boxes, tasks] = outdated_parts(run, node, kept, held);
    if (kept.keeps_factors()) outdated.changed = std::move(boxes);
    const bool nothing_known = node.planned && std::ranges::all_of(tasks, [](std::uint32_t task) {
                                   return (task & (SURFEL_NO_FACTORS | SURFEL_COLUMN)) != 0;
                               });
    if (nothing_known) clear_results(gpu, run, node, outdated);
    const bool has_moved = outdated.changed && !outdated.changed->empty();
    outdated.listed = listed_surfels(tasks, has_moved, nothing_known);
    outdated.has_tasks = outdated.changed || node.planned;
    if (outdated.has_tasks) upload_tasks(gpu, run, node, kept, tasks, outdated.listed);
    run.set(node.known_ids, ids);
    return outdated;
}

/// If few rows may have changed, only these and the columns of new surfels: each invocation takes time even
/// if it traces nothing.
void find_form_factors(ComputeSteps& steps, const gl::Program& program, std::uint32_t count,
                       const Outdated& outdated, const gl::Uniforms& uniforms) {
    const auto run = [&](std::uint32_t rows, std::uint32_t pairs, bool list_rows, bool list_pairs) {
        const auto first_pair = static_cast<std::uint32_t>(outdated.listed.rows.size());
        steps.run(program, {groups(rows, SURFEL_GROUP), pairs},
                  uniforms + gl::Uniforms{{"listed_rows", list_rows ? rows : 0U},
                                          {"listed_pairs", list_pairs ? pairs : 0U},
                                          {"first_pair", first_pair}});
    };
    const std::uint32_t pairs = surfel_columns(count).count / 2;
    const auto rows = static_cast<std::uint32_t>(outdated.listed.rows.size());
    const auto listed_pairs = static_cast<std::uint32_t>(outdated.listed.pairs.size());
    if (!outdated.changed || rows == count) {
        run(count, pairs, false, false);
        return;
    }
    if (rows > 0) run(rows, pairs, true, false);
    if (listed_pairs > 0) run(count, listed_pairs, false, true);
}

void find_visibility(const Gpu& gpu, Execution& run, const VisibilityNode& node, const Outdated& outdated) {
    constexpr std::uint32_t most_a_line = 32768;  // work groups
    const VisibilityPrograms& programs = node.programs;
    const std::uint32_t count = run.value(node.out.surfels.counts).all_surfels();
    const float ray_offset = run.value(node.tracing.metrics).ray_offset();
    const gl::Uniforms common = count_uniforms(count);
    const gl::Uniforms traced = common + node.changed.upload(gpu, run, outdated.changed, 4.0F * ray_offset) +
                                gl::Uniforms{{"ray_offset", ray_offset}, {"has_tasks", outdated.has_tasks}};
    const std::uint32_t surfel_groups = groups(count, SURFEL_GROUP);
    ComputeSteps steps(gpu);
    if (outdated.changed && !outdated.in_place) {
        const std::uint32_t words_a_row =
            std::max<std::uint32_t>(surfel_columns(count).count / 2, COVER_PARTS);
        steps.run(programs.kept, {surfel_groups, words_a_row},
                  common + gl::Uniforms{{"last_surfel_count", outdated.last_count}});
    }
    find_form_factors(steps, programs.factors, count, outdated, traced);
    steps.run(programs.cover, {std::min(count, most_a_line), groups(count, most_a_line)}, traced);
    for (std::uint32_t round = 0; round <= last_round; ++round) {
        steps.run(programs.rows, {surfel_groups},
                  common + gl::Uniforms{{"round", round}, {"most_scale", node.most_scale}});
    }
}

}  // namespace

SurfelColumns surfel_columns(std::uint32_t surfels) {
    const std::uint32_t stride = std::max((surfels + MOST_COLUMNS - 1) / MOST_COLUMNS, 1U);
    const std::uint32_t count = (surfels + stride - 1) / stride;
    return {.count = count + count % 2, .stride = stride};
}

bool KeptSurfels::keeps_factors() const {
    const auto has_stride = [](std::size_t surfels) {
        return surfel_columns(static_cast<std::uint32_t>(surfels)).stride > 1;
    };
    return in_place || !(has_stride(last.size()) || has_stride(last_count));
}

gl::Uniforms count_uniforms(std::uint32_t surfels) {
    const SurfelColumns columns = surfel_columns(surfels);
    return {{"surfel_count", surfels}, {"columns", columns.count}, {"column_stride", columns.stride}};
}

KeptSurfels kept_surfels(std::span<const std::uint64_t> last_ids, std::span<const std::uint64_t> ids) {
    std::unordered_map<std::uint64_t, std::uint32_t> last_indices;
    for (std::uint32_t i = 0; i < last_ids.size(); ++i) last_indices.emplace(last_ids[i], i);
    KeptSurfels kept{.last = {},
                     .in_place = last_ids.size() == ids.size(),
                     .last_count = static_cast<std::uint32_t>(last_ids.size())};
    kept.last.reserve(ids.size());
    for (std::uint32_t i = 0; i < ids.size(); ++i) {
        const auto found = last_indices.find(ids[i]);
        kept.last.push_back(found == last_indices.end() ? NO_SURFEL : found->second);
        if (kept.last[i] != NO_SURFEL && kept.last[i] != i) kept.in_place = false;
    }
    return kept;
}

SurfelVisibility add_surfel_visibility(FrameGraph& graph, Gpu& gpu, const Tracing& tracing,
                                       const Surfels& surfels, ValueHandle<SceneMotion> motion,
                                       bool shares_items, std::optional<ValueHandle<SurfelTasks>> tasks) {
    return graph.add("surfel-visibility", [&](Pass& pass) {
        pass.read(surfels.counts);
        pass.read(tasks ? surfels.cells : surfels.ids);
        if (tasks) {
            pass.keeps_state();
            pass.read(*tasks);
        }
        pass.read(surfels.surfels, {Usage::storage, BINDING_SURFELS});
        pass.read(surfels.points, {Usage::storage, BINDING_CELL_POINTS});
        pass.read(motion);
        read_tracing(pass, tracing);
        const auto words = [&](std::string_view name) { return growing_buffer<std::uint32_t>(graph, name); };
        const SurfelVisibility out{
            .surfels = surfels,
            .form_factors = pass.update(words("form factors"), {Usage::storage, BINDING_FORM_FACTORS}),
            .rows = pass.write(growing_buffer<glm::vec2>(graph, "surfel rows"),
                               {Usage::storage, BINDING_SURFEL_ROWS})};
        const VisibilityNode node{
            .tracing = tracing,
            .motion = motion,
            .out = out,
            .cover = pass.update(words("surfel cover"), {Usage::storage, BINDING_COVER}),
            .kept = pass.write(words("kept surfels"), {Usage::copy, BINDING_KEPT_SURFELS}),
            .tasks = pass.write(words("surfel tasks"), {Usage::copy, BINDING_SURFEL_TASKS}),
            .listed = pass.write(words("listed surfels"), {Usage::copy, BINDING_LISTED_SURFELS}),
            .last_form_factors =
                pass.write(words("last form factors"), {Usage::copy, BINDING_LAST_FORM_FACTORS}),
            .last_cover = pass.write(words("last surfel cover"), {Usage::copy, BINDING_LAST_COVER}),
            .known = TracedContent<VisibilityKey>(graph, pass, "known visibility"),
            .changed = ChangedBoxes(graph, pass, "changed boxes of visibility"),
            .known_ids = pass.update(graph.value<std::vector<std::uint64_t>>("ids of known visibility")),
            .planned = tasks,
            .most_scale = shares_items ? 1e4F : 2.0F,
            .programs = {.kept = gpu.program({"surfels/surfel_kept.comp"}),
                         .factors = gpu.program({"surfels/surfel_form_factors.comp"}),
                         .cover = gpu.program({"surfels/surfel_cover.comp"}),
                         .rows = gpu.program({"surfels/surfel_rows.comp"})}};
        pass.run([=, &gpu](Execution& run) {
            const Outdated outdated = prepare_results(gpu, run, node);
            if (run.value(surfels.counts).all_surfels() > 0) find_visibility(gpu, run, node, outdated);
        });
        return out;
    });
}

}  // namespace candela
