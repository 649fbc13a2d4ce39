#include "sandbox/window/reference_view.hpp"

#include <limits>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

namespace candela::sandbox {

TEST_SUITE("reference view") {

namespace {

/// Has one picture from the start.
class FinishedReference final : public tools::LiveReference {
 public:
    explicit FinishedReference(tools::ReferencePicture picture) : picture_(std::move(picture)) {}

    void start(tools::ReferenceRequest /*request*/) override {}
    void stop() override {}
    std::optional<tools::ReferencePicture> newest() override { return picture_; }
    [[nodiscard]] std::string fault() const override { return ""; }

 private:
    tools::ReferencePicture picture_;
};

/// A view of a grey picture of 2×1 pixels, of which those in `hit` show a surface.
ReferenceView view_of(tools::Mask hit) {
    ReferenceView view(std::make_unique<FinishedReference>(
        tools::ReferencePicture{{{2, 1}, {glm::vec3(1.0F), glm::vec3(1.0F)}}, std::move(hit), 2, {}}));
    view.follow(tools::ReferenceRequest{});
    CHECK(view.update());
    return view;
}

}  // namespace

TEST_CASE("the error over the reference is known where pictures can be compared") {
    const tools::Picture same{{2, 1}, {glm::vec3(1.0F), glm::vec3(1.0F)}};
    tools::Picture faulty = same;
    faulty.pixels[0].g = std::numeric_limits<float>::quiet_NaN();
    const ReferenceView view = view_of({1, 1});
    const auto none = view.errors_of(same);
    REQUIRE(none);
    CHECK(none->rel_mse == 0.0);
    CHECK(none->blotch == 0.0);
    CHECK(none->flip == 0.0);
    CHECK_FALSE(view.errors_of(faulty));
    CHECK_FALSE(view.errors_of({{1, 1}, {glm::vec3(1.0F)}}));
    CHECK_FALSE(view_of({0, 0}).errors_of(same));  // no surface is seen
    CHECK_FALSE(ReferenceView().errors_of(same));
}
}  // TEST_SUITE("reference view")

}  // namespace candela::sandbox
