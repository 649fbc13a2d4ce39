#include <doctest/doctest.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/facade/device_of.hpp"
#include "renderer/gpu/programs.hpp"
#include "tests/compilations.hpp"
#include "tests/renderer/scene_builder.hpp"
#include "tests/sandbox/temporary_folder.hpp"

TEST_SUITE("program cache") {

using namespace candela;

namespace {

namespace fs = std::filesystem;

constexpr std::string_view text = R"(
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Results { uint results[]; };
uniform uint factor;
void main() { results[0] = factor * NUMBER; }
)";

/// Programs of a renderer that begins anew.
class NewPrograms {
 public:
    NewPrograms(const gl::GetProc& get_proc, const fs::path& directory, std::string_view source = text)
        : device_(get_proc, gl::DebugOutput::on),
          files_{{{"number.comp", source}}},
          log_([this](std::string_view line) { lines.emplace_back(line); }),
          programs_(device_, gl::ShaderLibrary(files_), directory, log_) {}

    /// What the shader writes: 3 · number.
    std::uint32_t triple(std::uint32_t number) {
        const gl::Buffer results(device_, "results", sizeof(std::uint32_t));
        results.bind_base(GL_SHADER_STORAGE_BUFFER, 0);
        programs_.compiled({"number.comp"}, {"NUMBER=" + std::to_string(number) + "u"}).use({{"factor", 3U}});
        device_.gl().DispatchCompute(1, 1, 1);
        device_.gl().MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        CHECK(std::ranges::none_of(device_.take_messages(), &gl::DebugMessage::is_error));
        return results.download<std::uint32_t>().front();
    }

    std::vector<std::string> lines;  ///< warnings

 private:
    gl::Device device_;
    std::array<gl::EmbeddedShader, 1> files_;
    Log log_;
    Programs programs_;
};

/// A context with counting functions, and a folder for the cache.
class CacheTests : public GlFixture {
 protected:
    CacheTests() { static_cast<void>(Compilations::take()); }

    /// Whether the driver gives programs away.
    [[nodiscard]] bool caches() const {
        return gl::get_unsigned(device.gl(), GL_NUM_PROGRAM_BINARY_FORMATS) > 0;
    }
    [[nodiscard]] std::vector<fs::path> files() const {
        return {fs::directory_iterator(folder / "."), fs::directory_iterator()};
    }

    /// That the one program is loaded, not compiled: drivers may store it in other bytes each time.
    void check_that_it_loads() {
        static_cast<void>(Compilations::take());
        CHECK(NewPrograms(get_proc, folder / ".").triple(5) == 15);
        CHECK(Compilations::take() == ProgramCounts{.linked = 0, .loaded = 1});
    }

    sandbox::TemporaryFolder folder;
    gl::GetProc get_proc = Compilations::counting(context->get_proc());
};

std::string content_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

PFNGLPROGRAMBINARYPROC load_binary = nullptr;

/// Hands other bytes to the driver, which it refuses.
void load_zeros(GLuint program, GLenum format, const void*, GLsizei size) {
    const std::vector<char> zeros(static_cast<std::size_t>(size));
    load_binary(program, format, zeros.data(), size);
}

gl::GetProc refusing(const gl::GetProc& get_proc) {
    return [get_proc](const char* name) -> void (*)() {
        const auto found = get_proc(name);
        if (std::string_view(name) != "glProgramBinary") return found;
        load_binary = reinterpret_cast<PFNGLPROGRAMBINARYPROC>(found);
        return reinterpret_cast<void (*)()>(&load_zeros);
    };
}

}  // namespace

TEST_CASE_FIXTURE(CacheTests, "a second renderer loads what the first has compiled, and draws the same") {
    const Scene scene = cornell_box();
    Configuration configuration = linear_configuration();
    configuration.visibility.method = VplVisibility::maps;
    const auto picture = [&] {
        TestedRenderer renderer(get_proc, {.program_cache = (folder / "cache").string()});
        const RenderTarget target(device_of(renderer), {24, 18});
        REQUIRE(renderer.configure(configuration).empty());
        renderer.render(scene.world, scene.camera, target.target());
        return target.read();
    };
    const Picture first = picture();
    const ProgramCounts compiled = Compilations::take();
    CHECK(compiled.linked > 0);
    CHECK(compiled.loaded == 0);
    CHECK(picture() == first);
    const ProgramCounts again = Compilations::take();
    CHECK(again.linked == (caches() ? 0 : compiled.linked));
    CHECK(again.loaded == (caches() ? compiled.linked : 0));
}

TEST_CASE_FIXTURE(CacheTests, "each source and each variant has its own file") {
    const std::string other = std::string(text) + "// another";
    for (int round = 0; round < 2; ++round) {
        CHECK(NewPrograms(get_proc, folder / ".").triple(5) == 15);
        CHECK(NewPrograms(get_proc, folder / ".").triple(6) == 18);
        CHECK(NewPrograms(get_proc, folder / ".", other).triple(5) == 15);
        const ProgramCounts counts = Compilations::take();
        CHECK(counts.linked == (caches() && round > 0 ? 0 : 3));
    }
    CHECK(files().size() == (caches() ? 3 : 0));
    // The same names and defines, but another shader.
    std::string doubled(text);
    doubled.replace(doubled.find("factor *"), 8, "2u * factor *");
    CHECK(NewPrograms(get_proc, folder / ".", doubled).triple(5) == 30);
}

TEST_CASE_FIXTURE(CacheTests, "damaged files and those cut short are replaced without a word") {
    CHECK(NewPrograms(get_proc, folder / ".").triple(5) == 15);
    if (!caches()) return;
    REQUIRE(files().size() == 1);
    const fs::path path = files().front();
    const std::string whole = content_of(path);
    const auto replaced = [&](const std::string& damaged) {
        std::ofstream(path, std::ios::binary) << damaged;
        static_cast<void>(Compilations::take());
        NewPrograms programs(get_proc, folder / ".");
        CHECK(programs.triple(5) == 15);
        CHECK(programs.lines.empty());
        CHECK(Compilations::take() == ProgramCounts{.linked = 1, .loaded = 0});
        CHECK(files().size() == 1);
        check_that_it_loads();
    };
    for (const std::size_t length : {std::size_t{0}, std::size_t{7}, std::size_t{47}, std::size_t{48},
                                     whole.size() / 2, whole.size() - 1}) {
        CAPTURE(length);
        replaced(whole.substr(0, length));
    }
    replaced(whole + '\0');
    replaced(std::string(whole.size(), '\0'));
    // The header of 48 bytes, but for its last 4, which mean nothing, and some of the driver's bytes.
    for (std::size_t at = 0; at < whole.size(); at += at < 44 ? 1 : whole.size() / 20) {
        if (at >= 44 && at < 48) continue;
        CAPTURE(at);
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
        replaced(damaged);
    }
}

TEST_CASE_FIXTURE(CacheTests, "a file that the driver refuses is replaced without a word") {
    CHECK(NewPrograms(get_proc, folder / ".").triple(5) == 15);
    if (!caches()) return;
    const fs::path path = files().front();
    const fs::file_time_type long_ago = fs::last_write_time(path) - std::chrono::hours(1);
    fs::last_write_time(path, long_ago);
    static_cast<void>(Compilations::take());
    NewPrograms programs(refusing(get_proc), folder / ".");
    CHECK(programs.triple(5) == 15);
    CHECK(programs.lines.empty());
    CHECK(Compilations::take() == ProgramCounts{.linked = 1, .loaded = 1});
    CHECK(fs::last_write_time(path) > long_ago);
    check_that_it_loads();
}

TEST_CASE_FIXTURE(CacheTests, "a directory that cannot be written is one warning, and programs work") {
    std::ofstream(folder / "taken") << "a file";
    NewPrograms programs(get_proc, folder / "taken");
    for (const std::uint32_t number : {4U, 5U, 6U}) CHECK(programs.triple(number) == 3 * number);
    CHECK(programs.lines.size() == (caches() ? 1 : 0));
    if (caches()) CHECK(programs.lines.front().starts_with("the program cache is not written: "));
    CHECK(content_of(folder / "taken") == "a file");
    CHECK(folder.file_count() == 1);
}

TEST_CASE_FIXTURE(CacheTests, "without a directory, nothing is stored or loaded") {
    for (int round = 0; round < 2; ++round) {
        CHECK(NewPrograms(get_proc, {}).triple(5) == 15);
        CHECK(Compilations::take() == ProgramCounts{.linked = 1, .loaded = 0});
    }
}

}  // TEST_SUITE("program cache")
