// taktwerk gcode check FILE: what is wrong with a program, or what is in it.

#include <fmt/format.h>

#include "apps/gcode/gcode.hpp"
#include "apps/gcode/program_file.hpp"
#include "apps/gcode/summary_json.hpp"
#include "apps/gcode/summary_text.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"

namespace taktwerk::apps {
namespace {

constexpr std::size_t most_errors = 20;

std::uint32_t line_of(const Error& error, const std::string& name) {
    const auto subject = std::string_view(error.subject);
    return subject.size() > name.size() + 1 ? static_cast<std::uint32_t>(std::strtoul(error.subject.c_str() + name.size() + 1, nullptr, 10))
                                            : 0;
}

struct CheckWords {
    ProgramOptions program;
    bool json = false;
};

/// The first error, and what is wrong with the words of the lines behind it.
int tell(const std::vector<Error>& errors, std::uint32_t behind, bool json) {
    if (json) fmt::print("{}\n", program_errors_json(errors).dump(2));
    if (json) return exit_bad_file;
    for (const auto& error : errors) print_error(error);
    if (behind > 0)
        fmt::print(stderr, "behind line {} only the words were looked at, not what they do{}\n", behind,
                   errors.size() > most_errors ? "; there may be more" : "");
    return exit_bad_file;
}

int check(const CheckWords& options) {
    const auto how = interpreter_options(options.program);
    if (!how) {
        print_error(how.error());
        return exit_usage;
    }
    const auto& path = options.program.file;
    const auto file = ProgramFile::open(path);
    if (!file) return tell({file.error()}, 0, options.json);
    const auto name = shown_name(path);
    const auto program = check_program(**file, *how, name);
    if (!program) {
        std::vector<Error> errors{program.error()};
        const auto line = line_of(program.error(), name);
        if (line == 0 || !(*file)->again()) return tell(errors, 0, options.json);
        for (auto& error : word_errors_behind(**file, *how, line, most_errors, name)) errors.push_back(std::move(error));
        return tell(errors, line, options.json);
    }
    if (options.json) {
        fmt::print("{}\n", program_json(*program, name).dump(2));
        return exit_ok;
    }
    fmt::print("{}", summary_text(*program, name));
    for (const auto& remark : remarks(*program, name)) print_warning(remark);
    return exit_ok;
}

}  // namespace

void add_gcode_check(CLI::App& gcode, Action& action) {
    auto* sub = gcode.add_subcommand("check", "errors with line and column; else extents, lengths, feeds, tools and the least time");
    auto options = std::make_shared<CheckWords>();
    add_program_options(*sub, options->program);
    sub->add_flag("--json", options->json, "the result as one JSON object");
    sub->callback([&action, options] { action = [options] { return check(*options); }; });
}

}  // namespace taktwerk::apps
