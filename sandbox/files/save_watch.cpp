#include "sandbox/files/save_watch.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

namespace candela::sandbox {

namespace fs = std::filesystem;

SaveWatch::SaveWatch(std::optional<fs::path> path) : path_(std::move(path)), seen_(look()), read_(seen_) {}

bool SaveWatch::has_saved(Clock::time_point now) {
    if (now < next_look_) return false;
    next_look_ = now + interval;
    Stamps stamps = look();
    const bool settled = stamps == seen_;
    seen_ = std::move(stamps);
    return !seen_.empty() && settled && seen_ != read_;
}

bool SaveWatch::accept() {
    if (look() != seen_) return false;
    read_ = seen_;
    return true;
}

SaveWatch::Stamps SaveWatch::look() const {
    Stamps stamps;
    if (!path_) return stamps;
    std::error_code error;
    const auto add = [&](const fs::path& file) {
        const fs::file_time_type written = fs::last_write_time(file, error);
        if (error) return;
        const std::uintmax_t bytes = fs::file_size(file, error);
        if (!error) stamps.push_back({file, written, bytes});
    };
    if (!fs::is_directory(*path_, error)) {
        add(*path_);
        return stamps;
    }
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(*path_, error)) {
        if (entry.is_regular_file(error)) add(entry.path());
    }
    std::ranges::sort(stamps, {}, &Stamp::path);
    return stamps;
}

}  // namespace candela::sandbox
