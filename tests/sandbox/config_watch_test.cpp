#include "sandbox/files/config_watch.hpp"

#include <fstream>
#include <string>

#include <doctest/doctest.h>

#include "tests/sandbox/temporary_folder.hpp"

namespace candela::sandbox {

TEST_SUITE("config watch") {

namespace {

namespace fs = std::filesystem;

/// A configuration file, its watch, and a clock that is advanced by hand.
class Watched {
 public:
    Watched() { watch_.emplace(options_); }

    /// Saves like an editor that writes in place. Each save is one second newer than the previous one,
    /// whatever the resolution of the file system's times.
    void write(const std::string& text) const { write(path_, text); }
    /// Saves like an editor that writes another file and renames it.
    void replace(const std::string& text) const {
        write(folder_ / "fresh.json", text);
        fs::rename(folder_ / "fresh.json", path_);
    }
    void touch() const { fs::last_write_time(path_, later()); }
    void remove() const { fs::remove(path_); }

    std::optional<ConfigurationResult> look() {
        now_ += SaveWatch::interval;
        return watch_->poll(now_);
    }
    std::optional<ConfigurationResult> look_too_early() { return watch_->poll(now_); }
    /// Two checks: the first one sees a change, the second one sees that the file has settled.
    std::optional<ConfigurationResult> settle() {
        CHECK_FALSE(look());
        return look();
    }
    [[nodiscard]] std::string name() const { return path_.string(); }

 private:
    [[nodiscard]] fs::file_time_type later() const { return written_ += std::chrono::seconds(1); }
    void write(const fs::path& path, const std::string& text) const {
        std::ofstream(path) << text;
        fs::last_write_time(path, later());
    }
    [[nodiscard]] Options make_options() const {
        write("{}");
        Options options;
        options.config = path_;
        options.settings["--seed"] = "7";
        return options;
    }

    TemporaryFolder folder_;
    fs::path path_ = folder_ / "watched.json";
    mutable fs::file_time_type written_ = fs::file_time_type::clock::now();
    Options options_ = make_options();
    std::optional<ConfigWatch> watch_;
    SaveWatch::Clock::time_point now_{std::chrono::hours(1)};
};

ShadingPath path_of(const std::optional<ConfigurationResult>& result) {
    REQUIRE(result);
    REQUIRE(result->configuration);
    return result->configuration->path;
}

constexpr const char* forward_plus = R"({"path": "forward+"})";
constexpr const char* tiled = R"({"path": "tiled-deferred"})";

}  // namespace

TEST_CASE("a file that is not saved is not read again") {
    Watched file;
    for (int i = 0; i < 5; ++i) CHECK_FALSE(file.look());
}

TEST_CASE("without a file nothing is watched") {
    ConfigWatch watch{Options{}};
    for (int second = 0; second < 5; ++second) {
        CHECK_FALSE(watch.poll(SaveWatch::Clock::time_point(std::chrono::seconds(second))));
    }
}

TEST_CASE("a saved file is read once, however it was saved, and flags still override it") {
    Watched file;
    SUBCASE("in place") {
        file.write(forward_plus);
    }
    SUBCASE("by renaming another file") {
        file.replace(forward_plus);
    }
    const auto saved = file.settle();
    CHECK(path_of(saved) == ShadingPath::forward_plus);
    CHECK(saved->configuration->vpls.seed == 7);
    for (int i = 0; i < 3; ++i) CHECK_FALSE(file.look());
}

TEST_CASE("a save that changes nothing is read, too") {
    Watched file;
    file.touch();
    const auto saved = file.settle();
    REQUIRE(saved);
    CHECK(saved->configuration);
}

TEST_CASE("a save with the same number of bytes is detected by its time") {
    Watched file;
    file.write(R"({"vpls": {"count": 11}})");
    CHECK(file.settle());
    file.write(R"({"vpls": {"count": 22}})");
    const auto saved = file.settle();
    REQUIRE(saved);
    REQUIRE(saved->configuration);
    CHECK(saved->configuration->vpls.count == 22);
}

TEST_CASE("the file is checked only once per interval") {
    Watched file;
    CHECK_FALSE(file.look());
    file.write(forward_plus);
    for (int i = 0; i < 3; ++i) CHECK_FALSE(file.look_too_early());
    CHECK(path_of(file.settle()) == ShadingPath::forward_plus);
}

TEST_CASE("a file is not read while it is growing") {
    Watched file;
    for (const char* part : {"", R"({"path")", R"({"path": "tiled)"}) {
        file.write(part);
        CHECK_FALSE(file.look());
    }
    file.write(tiled);
    CHECK(path_of(file.settle()) == ShadingPath::tiled_deferred);
}

TEST_CASE("half a file that has not changed for a while is read, and again when it is complete") {
    Watched file;
    file.write(R"({"path": "tiled)");
    const auto half = file.settle();
    REQUIRE(half);
    CHECK_FALSE(half->configuration);
    file.write(tiled);
    CHECK(path_of(file.settle()) == ShadingPath::tiled_deferred);
}

TEST_CASE("a removed file is ignored, and read when it exists again") {
    Watched file;
    file.remove();
    for (int i = 0; i < 3; ++i) CHECK_FALSE(file.look());
    file.write(tiled);
    CHECK(path_of(file.settle()) == ShadingPath::tiled_deferred);
}

TEST_CASE("errors are reported once per save, with file and member, and a valid save recovers") {
    Watched file;
    file.write(R"({"path": "fastest", "lists": {"tile_size": 17}, "colour": 1})");
    const auto saved = file.settle();
    REQUIRE(saved);
    CHECK_FALSE(saved->configuration);
    REQUIRE(saved->errors.size() == 1);
    for (const std::string& word : {file.name(), std::string("path"), std::string("colour")}) {
        CHECK_MESSAGE(saved->errors[0].find(word) != std::string::npos, word);
    }
    for (int i = 0; i < 3; ++i) CHECK_FALSE(file.look());
    file.touch();
    CHECK(file.settle());
    file.write(forward_plus);
    CHECK(path_of(file.settle()) == ShadingPath::forward_plus);
}
}  // TEST_SUITE("config watch")

}  // namespace candela::sandbox
