#include "sandbox/window/picture_writer.hpp"

#include <exception>
#include <utility>

#include "sandbox/files/picture.hpp"

namespace candela::sandbox {

namespace {

constexpr std::size_t most_jobs = 16;

}  // namespace

PictureWriter::PictureWriter(std::function<void()> notify)
    : notify_(std::move(notify)), thread_([this] { work(); }) {}

PictureWriter::~PictureWriter() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void PictureWriter::write(std::filesystem::path path, glm::uvec2 size, std::vector<glm::vec4> texels) {
    {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return jobs_.size() < most_jobs; });
        jobs_.push_back({std::move(path), size, std::move(texels)});
    }
    changed_.notify_all();
}

void PictureWriter::finish() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return jobs_.empty() && !writing_; });
}

std::vector<PictureWriter::Result> PictureWriter::take_results() {
    const std::lock_guard lock(mutex_);
    return std::exchange(results_, {});
}

void PictureWriter::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [&] { return stop_ || !jobs_.empty(); });
        if (jobs_.empty()) return;
        Job job = std::move(jobs_.front());
        jobs_.pop_front();
        writing_ = true;
        lock.unlock();
        Result result{job.path, ""};
        try {
            write_png(job.path, job.size, rgb_of_texels(job.size, job.texels));
        } catch (const std::exception& error) {
            result.error = error.what();
        }
        lock.lock();
        writing_ = false;
        results_.push_back(std::move(result));
        changed_.notify_all();
        lock.unlock();
        notify_();
        lock.lock();
    }
}

}  // namespace candela::sandbox
