#include "sandbox/files/save_watch.hpp"

#include <fstream>
#include <string>

#include <doctest/doctest.h>

#include "tests/sandbox/temporary_folder.hpp"

namespace candela::sandbox {

TEST_SUITE("save watch") {

namespace {

namespace fs = std::filesystem;

/// A folder with a file in a folder, and a clock that is advanced by hand.
struct WatchedFolder {
    TemporaryFolder folder;
    fs::path file = folder / "inner" / "a.glsl";
    SaveWatch::Clock::time_point now = SaveWatch::Clock::now();

    WatchedFolder() {
        fs::create_directory(folder / "inner");
        write(file, "1");
    }
    static void write(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }
    bool look(SaveWatch& watch) { return watch.has_saved(now += SaveWatch::interval); }
};

}  // namespace

TEST_CASE("a file that changes, appears or goes in a folder is noticed once it has settled") {
    WatchedFolder watched;
    SaveWatch watch(watched.folder / ".");
    CHECK_FALSE(watched.look(watch));

    WatchedFolder::write(watched.file, "longer");
    CHECK_FALSE(watched.look(watch));
    CHECK(watched.look(watch));
    CHECK(watch.accept());
    CHECK_FALSE(watched.look(watch));

    WatchedFolder::write(watched.folder / "b.glsl", "new");
    CHECK_FALSE(watched.look(watch));
    CHECK(watched.look(watch));
    CHECK(watch.accept());

    fs::remove(watched.file);
    CHECK_FALSE(watched.look(watch));
    CHECK(watched.look(watch));
}

TEST_CASE("what was saved again while it was read is not accepted") {
    WatchedFolder watched;
    SaveWatch watch(watched.file);
    WatchedFolder::write(watched.file, "longer");
    CHECK_FALSE(watched.look(watch));
    CHECK(watched.look(watch));
    WatchedFolder::write(watched.file, "longer still");
    CHECK_FALSE(watch.accept());
    CHECK_FALSE(watched.look(watch));
    CHECK(watched.look(watch));
    CHECK(watch.accept());
}

TEST_CASE("a missing file is not a save") {
    WatchedFolder watched;
    SaveWatch watch(watched.file);
    fs::remove(watched.file);
    CHECK_FALSE(watched.look(watch));
    CHECK_FALSE(watched.look(watch));
    SaveWatch nothing(std::nullopt);
    CHECK_FALSE(watched.look(nothing));
}
}  // TEST_SUITE("save watch")

}  // namespace candela::sandbox
