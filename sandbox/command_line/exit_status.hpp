#pragma once

namespace candela::sandbox {

/// What the program returns; 0 is success. The text is part of --help.
enum ExitStatus : int {
    success = 0,
    bad_input = 2,
    no_driver = 3,
    wrong_picture = 4,
};

/// As a shell tells that a signal has ended a program.
[[nodiscard]] constexpr ExitStatus stopped_by(int signal) {
    return static_cast<ExitStatus>(128 + signal);
}

inline constexpr const char* exit_statuses =
    "Exit status: 0 success; 2 invalid input, or output that cannot be written; 3 no driver, or too little "
    "memory; 4 a wrong picture: its light is not accounted for, or pixels are not finite; 130 or 143 after "
    "SIGINT or "
    "SIGTERM, when what was rendered until then has been written";

}  // namespace candela::sandbox
