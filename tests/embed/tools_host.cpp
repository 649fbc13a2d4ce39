// A host that picks an object, captures a picture, writes it to files and reports about it, all with
// candela::tools.

#include <epoxy/gl.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <thread>

#include <candela/scene/sky_picture.hpp>
#include <candela/tools/capture.hpp>
#include <candela/tools/live_reference.hpp>
#include <candela/tools/output_file.hpp>
#include <candela/tools/picture_error.hpp>
#include <candela/tools/run_report.hpp>
#include <candela/tools/scene_rays.hpp>
#include <candela/tools/tool_error.hpp>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "host.hpp"

namespace {

namespace fs = std::filesystem;
namespace tools = candela::tools;

constexpr glm::ivec2 size{33, 25};  // odd: the middle is the centre of a pixel
constexpr float eye_height = 3.0F;
constexpr float shelf_height = 0.5F;
constexpr float rounding = 1e-5F;  // some roundings of numbers up to 3

std::string read_file(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The ground, with a shelf over its middle, seen from above.
struct Room : host::Scene {
    candela::Entity shelf;
};

Room make_room() {
    Room room{host::make_scene(), {}};
    room.shelf = room.world.create();
    room.world.set(room.shelf, candela::Transform{.translation = {0, shelf_height, 0}});
    room.world.set(room.shelf, candela::MeshInstance{host::ground(0.4F, 0.5F)});
    return room;
}

void check_picking(const Room& room, host::Checks& checks) {
    tools::SceneRays rays;
    rays.update_and_wait(room.world);
    const candela::Camera& camera = room.world.get<candela::Camera>(room.camera);
    const auto look_at = [&](glm::vec2 position) {
        return rays.first_hit(tools::ray_through(room.world, room.camera, size, position));
    };
    // Straight down, from the near plane.
    const auto middle = look_at(0.5F * glm::vec2(size));
    const float distance = eye_height - camera.near_plane - shelf_height;
    checks.check(middle && middle->entity == room.shelf, "the shelf is in the middle");
    checks.check(middle && std::abs(middle->distance - distance) < rounding, "the distance of the shelf");
    checks.check(middle && glm::distance(middle->normal, {0, 1, 0}) < rounding, "the normal of the shelf");
    // The upper edge of the picture is half the angle of view away from the middle, towards -Z.
    const auto edge = look_at({0.5F * static_cast<float>(size.x), 0.0F});
    const glm::vec3 on_ground(0.0F, 0.0F, -eye_height * std::tan(0.5F * camera.vertical_fov));
    checks.check(edge && edge->entity != room.shelf, "the ground is at the edge");
    checks.check(edge && glm::distance(edge->point, on_ground) < rounding, "the place on the ground");
    checks.check(rays.blocked({0, 1, 0}, {0, 0.1F, 0}), "the shelf hides the ground from the lamp");
    checks.check(!rays.blocked({0, 1, 0}, {1, 0.1F, 0}), "beside the shelf, nothing is in the way");
}

/// The middle of the picture shows the shelf, d metres below the lamp of 3 cd; all surfaces lie below it, so
/// that no other light arrives: it has the radiance albedo / π · intensity / d².
void check_radiance(const tools::Picture& picture, host::Checks& checks) {
    const float to_lamp = 1.0F - shelf_height;
    const float radiance = 0.5F * std::numbers::inv_pi_v<float> * 3.0F / (to_lamp * to_lamp);
    const auto middle = static_cast<std::size_t>(size.y / 2 * size.x + size.x / 2);
    // The pixel is 8 cm wide, and its mean 0.7 % below the value at its centre.
    checks.check(picture.size == size, "the size of the picture");
    checks.check(std::abs(picture.pixels.at(middle).g - radiance) < 0.02F * radiance,
                 "the light on the shelf");
}

/// The same of the reference path tracer, where it is built in.
void check_reference(const Room& room, host::Checks& checks) {
    const std::unique_ptr<tools::LiveReference> tracer = tools::make_live_reference({});
    if (!tracer) return;
    tracer->start({.world = std::make_shared<const candela::World>(room.world),
                   .camera = room.camera,
                   .size = glm::uvec2(size),
                   .samples = 2});
    std::optional<tools::ReferencePicture> newest;
    // Previews have no samples.
    while (tracer->fault().empty() && (!newest || newest->samples == 0)) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        if (auto picture = tracer->newest()) newest = std::move(picture);
    }
    checks.check(tracer->fault().empty(), "a fault of the reference");
    if (newest) check_radiance(newest->radiance, checks);
}

/// The pixels of a PFM file as write_pfm writes it.
tools::Picture read_pfm(const fs::path& path) {
    const std::string header = "PF\n33 25\n-1.0\n";
    const std::string file = read_file(path);
    tools::Picture picture{size, std::vector<glm::vec3>(static_cast<std::size_t>(size.x * size.y))};
    const std::size_t bytes = picture.pixels.size() * sizeof(glm::vec3);
    if (!file.starts_with(header) || file.size() != header.size() + bytes) return {};
    std::memcpy(picture.pixels.data(), file.data() + header.size(), bytes);
    return tools::flipped(picture);
}

/// A number of four bytes, the highest first.
std::uint32_t big_endian(const std::string& file, std::size_t at) {
    std::uint32_t number = 0;
    for (std::size_t i = at; i < at + 4; ++i) {
        number = number << 8 | static_cast<unsigned char>(i < file.size() ? file[i] : '\0');
    }
    return number;
}

void check_files(tools::Capture& capture, const tools::Picture& picture, const fs::path& folder,
                 host::Checks& checks) {
    for (const char* name : {"a.png", "a.exr", "a.PFM"}) capture.write(folder / name, picture);

    const tools::Picture floats = read_pfm(folder / "a.PFM");
    checks.check(floats.pixels == picture.pixels, "PFM keeps the pixels");
    checks.check(tools::relative_mse(floats, picture) == 0.0, "equal pictures have no error");

    const std::string png = read_file(folder / "a.png");
    checks.check(png.starts_with("\x89PNG\r\n"), "the signature of a PNG file");
    checks.check(big_endian(png, 16) == 33 && big_endian(png, 20) == 25, "the size in a PNG file");
    const std::vector<std::uint8_t> encoded = capture.tone_mapped(picture);
    checks.check(*std::max_element(encoded.begin(), encoded.end()) > 100, "the tone-mapped picture is dark");

    checks.check(read_file(folder / "a.exr").starts_with("\x76\x2f\x31\x01"), "the signature of an EXR file");
    // The import reads skies, twice as wide as high.
    const tools::Picture sky{{4, 2},
                             {glm::vec3(0),
                              glm::vec3(1),
                              {1, 2, 3},
                              glm::vec3(0.1F),
                              glm::vec3(5),
                              glm::vec3(6),
                              glm::vec3(7),
                              glm::vec3(1e-3F)}};
    tools::write_exr(folder / "sky.exr", sky);
    checks.check(candela::load_sky_picture(folder / "sky.exr")->texels == sky.pixels, "EXR keeps the pixels");

    try {
        capture.write(folder / "nowhere" / "a.png", picture);
        checks.check(false, "a folder that does not exist is an error");
    } catch (const tools::ToolError& error) {
        checks.check(std::string(error.what()).find("nowhere") != std::string::npos, "errors name the file");
    }
}

void check_report(const candela::Renderer& renderer, const tools::CaptureReport& captured,
                  const fs::path& folder, host::Checks& checks) {
    const tools::RunReport run{
        "EGL", "room", std::nullopt, size, renderer.configuration(), {captured.frame}, captured.state};
    tools::write_text(folder / "report.json", tools::to_json(run));
    const auto json = nlohmann::json::parse(read_file(folder / "report.json"));
    checks.check(json["size"] == nlohmann::json::array({33, 25}), "the size in the report");
    checks.check(json["triangles"] == 4, "two squares have four triangles");
    checks.check(json["lights"]["count"] == 1, "there is one lamp");
    checks.check(json["frames"].size() == 1 && !json["frames"][0]["passes"].empty(), "the passes of a frame");
    checks.check(json["config"]["vpls"]["count"] == renderer.configuration().vpls.count, "the configuration");
    checks.check(json["animation"].is_null(), "nothing has moved");
}

}  // namespace

int main() {
    const auto context = host::make_context();
    host::Checks checks;
    const Room room = make_room();
    check_picking(room, checks);
    check_reference(room, checks);

    std::string name = (fs::temp_directory_path() / "tools-host-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) return 1;
    const fs::path folder = name;
    {
        candela::Renderer renderer(context->get_proc());
        const candela::Configuration before = renderer.configuration();
        const host::Picture drawing = host::make_picture({8, 8});
        glBindFramebuffer(GL_FRAMEBUFFER, drawing.framebuffer);
        glPixelStorei(GL_PACK_ROW_LENGTH, 100);

        tools::Capture capture(renderer, context->get_proc(), size);
        tools::CaptureReport captured;
        const tools::Picture picture = capture.render(room.world, room.camera, 4, captured);
        check_radiance(picture, checks);
        check_files(capture, picture, folder, checks);
        check_report(renderer, captured, folder, checks);

        GLint bound = 0;
        glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
        checks.check(static_cast<GLuint>(bound) == drawing.framebuffer, "the host's framebuffer stays bound");
        checks.check(renderer.configuration() == before, "the configuration stays");
    }
    fs::remove_all(folder);
    checks.check(glGetError() == GL_NO_ERROR, "GL reported an error");
    return checks.status();
}
