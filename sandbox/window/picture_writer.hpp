#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

namespace candela::sandbox {

/// Writes pictures in another thread, so that the window does not wait for their compression.
class PictureWriter {
 public:
    /// `notify` is called from that thread after each picture.
    explicit PictureWriter(std::function<void()> notify);
    /// Waits until all pictures are written.
    ~PictureWriter();
    PictureWriter(const PictureWriter&) = delete;
    PictureWriter& operator=(const PictureWriter&) = delete;

    /// Writes a PNG file. `texels` are those of a tone-mapped texture: the bottom row first, channels from 0
    /// to 1. Waits while many pictures are still to be written.
    void write(std::filesystem::path path, glm::uvec2 size, std::vector<glm::vec4> texels);

    /// Waits until all pictures are written.
    void finish();

    struct Result {
        std::filesystem::path path;
        std::string error;  ///< empty: it was written
    };
    /// What was written, or failed, since the last call.
    [[nodiscard]] std::vector<Result> take_results();

 private:
    struct Job {
        std::filesystem::path path;
        glm::uvec2 size{0};
        std::vector<glm::vec4> texels;
    };
    void work();

    std::function<void()> notify_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Job> jobs_;
    std::vector<Result> results_;
    bool writing_ = false;
    bool stop_ = false;
    std::thread thread_;
};

}  // namespace candela::sandbox
