#pragma once

#include <cstddef>

#include <candela/scene/gltf.hpp>

namespace candela::gltf {

/// Tells the host how far the import is. Throws ImportCancelled if the host asks for it.
class Progress {
 public:
    explicit Progress(const ImportOptions& options) : tell_(options.progress) {}

    /// `doing` has static storage duration; `done` of `all` parts are done.
    void operator()(std::string_view doing, std::size_t done, std::size_t all) const {
        const double share = all == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(all);
        if (tell_ && !tell_({doing, share})) throw ImportCancelled("the import was cancelled");
    }

 private:
    const std::function<bool(const ImportProgress&)>& tell_;
};

}  // namespace candela::gltf
