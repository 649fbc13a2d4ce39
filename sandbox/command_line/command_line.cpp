#include "sandbox/command_line/command_line.hpp"

#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <candela/version.hpp>
#include "sandbox/command_line/exit_status.hpp"
#include "sandbox/command_line/messages.hpp"

namespace candela::sandbox {

FlagError::FlagError(std::string_view flag, std::string_view fault)
    : std::runtime_error(fmt::format("{}: {}", flag, fault)) {}

struct CommandLine::Library {
    CLI::App app;
};

CommandLine::CommandLine(const std::string& description, const std::string& footer)
    : library_(new Library{CLI::App(description, "candela")}) {
    library_->app.footer(footer);
    library_->app.set_help_flag("--help", "print this and exit");
    library_->app.set_version_flag("--version", "candela " CANDELA_VERSION, "print the version and exit");
}

CommandLine::~CommandLine() = default;

void CommandLine::add_switch(const std::string& flag, const std::string& help, bool& target) {
    library_->app.add_flag(flag, target, help);
}

void CommandLine::add_value(const std::string& flag, const std::string& type, const std::string& help,
                            const Store& store) {
    library_->app.add_option_function<std::string>(flag, store, help)->type_name(type);
}

void CommandLine::add_values(const std::string& flag, const std::string& type, const std::string& help,
                             const Store& store) {
    const auto store_all = [store](const std::vector<std::string>& values) {
        for (const std::string& value : values) store(value);
    };
    library_->app.add_option_function<std::vector<std::string>>(flag, store_all, help)->type_name(type);
}

std::optional<EarlyExit> CommandLine::parse(int count, const char* const* arguments,
                                            const std::function<void()>& check) {
    const auto fault = [](const std::exception& error) {
        return EarlyExit{bad_input, fmt::format("candela: {}\n", one_line(error.what()))};
    };
    try {
        library_->app.parse(count, arguments);
        check();
        return std::nullopt;
    } catch (const CLI::CallForHelp&) {
        return EarlyExit{success, library_->app.help()};
    } catch (const CLI::CallForVersion& version) {
        return EarlyExit{success, fmt::format("{}\n", version.what())};
    } catch (const CLI::ParseError& error) {
        return fault(error);
    } catch (const FlagError& error) {
        return fault(error);
    }
}

}  // namespace candela::sandbox
