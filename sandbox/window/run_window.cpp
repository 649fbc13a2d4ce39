#include "sandbox/window/run_window.hpp"

#include <cstdio>
#include <cstdlib>

#include "sandbox/window/window_session.hpp"

namespace candela::sandbox {

void run_window(Window& window, const OpenScene& open, const Configuration& chosen, ConfigWatch& watch,
                const Options& options, const MakeReference& make_reference) {
    WindowSession session(window, open, chosen, watch, options, make_reference);
    session.run();
    session.write_results();
    if (session.stop()) return;
    std::fflush(nullptr);
    std::_Exit(EXIT_SUCCESS);
}

}  // namespace candela::sandbox
