// taktwerk gcode plot FILE: a program's path as a picture.

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

#include "apps/gcode/gcode.hpp"
#include "apps/gcode/program_file.hpp"
#include "apps/gcode/program_picture.hpp"
#include "apps/plot/gnuplot.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "core/one_line.hpp"
#include "fb_library/gcode/interpreter.hpp"

namespace taktwerk::apps {
namespace {

struct PictureOptions {
    ProgramOptions program;
    std::string output, title;
};

/// Every item of the program into `take`. Errors: what is wrong with it.
template <class Take>
Result<void> for_each_item(ProgramFile& file, const gcode::InterpreterOptions& how, const std::string& name, Take take) {
    gcode::Interpreter program(file, how);
    gcode::ProgramItem item;
    auto step = program.next(item);
    for (; step == gcode::Interpreter::Step::item; step = program.next(item)) take(item);
    if (step == gcode::Interpreter::Step::fault) return gcode::fault_error(program.fault(), name);
    return {};
}

int picture(const PictureOptions& options) {
    const auto fail = [](const Error& error, int code = exit_bad_file) {
        print_error(error);
        return code;
    };
    const auto how = interpreter_options(options.program);
    if (!how) return fail(how.error(), exit_usage);
    const auto& path = options.program.file;
    const auto opened = ProgramFile::open(path);
    if (!opened) return fail(opened.error());
    const auto name = shown_name(path);
    // Twice: the first time says how large it is, and so how fine a line has to be.
    gcode::ProgramSummary summary;
    if (const auto read = for_each_item(**opened, *how, name, [&](const gcode::ProgramItem& item) { summary.add(item); }); !read)
        return fail(read.error());
    if (!(*opened)->again())
        return fail({"gcode.pipe", name, "a picture reads its program twice, and this can be read once only", "Put it into a file."});
    double size = 0;
    for (std::size_t axis = 0; axis < gcode::linear_axes; ++axis)
        size = std::max(size, summary.extents()[axis].most - summary.extents()[axis].least);
    ProgramPath drawn(size);
    const auto again = for_each_item(**opened, *how, name, [&](const gcode::ProgramItem& item) {
        if (item.kind == gcode::ProgramItem::Kind::move) drawn.add(item.move);
    });
    if (!again) return fail(again.error());

    const std::filesystem::path file = path;
    const PictureWords words{on_one_line(options.title.empty() ? file.filename().string() : options.title),
                             options.output.empty() ? std::filesystem::path(file).replace_extension(".svg").string() : options.output};
    std::error_code ignored;
    if (std::filesystem::equivalent(words.output, file, ignored))
        return fail({"plot.output", shown_name(words.output), "the picture would overwrite the program", "Choose another place with -o."});
    const auto script = program_picture(summary, drawn, words);
    if (!script) return fail(script.error());
    if (!write_file(words.output, ""))
        return fail({"plot.output", shown_name(words.output), fmt::format("the picture cannot be written: {}", std::strerror(errno)),
                     "Choose another place with -o."});
    if (const auto done = draw_with_gnuplot(*script); !done) {
        std::remove(words.output.c_str());
        return fail(done.error());
    }
    if (drawn.cut_off())
        print_warning({"gcode.cut_off", shown_name(path), "the picture ends before the program does: its path has too many points",
                       "Draw a part of it: --from-line."});
    fmt::print("{}\n", words.output);
    return exit_ok;
}

}  // namespace

void add_gcode_plot(CLI::App& gcode, Action& action) {
    auto* sub = gcode.add_subcommand("plot", "draw the path as SVG: XY above, XZ below; rapids dashed (needs gnuplot)");
    auto options = std::make_shared<PictureOptions>();
    add_program_options(*sub, options->program);
    sub->add_option("-o,--output", options->output, "SVG file; default: the program's name with .svg");
    sub->add_option("--title", options->title, "headline; default: the program's name");
    sub->callback([&action, options] { action = [options] { return picture(*options); }; });
}

}  // namespace taktwerk::apps
