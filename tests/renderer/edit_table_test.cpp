// After each edit only the passes that depend on it run, according to the graph's own record, and the picture
// is that of a renderer that renders it from scratch.

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <candela/scene/deformed_mesh.hpp>
#include "tests/renderer/path_fixture.hpp"

TEST_SUITE("edits") {

using namespace candela;

namespace {

// x: the pass runs, in every path that has it; .: it does not run; o: it runs if there is another number of
// surfels, as the cells that a mesh stands on are divided. `surfaces` stands for gbuffer and
// depth-prepass, `shading` for forward, deferred and transparent. Of the light lists, `tiles` and `clusters`
// are not bounded by the depths of surfaces, `bounded` are bounded by the depths that `depths` computes, and
// `blended` are those for blended surfaces in front of them.
//
// Passes that read transforms (scene-gather, lights, view, surfel-focus) run whenever a transform has
// changed; passes that depend on them run only if their results differ. After a change of the picture's size
// or of the path, the surfaces are rendered and shaded again, because intermediate targets of other
// descriptions are not kept. Of the VPL passes, those from `paths` to `vpl-maps` belong to traced VPLs, those
// from `motion` to `surfel-maps` to surfels. `samples` are both passes of the estimate of the VPLs' error;
// the passes of the set that it compares with run whenever those of the shown set do. `keep` runs in every
// frame, as `tone-map` does.
constexpr std::string_view table = R"(
                     gather upload instances bvh lights plan shadows light-upload view view-upload view-cull paths trace vpl-constants vpl-maps motion focus spread surfels visibility surfel-light surfel-bounce surfel-constants surfel-maps samples surfaces tiles tile-grid clusters cluster-grid depths bounded blended shading tone-map
first frame            x      x        x      x    x     x      x         x        x        x          x       x     x         x          x       x      x     x       x        x           x             x              x              x      x          x       x       x        x          x         x       x       x       x       x
nothing                .      .        .      .    .     .      .         .        .        .          .       .     .         .          .       .      .     .       .        .           .             .              .              .      .          .       .       .        .          .         .       .       .       .       x
light named            .      .        .      .    .     .      .         .        .        .          .       .     .         .          .       .      .     .       .        .           .             .              .              .      .          .       .       .        .          .         .       .       .       .       x
camera moves           x      .        .      .    x     .      .         .        x        x          x       .     .         .          .       .      x     .       .        .           .             .              .              .      x          x       x       .        x          x         x       x       x       x       x
camera zooms           .      .        .      .    .     .      .         .        x        x          x       .     .         .          .       .      x     .       .        .           .             .              .              .      x          x       x       .        x          x         x       x       x       x       x
light moves            x      .        .      .    x     x      x         x        x        .          .       x     x         .          x       .      x     .       .        .           x             x              .              .      x          .       x       .        x          .         .       x       x       x       x
spot moves             x      .        .      .    x     x      x         x        x        .          .       x     x         .          x       .      x     .       .        .           x             x              .              .      x          .       x       .        x          .         .       x       x       x       x
light changes colour   .      .        .      .    x     x      .         x        .        .          .       x     x         .          x       .      .     .       .        .           x             x              .              .      x          .       x       .        x          .         .       x       x       x       x
light goes off         .      .        .      .    x     x      x         x        .        .          .       x     x         x          x       .      .     .       .        .           x             x              .              .      x          .       x       .        x          .         .       x       x       x       x
light goes on          .      .        .      .    x     x      x         x        .        .          .       x     x         x          x       .      .     .       .        .           x             x              .              .      x          .       x       .        x          .         .       x       x       x       x
light's shadow goes    .      .        .      .    x     x      x         x        .        .          .       x     x         .          x       .      .     .       .        .           x             x              .              .      x          .       x       .        x          .         .       x       x       x       x
mesh moves             x      .        x      x    x     .      x         .        x        .          x       .     x         .          x       x      x     x       x        x           x             x              o              x      x          x       .       .        .          .         x       x       .       x       x
mesh mirrors           x      x        x      x    x     .      x         .        x        .          x       .     x         .          x       x      x     x       x        x           x             x              o              x      x          x       .       .        .          .         x       x       x       x       x
parent moves           x      .        x      x    x     x      x         .        x        .          x       x     x         x          x       x      x     x       x        x           x             x              x              x      x          x       .       .        x          x         x       x       .       x       x
mesh appears           x      x        x      x    x     x      x         .        x        .          x       x     x         x          x       x      x     x       x        x           x             x              x              x      x          x       .       .        x          x         x       x       x       x       x
material changes       x      x        x      x    .     .      x         .        .        .          x       .     x         .          x       x      x     x       x        x           x             x              .              x      x          x       .       .        .          .         x       x       x       x       x
mesh deforms           x      x        x      x    x     x      x         .        .        .          x       x     x         x          x       x      x     x       x        x           x             x              x              x      x          x       .       .        x          x         x       x       x       x       x
mesh goes              x      x        x      x    x     x      x         .        x        .          x       x     x         x          x       x      x     x       x        x           x             x              x              x      x          x       .       .        x          x         x       x       x       x       x
scene grows            x      .        x      x    x     x      x         .        x        .          x       x     x         x          x       x      x     x       x        x           x             x              x              x      x          x       .       .        x          x         x       x       .       x       x
scene shrinks          x      .        x      x    x     x      x         .        x        .          x       x     x         x          x       x      x     x       x        x           x             x              x              x      x          x       .       .        x          x         x       x       .       x       x
target widens          .      .        .      .    .     .      .         .        x        x          x       .     .         .          .       .      x     .       .        .           .             .              .              .      x          x       x       x        x          x         x       x       x       x       x
target doubles         .      .        .      .    .     .      .         .        x        x          .       .     .         .          .       .      x     .       .        .           .             .              .              .      x          x       x       x        x          x         x       x       x       x       x
indirect light shown   .      .        .      .    .     .      .         .        .        .          .       .     .         .          .       .      .     .       .        .           .             .              .              .      .          .       .       .        .          .         .       .       .       x       x
exposure changes       .      .        .      .    .     .      .         .        .        .          .       .     .         .          .       .      .     .       .        .           .             .              .              .      .          .       .       .        .          .         .       .       .       .       x
more VPLs              .      .        .      .    .     .      .         .        .        .          .       x     x         x          x       .      x     x       x        x           x             x              x              x      x          .       .       .        .          .         .       .       .       x       x
another path           .      .        .      .    .     .      .         .        .        .          .       .     .         .          .       .      .     .       .        .           .             .              .              .      x          x       .       .        .          .         .       .       .       x       x
albedo shown           .      .        .      .    .     .      .         .        .        .          .       .     .         .          .       .      .     .       .        .           .             .              .              .      .          .       .       .        .          .         .       .       .       x       x
)";

/// The column for a pass of a path.
std::string column_of(std::string_view pass, const Configuration& configuration) {
    const ShadingPath path = configuration.path;
    if (pass.starts_with("vpl-samples")) return "samples";
    pass = pass.substr(0, pass.find(" (other set)"));
    static const std::map<std::string_view, std::string> columns{
        {"scene-gather", "gather"},       {"scene-upload", "upload"},
        {"instance-upload", "instances"}, {"shadow-plan", "plan"},
        {"shadow-maps", "shadows"},       {"vpl-paths", "paths"},
        {"scene-motion", "motion"},       {"surfel-visibility", "visibility"},
        {"surfel-focus", "focus"},        {"surfel-spread", "spread"},
        {"vpl-trace", "trace"},           {"gbuffer", "surfaces"},
        {"depth-prepass", "surfaces"},    {"tile-depths", "depths"},
        {"forward", "shading"},           {"deferred", "shading"},
        {"transparent", "shading"},       {"keep", "tone-map"}};
    if (configuration.vpls.placement == VplPlacement::surfels && pass.starts_with("vpl-")) {
        return "surfel-" + std::string(pass.substr(4));
    }
    if (pass == "light-grid") {
        const bool clusters =
            path == ShadingPath::clustered_forward || path == ShadingPath::clustered_deferred;
        return clusters ? "cluster-grid" : "tile-grid";
    }
    if (pass.starts_with("light-tiles")) return path == ShadingPath::tiled_forward ? "tiles" : "bounded";
    if (pass.starts_with("light-clusters")) return "clusters";
    if (pass.starts_with("blended")) return "blended";
    const auto found = columns.find(pass);
    return found == columns.end() ? std::string(pass) : found->second;
}

using Row = std::map<std::string, std::string>;  // by column: x, . or o

std::map<std::string, Row> read_table() {
    std::istringstream lines{std::string(table)};
    std::string line;
    std::getline(lines, line);
    std::getline(lines, line);
    const std::size_t names = line.find("gather");
    std::vector<std::string> columns;
    std::istringstream header(line);
    for (std::string column; header >> column;) columns.push_back(column);

    std::map<std::string, Row> rows;
    while (std::getline(lines, line)) {
        std::string name = line.substr(0, names);
        name.erase(name.find_last_not_of(' ') + 1);
        std::istringstream marks(line.substr(names));
        for (const std::string& column : columns) marks >> rows[name][column];
        REQUIRE(!marks.fail());
    }
    return rows;
}

constexpr glm::uvec2 first_size{24, 18};

class EditTable : public PathFixture {
 protected:
    EditTable() {
        spot_ = add(scene_.world, looking({0.5F, 1.5F, 1.0F}, {0, 0, 0}), SpotLight{.intensity = 3.0F});
        for (const auto& [entity, name] : scene_.world.view<Name>()) {
            if (name.value == "tall block") block_ = entity;
            if (name.value == "floor") floor_ = entity;
        }
        // So many that light lists of another size than the picture's are noticed.
        add_ranged_lights(scene_.world, 20, 0.8F);
        configuration_.vpls.count = 8;
        configuration_.visibility = {.method = VplVisibility::maps, .map_resolution = 8};
        configuration_.shadows = {.cube_resolution = 16, .map_resolution = 16, .budget_mib = 1};
    }

    void move(Entity entity) {
        scene_.world.edit<Transform>(entity, [](Transform& pose) { pose.translation.x += 0.1F; });
    }

    template <class Change>
    void change_light(Change change) {
        scene_.world.edit<PointLight>(scene_.light, change);
    }

    std::shared_ptr<const Mesh> pane(glm::vec3 albedo) { return square(0.3F, diffuse(albedo, true)); }

    static DeformedMesh deformed(const Mesh& mesh) {
        DeformedMesh::Vertices vertices{mesh.primitives.at(0).vertices};
        for (Vertex& vertex : vertices[0]) vertex.position *= 0.5F;
        return {std::make_shared<const DeformedMesh::Vertices>(std::move(vertices))};
    }

    struct Edit {
        std::string name;
        std::function<void()> apply;
    };
    std::vector<Edit> edits() {
        World& world = scene_.world;
        return {
            {"nothing", [] {}},
            {"light named", [&] { world.set(scene_.light, Name{"lamp"}); }},
            {"camera moves", [&] { move(scene_.camera); }},
            {"camera zooms",
             [&] { world.edit<Camera>(scene_.camera, [](Camera& c) { c.vertical_fov = 0.5F; }); }},
            {"light moves", [&] { move(scene_.light); }},
            {"spot moves", [&] { move(spot_); }},
            {"light changes colour", [&] { change_light([](PointLight& l) { l.colour.g *= 0.5F; }); }},
            {"light goes off", [&] { change_light([](PointLight& l) { l.intensity = 0.0F; }); }},
            {"light goes on", [&] { change_light([](PointLight& l) { l.intensity = 2.0F; }); }},
            {"light's shadow goes", [&] { change_light([](PointLight& l) { l.casts_shadow = false; }); }},
            {"mesh moves", [&] { move(block_); }},
            {"mesh mirrors", [&] { world.edit<Transform>(block_, [](auto& t) { t.scale.x = -1.0F; }); }},
            {"parent moves",
             [&] {
                 world.edit<Transform>(block_, [&](auto& t) { t.parent = floor_; });
                 move(floor_);
             }},
            {"mesh appears",
             [&] {
                 extra_ = add(world, at({0, 0.5F, 0.5F}), MeshInstance{pane({1, 1, 0})});
             }},
            {"material changes",
             [&] {
                 world.set(extra_, MeshInstance{pane({0, 1, 0})});
             }},
            {"mesh deforms", [&] { world.set(extra_, deformed(*world.get<MeshInstance>(extra_).mesh)); }},
            // To more than twice its size: rays then start farther from all surfaces.
            {"scene grows",
             [&] {
                 world.set(extra_, at({0, 0, -40.0F}));
             }},
            {"mesh goes", [&] { world.destroy(extra_); }},
            // To more than twice its size: rays then start farther from all surfaces.
            {"scene grows",
             [&] { world.edit<Transform>(block_, [](auto& t) { t.translation.z -= 40.0F; }); }},
            {"scene shrinks",
             [&] { world.edit<Transform>(block_, [](auto& t) { t.translation.z += 40.0F; }); }},
            {"target widens",
             [&] {
                 size_ = {44, 18};
             }},
            {"target doubles",
             [&] {
                 size_ = {88, 36};
             }},  // the view's matrices do not change
            {"indirect light shown", [&] { configuration_.show = Show::indirect; }},
            {"exposure changes", [&] { configuration_.tone_map.exposure_ev += 1.0F; }},
            {"more VPLs", [&] { configuration_.vpls.count += 8; }},
            {"another path",
             [&] {
                 const bool forward = configuration_.path == ShadingPath::forward;
                 configuration_.path = forward ? ShadingPath::deferred : ShadingPath::forward;
             }},
            {"albedo shown", [&] { configuration_.show = Show::albedo; }},  // without light
        };
    }

    void check_paths(const std::vector<ShadingPath>& paths, VplPlacement placement = VplPlacement::paths) {
        const Scene scene = scene_;
        const Configuration configuration = configuration_;
        for (const ShadingPath path : paths) {
            CAPTURE(to_string(path));
            scene_ = scene;
            size_ = first_size;
            configuration_ = configuration;
            configuration_.vpls.placement = placement;
            // So many that the camera, wherever it is, does not ask for another placement.
            if (placement == VplPlacement::surfels) configuration_.vpls.count = 32;
            configuration_.path = path;
            // Forward paths would all have the surfaces that the estimate needs.
            estimates_ = info_of(path).surfaces == SurfaceStage::gbuffer;
            renderer.invalidate();
            check_all();
        }
        CHECK(checked_.size() == rows_.size());
    }

 private:
    /// Checks the first frame, and each edit after all work is done.
    void check_all() {
        check("first frame");
        for (const Edit& edit : edits()) {
            come_to_rest();
            edit.apply();
            check(edit.name);
        }
    }

    /// Renders a frame and compares its passes with the row of that name.
    void check(const std::string& name) {
        CAPTURE(name);
        configure(configuration_);
        const Picture shown = render_frame();
        CHECK(shown == from_scratch(scene_, size_));
        if (name == "nothing" || name == "light named") {
            CHECK(shown == shown_);
        } else if (name != "another path") {
            CHECK(shown != shown_);
        }
        shown_ = shown;
        REQUIRE(rows_.contains(name));
        for (const PassRecord& pass : renderer.last_passes()) {
            CAPTURE(pass.name);
            const Row& row = rows_.at(name);
            REQUIRE(row.contains(column_of(pass.name, configuration_)));
            const std::string& mark = row.at(column_of(pass.name, configuration_));
            if (mark != "o") CHECK((pass.ran ? "x" : ".") == mark);
        }
        checked_.insert(name);
    }

    /// Renders a frame, perhaps with the passes of the estimate.
    Picture render_frame() {
        RenderTarget target(device, size_);
        const RenderView view{
            .camera = scene_.camera, .target = target.target(), .estimate_error = estimates_};
        renderer.render(scene_.world, {&view, 1});
        return target.read();
    }

    /// Renders until no work is left.
    void come_to_rest() {
        for (int frame = 0; frame < 100; ++frame) {
            static_cast<void>(render_frame());
            const auto ran = [](const PassRecord& pass) { return pass.ran && pass.name != "keep"; };
            if (std::ranges::count_if(renderer.last_passes(), ran) == 1) return;
        }
        FAIL("does not come to rest");
    }

    Scene scene_ = cornell_box();
    Entity spot_;
    Entity block_;
    Entity floor_;
    Entity extra_;
    glm::uvec2 size_ = first_size;
    Configuration configuration_ = linear_configuration();
    bool estimates_ = false;
    Picture shown_;
    std::map<std::string, Row> rows_ = read_table();
    std::set<std::string> checked_;
};

}  // namespace

TEST_CASE_FIXTURE(EditTable, "after each edit only the passes that depend on it run: forward paths") {
    check_paths({ShadingPath::forward, ShadingPath::tiled_forward, ShadingPath::forward_plus,
                 ShadingPath::clustered_forward});
}

TEST_CASE_FIXTURE(EditTable, "after each edit only the passes that depend on it run: deferred paths") {
    check_paths({ShadingPath::deferred, ShadingPath::tiled_deferred, ShadingPath::clustered_deferred});
}

TEST_CASE_FIXTURE(EditTable, "after each edit only the passes that depend on it run: surfels") {
    check_paths({ShadingPath::deferred}, VplPlacement::surfels);
}

}  // TEST_SUITE("edits")
