#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace candela::sandbox {

/// The program must exit with `status` and print `text`: to stdout if `status` is 0, otherwise to stderr. An
/// error is one line with its newline.
struct EarlyExit {
    int status = 0;
    std::string text;
};

/// What is wrong with the value of a flag.
class FlagError : public std::runtime_error {
 public:
    FlagError(std::string_view flag, std::string_view fault);
};

/// The flags of a command line. Only command_line.cpp includes the library that parses it: its headers take
/// seconds to compile.
class CommandLine {
 public:
    /// Receives the value of a flag. May throw FlagError.
    using Store = std::function<void(const std::string& value)>;

    /// Declares --help and --version. The help begins with the description and ends with the footer.
    CommandLine(const std::string& description, const std::string& footer);
    ~CommandLine();
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    /// A flag without a value, which sets `target` to true; `target` must outlive the command line.
    void add_switch(const std::string& flag, const std::string& help, bool& target);
    /// A flag with a value of this type, a word for the help. A name without dashes is an argument without a
    /// flag.
    void add_value(const std::string& flag, const std::string& type, const std::string& help,
                   const Store& store);
    /// A flag that may be given several times.
    void add_values(const std::string& flag, const std::string& type, const std::string& help,
                    const Store& store);

    /// Stores the values of all flags, then calls `check`, which may throw FlagError. Returns what ends the
    /// program: a fault, --help or --version. `arguments[0]` is the program.
    [[nodiscard]] std::optional<EarlyExit> parse(int count, const char* const* arguments,
                                                 const std::function<void()>& check);

 private:
    struct Library;
    std::unique_ptr<Library> library_;
};

}  // namespace candela::sandbox
