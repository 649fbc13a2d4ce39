#include "sandbox/reference/live_reference.hpp"

namespace candela::sandbox {

std::unique_ptr<LiveReference> make_live_reference(std::function<void()> /*notify*/) {
    return nullptr;
}

}  // namespace candela::sandbox
