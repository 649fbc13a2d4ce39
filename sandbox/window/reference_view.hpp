#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <candela/tools/live_reference.hpp>

namespace candela::sandbox {

/// Makes a reference, or null where the path tracer is not built in; see tools::make_live_reference.
using MakeReference = std::function<std::unique_ptr<tools::LiveReference>(std::function<void()> notify)>;

/// How a picture differs from the reference.
struct ReferenceErrors {
    double rel_mse = 0.0;  ///< see tools::relative_mse
    double blotch = 0.0;   ///< see tools::blotch; of pictures of reduced size, as flip
    double flip = 0.0;     ///< see tools::flip_of_light
};

/// The reference of what the window shows: it is traced while nothing changes.
class ReferenceView {
 public:
    ReferenceView() = default;
    explicit ReferenceView(std::unique_ptr<tools::LiveReference> tracer) : tracer_(std::move(tracer)) {}

    /// Whether the path tracer is built in.
    [[nodiscard]] bool is_built_in() const { return tracer_ != nullptr; }

    /// Starts over if the request is another one than before; stops without a request.
    void follow(const std::optional<tools::ReferenceRequest>& request);
    /// Takes the newest picture; whether there is a new one, or news of a fault.
    [[nodiscard]] bool update();

    /// Null until the first picture.
    [[nodiscard]] const tools::ReferencePicture* picture() const { return picture_ ? &*picture_ : nullptr; }
    /// The radiance of `picture`, for the render thread; null until the first picture.
    [[nodiscard]] const std::shared_ptr<const tools::Picture>& radiance() const { return radiance_; }
    [[nodiscard]] const std::string& fault() const { return fault_; }
    /// The errors of a picture over the reference; nullopt if they cannot be compared yet.
    [[nodiscard]] std::optional<ReferenceErrors> errors_of(const tools::Picture& shown) const;

 private:
    std::unique_ptr<tools::LiveReference> tracer_;
    std::optional<tools::ReferenceRequest> request_;
    std::optional<tools::ReferencePicture> picture_;
    std::shared_ptr<const tools::Picture> radiance_;
    std::string fault_;
};

}  // namespace candela::sandbox
