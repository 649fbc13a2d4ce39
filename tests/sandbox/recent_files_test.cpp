#include "sandbox/files/recent_files.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "tests/sandbox/temporary_folder.hpp"

namespace candela::sandbox {

TEST_SUITE("recent files") {

namespace {

namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;

/// An empty file.
fs::path touch(const fs::path& path) {
    std::ofstream file(path);
    return path;
}

/// Sets an environment variable, or removes it, until the end of its scope.
class Variable {
 public:
    Variable(const char* name, const char* value) : name_(name) {
        if (const char* before = std::getenv(name)) before_ = before;
        set(value);
    }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;
    ~Variable() { set(before_ ? before_->c_str() : nullptr); }

 private:
    void set(const char* value) {
        if (value != nullptr) {
            ::setenv(name_, value, 1);
        } else {
            ::unsetenv(name_);
        }
    }

    const char* name_;
    std::optional<std::string> before_;
};

}  // namespace

TEST_CASE("the newest is first, none is there twice, and there are at most ten") {
    const TemporaryFolder folder;
    const fs::path list = folder / "state/candela/recent";  // folders that do not exist
    CHECK(recent_files(list).empty());
    Paths expected;
    for (int i = 0; i < 12; ++i) {
        expected.insert(expected.begin(), touch(folder / fmt::format("scene {}.gltf", i).c_str()));
        add_recent_file(list, expected.front());
    }
    expected.resize(most_recent_files);
    CHECK(recent_files(list) == expected);

    add_recent_file(list, folder / "x/.." / expected[4].filename());  // the same file by another path
    expected.insert(expected.begin(), expected[4]);
    expected.erase(expected.begin() + 5);
    CHECK(recent_files(list) == expected);
}

TEST_CASE("relative paths are remembered as absolute ones") {
    const TemporaryFolder folder;
    const fs::path list = folder / "recent";
    const fs::path before = fs::current_path();
    touch(folder / "a.gltf");
    fs::current_path(folder / "");
    add_recent_file(list, "a.gltf");
    fs::current_path(before);
    CHECK(recent_files(list) == Paths{folder / "a.gltf"});
}

TEST_CASE("a file that is gone is left out until it is back") {
    const TemporaryFolder folder;
    const fs::path list = folder / "recent";
    for (const char* name : {"a.gltf", "b.gltf"}) add_recent_file(list, touch(folder / name));
    fs::remove(folder / "b.gltf");
    CHECK(recent_files(list) == Paths{folder / "a.gltf"});
    touch(folder / "b.gltf");
    CHECK(recent_files(list) == Paths{folder / "b.gltf", folder / "a.gltf"});
}

TEST_CASE("a damaged list is read as far as it makes sense, and repaired") {
    const TemporaryFolder folder;
    const fs::path list = folder / "recent";
    const fs::path scene = touch(folder / "a.gltf");
    std::ofstream(list, std::ios::binary) << std::string("\0\x01\xFF\n\n", 5) << "relative.gltf\n"
                                          << std::string(5000, '/') << '\n'
                                          << scene.string() << '\r' << '\n'
                                          << folder / "" << '\n'
                                          << scene.string();
    CHECK(recent_files(list) == Paths{scene});
    add_recent_file(list, scene);
    std::ifstream file(list);
    CHECK(std::string(std::istreambuf_iterator<char>(file), {}).starts_with(scene.string() + '\n'));
}

TEST_CASE("a list that cannot be read or written disturbs nothing") {
    const TemporaryFolder folder;
    const fs::path scene = touch(folder / "a.gltf");
    const fs::path below_a_file = folder / "a.gltf/candela/recent";
    for (const fs::path& list : {folder / "", below_a_file, fs::path("/proc/candela/recent"), fs::path()}) {
        add_recent_file(list, scene);
        CHECK(recent_files(list).empty());
    }
    const fs::path list = folder / "recent";
    add_recent_file(list, "/a\nb.gltf");  // a line cannot hold it
    CHECK_FALSE(fs::exists(list));
}

TEST_CASE("the list is where the XDG Base Directory Specification puts the state of an app") {
    const Variable home("HOME", "/home/ada");
    {
        const Variable state("XDG_STATE_HOME", "/var/ada");
        CHECK(recent_files_list() == "/var/ada/candela/recent");
    }
    for (const char* unusable : {"", "relative", static_cast<const char*>(nullptr)}) {
        const Variable state("XDG_STATE_HOME", unusable);
        CHECK(recent_files_list() == "/home/ada/.local/state/candela/recent");
        const Variable homeless("HOME", nullptr);
        CHECK(recent_files_list().empty());
    }
}
}  // TEST_SUITE("recent files")

}  // namespace candela::sandbox
