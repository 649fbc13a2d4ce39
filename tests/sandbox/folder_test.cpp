#include "sandbox/files/folder.hpp"

#include <algorithm>
#include <fstream>

#include <doctest/doctest.h>

#include "tests/sandbox/temporary_folder.hpp"

namespace candela::sandbox {

TEST_SUITE("folder") {

namespace {

namespace fs = std::filesystem;

/// Folders and files, some of which nobody wants to open.
struct Home {
    TemporaryFolder folder;
    fs::path path = folder / "";

    Home() {
        for (const char* const name : {"lamps", "Lakes", ".hidden", "lamps/old"})
            fs::create_directory(path / name);
        for (const char* const name : {"room.gltf", "roof-2.glb", "Roof.glb", "sky.HDR", "dawn.exr",
                                       "notes.txt", ".secret.gltf", "lamps/lamp.gltf"}) {
            std::ofstream(path / name) << "x";
        }
        fs::create_symlink("nothing", path / "broken");
        fs::create_symlink("lamps", path / "z-link");
    }
};

std::vector<std::string> names(const std::vector<FolderEntry>& entries) {
    std::vector<std::string> names;
    for (const FolderEntry& entry : entries) names.push_back(entry.name + (entry.is_folder ? "/" : ""));
    return names;
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("folders come first, then files that can be opened, without hidden ones") {
    const Home home;
    const Folder folder = read_folder(home.path);
    CHECK(folder.fault.empty());
    CHECK(names(folder.entries) ==
          Names{"Lakes/", "lamps/", "z-link/", "dawn.exr", "roof-2.glb", "Roof.glb", "room.gltf", "sky.HDR"});
}

TEST_CASE("a folder that cannot be read says why, in one line with its path") {
    const Home home;
    for (const char* const name : {"missing", "room.gltf"}) {
        const Folder folder = read_folder(home.path / name);
        CHECK(folder.entries.empty());
        CHECK(folder.fault.starts_with((home.path / name).string() + ": "));
        CHECK(folder.fault.find('\n') == std::string::npos);
    }
}

TEST_CASE("what is typed chooses among the entries, and Tab completes it") {
    const Home home;
    FolderBrowser browser(home.path);
    browser.type("ro");
    CHECK(names(browser.matches()) == Names{"roof-2.glb", "Roof.glb", "room.gltf"});
    CHECK(browser.completed() == "roo");
    browser.type("roof");
    CHECK(browser.completed() == "roof");
    browser.type("room");
    CHECK(browser.completed() == "room.gltf");
    browser.type("lam");
    CHECK(browser.completed() == "lamps/");
    browser.type("lamps/");
    CHECK(names(browser.matches()) == Names{"old/", "lamp.gltf"});
    browser.type("lamps/la");
    CHECK(browser.completed() == "lamps/lamp.gltf");
    CHECK(browser.picked() == home.path / "lamps/la");
    browser.type("x");
    CHECK(browser.matches().empty());
    CHECK(browser.completed() == "x");
    const std::string elsewhere = (home.path / "lamps/").string();
    browser.type(elsewhere + "o");
    CHECK(browser.completed() == elsewhere + "old/");
    browser.type("lamps/../ro");
    CHECK(names(browser.matches()) == Names{"roof-2.glb", "Roof.glb", "room.gltf"});
}

TEST_CASE("arrows mark an entry, and Return picks it, else what is typed") {
    const Home home;
    FolderBrowser browser(home.path);
    CHECK(browser.picked().empty());
    CHECK(browser.marked() == nullptr);
    browser.type("ro");
    browser.mark(1);
    REQUIRE(browser.marked() != nullptr);
    CHECK(browser.picked() == home.path / "roof-2.glb");
    browser.mark(1);
    CHECK(browser.picked() == home.path / "Roof.glb");
    browser.mark(5);
    CHECK(browser.picked() == home.path / "room.gltf");
    browser.mark(-9);
    CHECK(browser.picked() == home.path / "roof-2.glb");
    browser.type("roo");
    CHECK(browser.picked() == home.path / "roo");
    browser.type("nothing like it");
    browser.mark(1);
    CHECK(browser.marked() == nullptr);
}

TEST_CASE("one goes into folders and back") {
    const Home home;
    FolderBrowser browser(home.path);
    browser.type("lam");
    browser.mark(1);
    browser.enter(browser.picked());
    CHECK(browser.typed().empty());
    CHECK(names(browser.matches()) == Names{"old/", "lamp.gltf"});
    CHECK(browser.folder().path == home.path / "lamps");
    browser.leave();
    CHECK(browser.matches().size() == 8);
    browser.enter("/");
    browser.leave();
    CHECK(browser.folder().path == "/");
    browser.enter(home.path / "missing");
    CHECK_FALSE(browser.folder().fault.empty());
    browser.leave();
    CHECK(browser.matches().size() == 8);
}
}  // TEST_SUITE("folder")

}  // namespace candela::sandbox
