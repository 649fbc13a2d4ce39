// Panels without a window: clicks on their controls, and what these change.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <tuple>

#include <imgui_internal.h>

#include <candela/graph/describe.hpp>

#include "sandbox/command_line/choose_configuration.hpp"
#include "sandbox/panels/controls.hpp"
#include "sandbox/panels/graph_panel.hpp"
#include "sandbox/panels/open_panel.hpp"
#include "sandbox/panels/overlay.hpp"
#include "sandbox/panels/quality_panel.hpp"
#include "sandbox/panels/resource_view.hpp"
#include "sandbox/panels/scene_panel.hpp"
#include "sandbox/panels/view_panel.hpp"
#include "tests/sandbox/temporary_folder.hpp"

namespace candela::sandbox {

TEST_SUITE("panels") {

namespace {

/// Dear ImGui with a pointer and without a screen.
class Screen {
 public:
    explicit Screen(std::function<void()> draw, float width = 600.0F) : draw_(std::move(draw)) {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {width, 1600.0F};
        io.DeltaTime = 1.0F / 60.0F;
        unsigned char* pixels = nullptr;
        glm::ivec2 size(0);
        io.Fonts->GetTexDataAsRGBA32(&pixels, &size.x, &size.y);
        settle();
    }
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;
    ~Screen() { ImGui::DestroyContext(); }

    [[nodiscard]] bool has(std::string_view label) const { return places_.contains(label); }
    /// The right edge of the control that reaches furthest, with its label.
    [[nodiscard]] float right_edge() const {
        float edge = 0.0F;
        for (const auto& [label, place] : places_) edge = std::max(edge, place.corner.x + place.size.x);
        return edge;
    }
    /// Moves the pointer there. Returns the place.
    Rectangle point_at(std::string_view label) {
        settle();  // what was changed since the last time
        const auto place = places_.find(label);
        REQUIRE_MESSAGE(place != places_.end(), label);
        const glm::vec2 at = place->second.corner + 0.5F * place->second.size;
        ImGui::GetIO().MousePos = {at.x, at.y};
        const Rectangle found = place->second;
        settle();
        return found;
    }
    void click(std::string_view label) {
        point_at(label);
        for (const bool down : {true, false}) {
            ImGui::GetIO().MouseDown[0] = down;
            settle();
        }
    }
    /// Types letters and Tab, all in one frame.
    void type_with_tab(const char* letters) {
        settle();  // what has opened has the keyboard
        settle();
        ImGuiIO& io = ImGui::GetIO();
        io.AddInputCharactersUTF8(letters);
#if IMGUI_VERSION_NUM < 18700
        io.KeyMap[ImGuiKey_Tab] = 1;
        io.KeysDown[1] = true;
        settle();
        io.KeysDown[1] = false;
#else
        io.ConfigInputTrickleEventQueue = false;
        io.AddKeyEvent(ImGuiKey_Tab, true);
        settle();
        io.AddKeyEvent(ImGuiKey_Tab, false);
#endif
        settle();
    }

 private:
    /// Windows need a frame to find their size.
    void settle() {
        for (int frame = 0; frame < 2; ++frame) {
            static_cast<void>(take_control_places());
            ImGui::NewFrame();
            draw_();
            ImGui::Render();
            places_ = take_control_places();
        }
    }

    std::function<void()> draw_;
    ControlPlaces places_;
};

/// Draws in a window that fills the screen.
std::function<void()> in_panel(std::function<void()> draw) {
    return [draw = std::move(draw)] {
        ImGui::SetNextWindowPos({0.0F, 0.0F});
        ImGui::SetNextWindowSize(ImGui::GetIO().DisplaySize);
        ImGui::Begin("panel");
        draw();
        ImGui::End();
    };
}

}  // namespace

TEST_CASE("what the picture shows is chosen by a click") {
    AppState state;
    const ReferenceView none(nullptr);
    Screen screen(in_panel([&] { draw_view_panel(state, nullptr, none, 0.0); }));
    for (const Show show : {Show::direct, Show::albedo, Show::indirect, Show::irradiance, Show::normals,
                            Show::roughness, Show::metalness, Show::total}) {
        CHECK(state.configuration.show != show);
        screen.click(to_string(show));
        CHECK(state.configuration.show == show);
    }
}

TEST_CASE("a click on a slider changes the material of the selected object, and undo takes it back") {
    Document document(load_scene(shipped_file("scenes", "cornell.gltf")), std::nullopt, 1.0F);
    const World& world = document.scene.world;
    const AppState state;
    Screen screen(in_panel([&] { (void)draw_scene_panel(document, state, nullptr); }));
    CHECK_FALSE(screen.has("metalness"));
    const auto first = world.view<MeshInstance>().begin();
    const Entity entity = std::get<0>(*first);
    const auto mesh = world.get<MeshInstance>(entity).mesh;
    REQUIRE(materials_of(*mesh).size() == 1);
    document.interaction.selected = entity;
    const auto material = [&] { return *world.get<MeshInstance>(entity).mesh->primitives[0].material; };
    screen.click("metalness");
    CHECK(material().metalness > 0.1F);
    CHECK(material().roughness == 1.0F);
    screen.click("roughness");
    CHECK(material().roughness < 0.9F);
    screen.click("specular");
    CHECK(material().specular > 0.1F);
    const History& history = document.interaction.history();
    CHECK(history.undo_count() == 3);
    for (int step = 0; step < 3; ++step) screen.click("undo");
    CHECK(history.undo_count() == 0);
    CHECK(world.get<MeshInstance>(entity).mesh == mesh);
}

TEST_CASE("the error of VPLs is estimated after a click") {
    AppState state;
    const ReferenceView none(nullptr);
    Screen screen(in_panel([&] { draw_view_panel(state, nullptr, none, 0.0); }));
    screen.click("estimate their error");
    CHECK(state.estimate_error);
}

TEST_CASE("a comparison begins with two equal configurations, is shown in two ways, and ends") {
    AppState state;
    state.configuration.vpls.count = 77;
    const ReferenceView none(nullptr);
    Screen screen(in_panel([&] { draw_view_panel(state, nullptr, none, 0.0); }));
    CHECK_FALSE(screen.has("swap A and B"));
    screen.click("divider");
    CHECK(state.comparison.mode == CompareMode::divider);
    CHECK(state.comparison.other == state.configuration);
    state.configuration.vpls.count = 78;
    screen.click("difference");
    CHECK(state.comparison.mode == CompareMode::difference);
    CHECK(state.comparison.other.vpls.count == 77);
    screen.click("swap A and B");
    CHECK(state.comparison.other.vpls.count == 78);
    CHECK(state.configuration.vpls.count == 77);
    screen.click("B = A");
    CHECK(state.comparison.other.vpls.count == 77);
    screen.click("no comparison");
    CHECK(state.comparison.mode == CompareMode::off);
    CHECK_FALSE(screen.has("swap A and B"));
}

TEST_CASE("presets and paths are chosen by a click") {
    Configuration configuration;
    double noise_limit = 0.0;
    Screen screen(in_panel([&] { draw_quality_panel(configuration, noise_limit, {}); }));
    for (const char* const preset : {"draft", "best", "report", "balanced"}) {
        screen.click(preset);
        CHECK(name_of(configuration) == preset);
    }
    for (const ShadingPath path : all_shading_paths) {
        screen.click(to_string(path));
        CHECK(configuration.path == path);
    }
}

TEST_CASE("the names of settings are not cut by the edge of the panel") {
    Configuration configuration;
    configuration.refinement.enabled = true;
    double noise_limit = 0.0;
    for (const float width : {340.0F, 170.0F}) {  // of the widest and the narrowest panel
        const Screen screen(in_panel([&] { draw_quality_panel(configuration, noise_limit, {}); }), width);
        CHECK(screen.has("shadows.cube_resolution"));
        CHECK(screen.has("end refinement at noise, %"));
        CHECK(screen.right_edge() <= width);
    }
}

TEST_CASE("a click on a pass lists its resources, and a click on one of these shows it, or no more") {
    GraphDescription graph;
    graph.resources = {{.name = "albedo", .kind = ResourceKind::texture},
                       {.name = "plan", .kind = ResourceKind::value},
                       {.name = "lights", .kind = ResourceKind::buffer}};
    graph.passes = {
        {.name = "gbuffer", .gpu = true, .accesses = {{.resource = 1}, {.resource = 0, .write = true}}},
        {.name = "deferred", .gpu = true, .accesses = {{.resource = 0}, {.resource = 2}}},
        {.name = "inspect", .gpu = true}};
    graph.edges = {{.from = 0, .to = 1}, {.from = 1, .to = 2}};
    GraphSelection selection;
    const PassCosts costs;
    Screen screen(in_panel([&] { draw_graph_panel(selection, graph, costs); }));
    CHECK_FALSE(screen.has("albedo"));
    CHECK_FALSE(screen.has("inspect"));
    screen.click("gbuffer");
    CHECK(selection.pass == "gbuffer");
    CHECK_FALSE(screen.has("lights"));
    screen.click("plan");  // a value has no picture
    CHECK_FALSE(selection.resource.has_value());
    screen.click("albedo");
    CHECK(selection.resource == "albedo");
    screen.click("deferred");
    screen.click("lights");
    CHECK(selection.resource == "lights");
    screen.click("lights");
    CHECK_FALSE(selection.resource.has_value());
    screen.click("deferred");
    CHECK_FALSE(selection.pass.has_value());
    CHECK_FALSE(screen.has("lights"));
}

TEST_CASE("a scene is picked from a list, and the window of the list goes") {
    OpenPanel panel;
    std::optional<std::filesystem::path> chosen;
    Screen screen([&] {
        if (const auto file = panel.draw()) chosen = file;
    });
    CHECK_FALSE(screen.has("file name"));
    panel.show({{"recent", {}}, {"shipped", {"scenes/a.gltf", "scenes/b.gltf"}}}, ".");
    screen.click("b.gltf");
    CHECK(chosen == "scenes/b.gltf");
    CHECK_FALSE(panel.is_shown());
}

TEST_CASE("the tooltip of a tab stands beside the panel, and covers nothing of it") {
    constexpr float edge = 700.0F;  // of the panel, at the left
    Screen screen(
        [&] {
            ImGui::SetNextWindowPos({edge, 20.0F});
            ImGui::SetNextWindowSize({300.0F, 400.0F});
            ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoTitleBar);
            ImGui::BeginTabBar("tabs");
            for (const char* const name : {"one", "two"}) {
                if (begin_tab(name, "a tooltip that is as long as most are, or a little longer")) {
                    ImGui::EndTabItem();
                }
            }
            ImGui::EndTabBar();
            ImGui::End();
        },
        1000.0F);
    const Rectangle tab = screen.point_at("two");
    const ImGuiWindow* tip = ImGui::FindWindowByName("##Tooltip_00");
    REQUIRE(tip != nullptr);
    CHECK(tip->Size.x > 50.0F);
    CHECK(tip->Pos.x + tip->Size.x <= edge);
    CHECK(tip->Pos.x >= 0.0F);
    CHECK(tip->Pos.y == tab.corner.y);
}

TEST_CASE("fields of elements are written by their type") {
    Vertex vertex;
    vertex.position = {1.0F, 0.25F, -3.0F};
    BufferElements elements{.bytes = {}, .stride = sizeof(Vertex), .count = 2};
    elements.bytes.resize(2 * sizeof(Vertex));
    std::memcpy(&elements.bytes[sizeof(Vertex)], &vertex, sizeof(Vertex));
    CHECK(words_of(elements, {"position", NumberType::float32, 3, 0}, 1) == "1 0.25 -3");
    // As a float, two of these numbers are no number.
    CHECK(words_of(elements, {"colour", NumberType::unorm16, 4, offsetof(Vertex, colour)}, 1) == "1 1 1 1");
    CHECK(words_of(elements, {"bits", NumberType::uint32, 1, offsetof(Vertex, colour)}, 1) == "4294967295");
}

TEST_CASE("a scene is picked in a folder within the shown one, and a folder that is not there is named") {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "lamps");
    std::ofstream(folder / "lamps/lamp##2.gltf") << "{}";
    OpenPanel panel;
    std::optional<std::filesystem::path> chosen;
    Screen screen([&] {
        if (const auto file = panel.draw()) chosen = file;
    });
    panel.show({}, folder / "");
    screen.click("lamps/");
    CHECK_FALSE(chosen.has_value());
    screen.click("../");
    screen.click("lamps/");
    screen.click("lamp");  // controls are known by what is before the signs
    CHECK(chosen == folder / "lamps/lamp##2.gltf");
    CHECK_FALSE(panel.is_shown());
}

TEST_CASE("Tab completes what was typed, also just before it") {
    const TemporaryFolder folder;
    std::ofstream(folder / "lamp-post.gltf") << "{}";
    std::ofstream(folder / "moon.gltf") << "{}";
    OpenPanel panel;
    std::optional<std::filesystem::path> chosen;
    Screen screen([&] {
        if (const auto file = panel.draw()) chosen = file;
    });
    panel.show({}, folder / "");
    screen.type_with_tab("la");
    screen.click("open file");
    CHECK(chosen == folder / "lamp-post.gltf");
}

TEST_CASE("an object is selected in the tree, with Ctrl besides others") {
    Document document(load_scene(shipped_file("scenes", "cornell.gltf")), std::nullopt, 1.0F);
    const AppState state;
    Screen screen(in_panel([&] { (void)draw_scene_panel(document, state, nullptr); }));
    screen.click("tall block");
    REQUIRE(document.interaction.selected);
    CHECK(name_of(document.scene.world, *document.interaction.selected) == "tall block");
    ImGui::GetIO().KeyCtrl = true;
    screen.click("ceiling light");
    CHECK(document.interaction.all_selected().size() == 2);
    CHECK(name_of(document.scene.world, *document.interaction.selected) == "ceiling light");
    ImGui::GetIO().KeyCtrl = false;
    document.objects.find = "block";
    screen.click("short block");
    CHECK(document.interaction.all_selected().size() == 1);
    CHECK_FALSE(screen.has("ceiling light"));
}

TEST_CASE("the texel under the pointer is that of the picture, whose bottom row is the first") {
    InspectionResult result;
    result.extent = {8, 4};
    const Rectangle picture{{100.0F, 50.0F}, {160.0F, 80.0F}};  // 20 x 20 for a texel
    CHECK(texel_at(result, picture, {101.0F, 129.0F}) == glm::uvec2(0, 0));
    CHECK(texel_at(result, picture, {259.0F, 51.0F}) == glm::uvec2(7, 3));
    CHECK(texel_at(result, picture, {165.0F, 95.0F}) == glm::uvec2(3, 1));
    CHECK_FALSE(texel_at(result, picture, {99.0F, 60.0F}));
    // Tiles of 16 pixels: the second one from the left, the lowest.
    result.extent = {40, 20};
    result.texel_size = 16;
    CHECK(texel_at(result, picture, {100.0F + 17.0F * 4.0F, 125.0F}) == glm::uvec2(1, 0));
}

TEST_CASE("the values of a texel and of a pixel are told by channel") {
    CHECK(words_of(InspectedTexel{{5, 3}, {0.25F, 1.0F, -2.0F, 9.0F}, 3, {}}, "") == "texel 5, 3: 0.25 1 -2");
    CHECK(words_of(InspectedTexel{{5, 3}, {7.0F, 0.0F, 0.0F, 1.0F}, 1, {}}, "lights") ==
          "texel 5, 3: 7 lights");
    CHECK(words_of(InspectedTexel{{0, 0}, {0.5F, 0.0F, 0.0F, 1.0F}, 1, 2.5F}, "m") ==
          "texel 0, 0: 0.5, 2.5 m");
    CHECK(words_of(InspectedTexel{{0, 0}, glm::vec4(0.0F), 1, 0.0F}, "m") == "texel 0, 0: 0, no surface");
    CHECK(words_of(ProbedPixel{{12, 34}, {0.1F, 2.0F, 30.0F}, {0.0F, 0.5F, 1.0F}}) ==
          "pixel 12, 34: radiance 0.1 2 30, colour 0 128 255");
}
}  // TEST_SUITE("panels")

}  // namespace candela::sandbox
