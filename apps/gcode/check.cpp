// taktwerk gcode check FILE: what is wrong with a program, or what is in it.

#include <fmt/format.h>

#include "apps/gcode/gcode.hpp"
#include "apps/gcode/program_file.hpp"
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

int check(const ProgramOptions& options) {
    const auto fail = [](const Error& error, int code) {
        print_error(error);
        return code;
    };
    const auto how = interpreter_options(options);
    if (!how) return fail(how.error(), exit_usage);
    const auto file = ProgramFile::open(options.file);
    if (!file) return fail(file.error(), exit_bad_file);
    const auto name = shown_name(options.file);
    const auto program = check_program(**file, *how, name);
    if (program) {
        fmt::print("{}", summary_text(*program, name));
        for (const auto& remark : remarks(*program, name)) print_warning(remark);
        return exit_ok;
    }
    print_error(program.error());
    const auto line = line_of(program.error(), name);
    if (line == 0) return exit_bad_file;
    const auto again = ProgramFile::open(options.file);
    if (!again) return exit_bad_file;
    const auto more = word_errors_behind(**again, *how, line, most_errors, name);
    for (const auto& error : more) print_error(error);
    fmt::print(stderr, "behind line {} only the words were looked at, not what they do{}\n", line,
               more.size() == most_errors ? "; there may be more" : "");
    return exit_bad_file;
}

}  // namespace

void add_gcode_check(CLI::App& gcode, Action& action) {
    auto* sub = gcode.add_subcommand("check", "errors with line and column; else extents, lengths, feeds, tools and the least time");
    auto options = std::make_shared<ProgramOptions>();
    add_program_options(*sub, *options);
    sub->callback([&action, options] { action = [options] { return check(*options); }; });
}

}  // namespace taktwerk::apps
