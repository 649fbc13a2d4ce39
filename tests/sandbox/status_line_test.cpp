#include "sandbox/panels/status_line.hpp"

#include <doctest/doctest.h>

namespace candela::sandbox {

TEST_SUITE("status line") {

TEST_CASE("it tells the frame time, and what converges") {
    Status status;
    status.frame_ms = 12.34;
    status.mean_ms = 15.0;
    CHECK(to_words(status) == "12.3 ms (mean 15.0)");
    status.vpls = 512;
    status.refined = 12;
    status.to_refine = 1024;
    CHECK(to_words(status) == "12.3 ms (mean 15.0) · 512 VPLs · refined 12/1024");
    status.settled = true;
    CHECK(to_words(status) == "12.3 ms (mean 15.0) · 512 VPLs · refined 12/1024 · done");
}

TEST_CASE("it tells the quality that was chosen for the frame time") {
    Status status;
    status.frame_ms = 60.0;
    status.mean_ms = 60.0;
    status.quality = {0.5F, 8};
    CHECK(to_words(status) == "60.0 ms (mean 60.0) · 50 % of the sides while moving");
}
}  // TEST_SUITE("status line")

}  // namespace candela::sandbox
