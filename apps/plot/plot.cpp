// taktwerk plot out.csv: a trace as a picture. gnuplot draws it; the script is made in apps/plot/plot_script.hpp.

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

#include "apps/plot/gnuplot.hpp"
#include "apps/plot/path_picture.hpp"
#include "apps/plot/plot_script.hpp"
#include "apps/plot/recording_csv.hpp"
#include "apps/taktwerk.hpp"
#include "apps/terminal/duration_option.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "runtime/scope_file/scope_file.hpp"

namespace taktwerk::apps {
namespace {

struct PlotOptions {
    std::string file, output, title, csv, path;
    std::vector<std::string> axes, bits, values;
    double from_s = 0, to_s = 0;
    bool following_error = false;
};

int plot(const PlotOptions& options) {
    const auto fail = [](const Error& error) {
        print_error(error);
        return static_cast<int>(exit_bad_file);
    };
    const bool recorded = options.file.ends_with(runtime::scope_ending);
    if (!options.csv.empty() && !recorded)
        return fail({"plot.csv", options.file, "it is no recording, so there is nothing to be turned into CSV",
                     fmt::format("Give a recording (*{}).", runtime::scope_ending)});
    std::string csv;
    if (recorded) {
        const auto kept = runtime::read_scope_file(options.file);
        if (!kept) return fail(kept.error());
        csv = recording_csv(*kept);
    }
    if (!options.csv.empty()) {
        if (!write_file(options.csv, csv))
            return fail({"plot.csv", options.csv, fmt::format("it cannot be written: {}", std::strerror(errno)), "Choose another place."});
        fmt::print("{}\n", options.csv);
        return exit_ok;
    }
    const auto trace = recorded ? parse_trace(csv, options.file) : read_trace(options.file);
    if (!trace) return fail(trace.error());
    if (trace->cut_off)
        print_warning({"trace.cut_off", options.file, "the last line is incomplete: the run was killed while it wrote",
                       "The plot ends one cycle earlier."});

    const std::filesystem::path file = options.file;
    PlotRequest request{options.title.empty() ? file.stem().string() : options.title,
                        options.output,
                        options.axes,
                        options.from_s,
                        options.to_s,
                        options.following_error,
                        options.bits,
                        options.values};
    if (request.output.empty()) request.output = std::filesystem::path(file).replace_extension(".svg").string();
    std::error_code ignored;
    if (std::filesystem::equivalent(request.output, file, ignored))
        return fail({"plot.output", request.output, "the picture would overwrite the trace", "Choose another place with -o."});
    const auto script = options.path.empty()
                            ? plot_script(*trace, request)
                            : path_script(*trace, {request.title, request.output, options.path, request.from_s, request.to_s});
    if (!script) {
        print_error(script.error());
        return exit_usage;
    }
    if (!write_file(request.output, ""))
        return fail({"plot.output", request.output, fmt::format("the picture cannot be written: {}", std::strerror(errno)),
                     "Choose another place with -o."});
    if (const auto drawn = draw_with_gnuplot(*script); !drawn) {
        std::remove(request.output.c_str());
        return fail(drawn.error());
    }
    fmt::print("{}\n", request.output);
    return exit_ok;
}

}  // namespace

void add_plot(CLI::App& app, Action& action) {
    auto* sub =
        app.add_subcommand("plot", "draw a trace or a recording as SVG: states, position, velocity, acceleration, jerk of each axis");
    auto options = std::make_shared<PlotOptions>();
    sub->add_option("TRACE", options->file, "CSV file of `taktwerk run --trace`, or a recording around an alarm (*.twscope)")->required();
    sub->add_option("--csv", options->csv, "instead of a picture: every signal of a recording as CSV, into this file");
    sub->add_option("-o,--output", options->output, "SVG file; default: the trace's name with .svg");
    sub->add_option("--axis", options->axes, "only these axes, e.g. --axis x,y")->delimiter(',');
    add_duration(*sub, "--from", options->from_s, "from this time of the trace on, e.g. 2s");
    add_duration(*sub, "--to", options->to_s, "until this time of the trace");
    sub->add_option("--bits", options->bits,
                    "only these inputs, outputs and BOOLs of programs below the axes, e.g. --bits in.start,feeder.busy")
        ->delimiter(',');
    sub->add_option("--values", options->values,
                    "a panel for each of these numbers (analog points, variables of programs), e.g. --values feeder.pressure,in.level")
        ->delimiter(',');
    sub->add_option("--path", options->path,
                    "instead of the axes: the way of this group's tool in XY and XZ, its speed, and what each axis uses of its limits");
    sub->add_option("--title", options->title, "headline; default: the trace's name");
    sub->add_flag("--following-error", options->following_error, "a panel more for each axis");
    sub->callback([&action, options] { action = [options] { return plot(*options); }; });
}

}  // namespace taktwerk::apps
