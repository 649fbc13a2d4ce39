#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <string>

#include <doctest/doctest.h>

#include "sandbox/files/shipped_file.hpp"
#include "tests/engine/saved_world.hpp"

TEST_SUITE("glTF export") {

using namespace candela;
using namespace candela::test;

namespace {

/// Limits the size of files that this process writes, as a full disk does.
class FullDisk {
 public:
    explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        REQUIRE(::setrlimit(RLIMIT_FSIZE, &limit) == 0);
    }
    FullDisk(const FullDisk&) = delete;
    FullDisk& operator=(const FullDisk&) = delete;
    ~FullDisk() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }

 private:
    void (*handler_)(int);
    rlimit before_{};
};

}  // namespace

TEST_CASE("a full disk leaves the files as they were") {
    const std::filesystem::path scenes = sandbox::shipped_file("scenes", "");
    const TemporaryDirectory folder;
    static_cast<void>(export_gltf(imported(scenes / "corner.gltf"), folder / "a.gltf"));
    const auto before = files_of(folder / "");
    const World other = imported(scenes / "glass.gltf");
    {
        const FullDisk disk(4096);
        const std::string error = error_of_export(other, folder / "a.gltf");
        CHECK(error.starts_with((folder / "a").string()));
        CHECK(error.ends_with(": cannot be written: File too large"));
    }
    CHECK(files_of(folder / "") == before);
}

}  // TEST_SUITE("glTF export")
