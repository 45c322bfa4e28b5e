// taktwerk gcode run MACHINE.yaml FILE: a program on this machine's axes, arm and limits, simulated in virtual time.

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <fmt/format.h>

#include "apps/gcode/dry_run.hpp"
#include "apps/gcode/gcode.hpp"
#include "apps/gcode/program_file.hpp"
#include "apps/gcode/summary_json.hpp"
#include "apps/gcode/summary_text.hpp"
#include "apps/machine/load.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "axes/axis/error_table.hpp"

namespace taktwerk::apps {
namespace {

struct RunWords {
    std::string machine, group, points;
    ProgramOptions program;
    double override_percent = 100, most_seconds = 3600;
    bool optional_stop = false, json = false;
};

int fail(const Error& error, int code = exit_bad_file) {
    print_error(error);
    return code;
}

Result<std::string> whole_text(const std::string& path) {
    auto file = ProgramFile::open(path);
    if (!file) return file.error();
    std::string text;
    std::array<char, 4096> piece{};
    for (;;) {
        const auto read = (*file)->read(piece);
        if (read.state == gcode::TextState::some) text.append(piece.data(), read.bytes);
        else if (read.state == gcode::TextState::end) return text;
        else return Error{"gcode.read_failed", shown_name(path), "the program cannot be read", "check the disk"};
    }
}

/// Tools and offsets: as given here, else those of the machine's path that is this file, else of its first one.
gcode::InterpreterOptions tables_of(const runtime::MachineConfig& config, const RunWords& words, gcode::InterpreterOptions given) {
    if (!words.program.tools.empty() || !words.program.offsets.empty() || config.paths.empty()) return given;
    const auto name = std::filesystem::path(words.program.file).filename();
    const auto same = std::find_if(config.paths.begin(), config.paths.end(),
                                   [&](const auto& path) { return std::filesystem::path(path.file).filename() == name; });
    const auto& from = (same != config.paths.end() ? *same : config.paths.front()).options;
    given.tools = from.tools;
    given.offsets = from.offsets;
    given.reference = from.reference;
    given.second_reference = from.second_reference;
    return given;
}

Result<std::string> group_of(const runtime::MachineConfig& config, const std::string& asked) {
    std::string known;
    for (const auto& group : config.axis_groups) {
        if (group.name == asked || (asked.empty() && config.axis_groups.size() == 1)) return group.name;
        known += (known.empty() ? "" : ", ") + group.name;
    }
    if (known.empty())
        return Error{"gcode.no_group", "groups", "the machine has no group of axes", "add `groups:` with the axes and their arm"};
    return Error{"gcode.which_group", asked.empty() ? "groups" : asked, "the machine has the groups " + known, "name one with --group"};
}

/// What is asked for, as who writes the program calls it.
std::string word_of(const axes::PathRequest& request) {
    switch (request.kind) {
        case axes::mcPathStop: return "M0";
        case axes::mcPathOptionalStop: return "M1";
        case axes::mcPathToolPrepare: return fmt::format("T{}", request.number);
        case axes::mcPathToolChange: return fmt::format("M6, tool {}", request.number);
        case axes::mcPathSpindleClockwise: return fmt::format("M3 S{:g}", request.value);
        case axes::mcPathSpindleCounter: return fmt::format("M4 S{:g}", request.value);
        case axes::mcPathSpindleSpeed: return fmt::format("S{:g}", request.value);
        case axes::mcPathSpindleOff: return "M5";
        case axes::mcPathMist: return "M7";
        case axes::mcPathFlood: return "M8";
        case axes::mcPathCoolantOff: return "M9";
        case axes::mcPathUser: return fmt::format("M{}", request.number);
        case axes::mcPathResume: return "from here to the line";
        default: return "";
    }
}

void print_outcome(const DryRunOutcome& out, const axes::AxisGroupConfig& group, const std::string& name) {
    const auto share = [&](double seconds) { return out.moving > 0 ? 100 * seconds / out.moving : 0; };
    fmt::print("{}: {:.3f} s, {:.3f} s of them moving, {:.3f} {} of path, at most {:.3f} {}/s\n", name, out.seconds, out.moving, out.length,
               group.unit, out.fastest, group.unit);
    for (std::size_t i = 0; i < group.members.size(); ++i)
        if (out.at_limit[i] > 0) fmt::print("  {:5.1f} %  of the motion axis {} is at a limit\n", share(out.at_limit[i]), group.members[i]);
    for (const auto& asked : out.requests) fmt::print("  {:9.3f} s  line {:<6} {}\n", asked.seconds, asked.line, word_of(asked.request));
}

int write_points(const std::string& path, const DryRunOutcome& out) {
    std::FILE* file = std::fopen(path.c_str(), "we");
    if (file == nullptr)
        return fail({"usage.output", shown_name(path), "the file cannot be written", "check its name and its rights"}, exit_usage);
    fmt::print(file, "time,x,y,z,velocity,line\n");
    for (const auto& p : out.points) fmt::print(file, "{:.6f},{},{},{},{},{}\n", p.seconds, p.at[0], p.at[1], p.at[2], p.velocity, p.line);
    if (std::fclose(file) != 0) return fail({"usage.output", shown_name(path), "the file is not whole", "is the disk full?"}, exit_usage);
    return exit_ok;
}

int tell(const RunWords& words, const DryRunOutcome& out, const axes::AxisGroupConfig& group) {
    const auto name = shown_name(words.program.file);
    if (words.json) {
        nlohmann::ordered_json json{{"done", out.done},     {"seconds", out.seconds}, {"moving", out.moving},
                                    {"length", out.length}, {"fastest", out.fastest}, {"unit", group.unit}};
        for (std::size_t i = 0; i < group.members.size(); ++i) json["at_limit"][group.members[i]] = out.at_limit[i];
        const auto* row = axes::find_error(out.place.error);
        if (!out.done)
            json["error"] = {{"code", row != nullptr ? std::string(row->name) : ""}, {"line", out.place.line}, {"where", out.where}};
        fmt::print("{}\n", json.dump(2));
    } else {
        print_outcome(out, group, name);
    }
    if (out.done) return exit_ok;
    if (out.place.error == axes::ErrorId::none)
        return fail(
            {"gcode.too_long", name, fmt::format("it has not ended after {:g} s of machine time", words.most_seconds), "give --most more"});
    const auto* row = axes::find_error(out.place.error);
    const auto subject = fmt::format("{}:{}", name, out.place.line);
    if (row == nullptr)
        return fail({"gcode.run", subject, "an axis has an error", "run the machine's own program, simulated, and look at its alarms"});
    return fail({"gcode.run", subject,
                 fmt::format("{}: {}", row->english.text, out.where.empty() ? row->english.cause : std::string_view(out.where)),
                 std::string(row->english.remedy)});
}

bool is_yaml(const std::string& path) {
    const auto ending = std::filesystem::path(path).extension();
    return ending == ".yaml" || ending == ".yml";
}

int run(const RunWords& words) {
    if (words.program.rotary)
        return fail({"usage.rotary", "--rotary", "on a machine a stored path moves X, Y and Z: the tool stays turned as it is",
                     "leave it out; `gcode check` and `gcode plot` take it"},
                    exit_usage);
    if (is_yaml(words.program.file) && !is_yaml(words.machine))
        return fail({"usage.order", shown_name(words.program.file), "a machine file where the program belongs",
                     fmt::format("the machine first: taktwerk gcode run {} {}", shown_name(words.program.file), shown_name(words.machine))},
                    exit_usage);
    auto how = interpreter_options(words.program);
    if (!how) return fail(how.error(), exit_usage);
    auto loaded = load_without_programs(words.machine, true);
    if (!loaded) return exit_bad_file;
    auto& config = loaded->machine;
    const auto group = group_of(config, words.group);
    if (!group) return fail(group.error());
    auto text = whole_text(words.program.file);
    if (!text) return fail(text.error());
    auto options = tables_of(config, words, *how);
    // The words of an error come from the reader; the machine knows its place alone.
    const auto name = shown_name(words.program.file);
    gcode::TextInMemory source(*text);
    if (const auto program = check_program(source, options, name); !program) return fail(program.error());
    config.paths = {
        {.name = "program", .file = words.program.file, .text = std::make_shared<const std::string>(std::move(*text)), .options = options}};
    DryRunWish wish;
    wish.group = *group;
    wish.options = {words.program.from_line, false, words.optional_stop, words.program.block_delete};
    wish.override_factor = words.override_percent / 100;
    wish.most_seconds = words.most_seconds;
    wish.keeps_points = !words.points.empty();
    const auto members =
        *std::find_if(config.axis_groups.begin(), config.axis_groups.end(), [&](const auto& g) { return g.name == *group; });
    const auto out = dry_run(std::move(config), wish);
    if (!out) return fail(out.error());
    if (!words.points.empty())
        if (const int code = write_points(words.points, *out); code != exit_ok) return code;
    return tell(words, *out, members);
}

}  // namespace

void add_gcode_run(CLI::App& gcode, Action& action) {
    auto* sub = gcode.add_subcommand("run",
                                     "carry a program out on a machine, simulated: how long it takes, which axis holds it back, what it "
                                     "asks for, and whether all of it can be reached");
    auto options = std::make_shared<RunWords>();
    sub->add_option("MACHINE", options->machine, "machine file; its own programs do not run")->required();
    add_program_options(*sub, options->program);
    sub->add_option("--group", options->group, "which group of axes goes it, where the machine has several");
    sub->add_option("--override", options->override_percent, "of the path's velocity, in percent")->check(CLI::Range(1.0, 100.0));
    sub->add_option("--most", options->most_seconds, "ends after so many seconds of machine time")->check(CLI::Range(1.0, 1e6));
    sub->add_flag("--optional-stop", options->optional_stop, "M1 is asked for, too");
    sub->add_option("--points", options->points, "every cycle's place of the tool as CSV: time,x,y,z,velocity,line");
    sub->add_flag("--json", options->json, "the result as one JSON object");
    sub->callback([&action, options] { action = [options] { return run(*options); }; });
}

}  // namespace taktwerk::apps
