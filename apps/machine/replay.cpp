// taktwerk replay RECORDING [MACHINE]: a recording drives its machine again, without hardware, and what it makes of it is compared.

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "apps/machine/load.hpp"
#include "apps/machine/machine_log.hpp"
#include "apps/machine/machine_recording.hpp"
#include "apps/machine/problem_json.hpp"
#include "apps/machine/trace_csv.hpp"
#include "apps/taktwerk.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/json_text.hpp"
#include "apps/terminal/output_files.hpp"
#include "apps/terminal/print_error.hpp"
#include "axes/axis/alarms.hpp"
#include "core/math.hpp"
#include "core/nearest_name.hpp"
#include "ecat/alarms.hpp"
#include "modbus/tcp/alarms.hpp"
#include "runtime/alarms.hpp"
#include "runtime/recording_file/recording_file.hpp"
#include "runtime/replay/recording_head.hpp"
#include "runtime/replay/replay.hpp"

namespace taktwerk::apps {

namespace {

using namespace runtime;

struct ReplayOptions {
    std::string recording, machine, trace, until;
    std::vector<std::string> programs;
    bool show = false, json = false, quiet = false;
};

const std::string* fact(const RecordSource& recording, std::string_view name) { return find_fact(recording.info(), name); }

/// Empty: with the end of its run.
std::string how_it_ends(RecordingEnd end) {
    switch (end) {
        case RecordingEnd::whole: return {};
        case RecordingEnd::kept: return "was kept while the machine ran on";
        case RecordingEnd::limit: return "ends where the room that it was given was used up (--record-disk)";
        case RecordingEnd::torn: return "has no end: the process that wrote it died, or its disk was full";
        case RecordingEnd::no_part: return "goes on in a part that is not beside it";
    }
    return {};
}

const char* word_of_end(RecordingEnd end) {
    switch (end) {
        case RecordingEnd::whole: return "whole";
        case RecordingEnd::kept: return "kept";
        case RecordingEnd::limit: return "limit";
        case RecordingEnd::torn: return "torn";
        case RecordingEnd::no_part: return "no_part";
    }
    return "";
}

/// `others`: in what this taktwerk, machine or program is another one than that of the recording.
int fail(const ReplayOptions& options, int code, const std::vector<Error>& errors, const std::vector<std::string>& others = {}) {
    if (options.json) {
        auto told = failure_json(errors);
        if (!others.empty()) told["other"] = others;
        fmt::print("{}\n", told.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
        return code;
    }
    print_errors(errors);
    for (const auto& other : others) fmt::print(stderr, "{}\n", other);
    return code;
}

struct ChannelCount {
    std::uint64_t records = 0, bytes = 0;
};
using ChannelCounts = std::map<std::string, ChannelCount>;

void show_json(const RecordingReader& recording, const ChannelCounts& counts) {
    std::string facts, channels;
    for (const auto& [name, value] : recording.info().facts)
        facts += fmt::format("{}{{\"name\":{},\"value\":{}}}", facts.empty() ? "" : ",", json_text(name), json_text(value));
    for (const auto& [name, count] : counts)
        channels += fmt::format("{}{{\"name\":{},\"records\":{},\"bytes\":{}}}", channels.empty() ? "" : ",", json_text(name),
                                count.records, count.bytes);
    fmt::print("{{\"records\":{},\"bytes\":{},\"files\":{},\"end\":\"{}\",\"lost\":{},\"facts\":[{}],\"channels\":[{}]}}\n",
               recording.records(), recording.bytes(), recording.parts(), word_of_end(recording.end()), recording.lost(), facts, channels);
}

void show_text(const RecordingReader& recording, const ChannelCounts& counts) {
    const auto end = how_it_ends(recording.end());
    fmt::print("{}, {}{}{}\n\n", count_text(recording.records(), "record"), count_text(recording.bytes(), "byte"),
               recording.parts() > 1 ? fmt::format(" in {} files", recording.parts()) : "", end.empty() ? "" : "; it " + end);
    for (const auto& [name, value] : recording.info().facts) fmt::print("  {:<28} {}\n", name, value);
    fmt::print("\n");
    for (const auto& [name, count] : counts)
        fmt::print("  {:<28} {:>10} records {:>12} bytes before they are compressed\n", name, count.records, count.bytes);
}

int show(RecordingReader& recording, const ReplayOptions& options) {
    ChannelCounts counts;
    for (;;) {
        const auto record = recording.next();
        if (!record) return fail(options, exit_bad_file, {record.error()});
        if (!record->has_value()) break;
        auto& count = counts[recording.info().channels[(*record)->channel]];
        ++count.records;
        count.bytes += (*record)->bytes.size();
    }
    if (options.json) show_json(recording, counts);
    else show_text(recording, counts);
    return exit_ok;
}

/// A time of the recording, or the name of an alarm. CLI11 knows units, but an option has one type.
std::optional<Duration> time_of(const std::string& text) {
    static const std::map<std::string, double> units{{"ms", 1e-3}, {"s", 1.0}, {"min", 60.0}, {"h", 3600.0}, {"", 1.0}};
    char* end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    const auto unit = units.find(end);
    if (end == text.c_str() || unit == units.end() || !(number >= 0 && number * unit->second < 1e8)) return std::nullopt;
    return from_seconds(number * unit->second);
}

/// Neither a time nor the name of an alarm that there is.
std::optional<Error> wrong_until(const std::string& text) {
    if (text.empty() || time_of(text) || text.starts_with("program_alarm_") || text.starts_with("alarm_")) return std::nullopt;
    std::vector<std::string> names;
    for (const std::span<const AlarmInfo> table :
         {std::span<const AlarmInfo>(machine_alarms), std::span<const AlarmInfo>(axes::axis_alarms),
          std::span<const AlarmInfo>(ecat::bus_alarms), std::span<const AlarmInfo>(modbus::tcp::device_alarms)})
        for (const auto& row : table) names.emplace_back(row.name);
    if (std::ranges::find(names, text) != names.end()) return std::nullopt;
    const auto near = nearest_name(text, names);
    return Error{"usage.until", "--until", fmt::format("'{}' is no time such as 12.5s, and no alarm has this name", text),
                 near.empty() ? "docs/reference/alarms.md has the names" : fmt::format("did you mean '{}'?", near)};
}

/// NAME=FILE or, of a machine with one program, FILE alone.
std::optional<Error> put_program(MachineConfig& config, const std::string& given) {
    const auto equals = given.find('=');
    const auto name = equals == std::string::npos ? std::string{} : given.substr(0, equals);
    const auto file = equals == std::string::npos ? given : given.substr(equals + 1);
    if (name.empty() && config.programs.size() != 1)
        return Error{"usage.program", "--program", fmt::format("the machine has {} programs", config.programs.size()),
                     "say which: --program NAME=FILE"};
    for (auto& program : config.programs)
        if (name.empty() || program.name == name) {
            program.library = file;
            program.entry = nullptr;
            return std::nullopt;
        }
    std::vector<std::string> names;
    for (const auto& program : config.programs) names.push_back(program.name);
    const auto near = nearest_name(name, names);
    return Error{"usage.program", "--program", fmt::format("the machine has no program '{}'", name),
                 near.empty() ? "take a name of the machine file" : fmt::format("did you mean '{}'?", near)};
}

/// What is said while it goes, and at its end.
class Report {
public:
    Report(const ReplayOptions& options, std::vector<std::string> others, bool informational)
        : options_(options), others_(std::move(others)), informational_(informational) {}

    void note(const ReplayDifference& difference, Instant start) {
        if (std::ranges::find(signals_, difference.signal) != signals_.end()) return;
        signals_.push_back(difference.signal);
        if (signals_.size() <= most_told) differences_.push_back({difference, start});
    }

    /// `end`: why the recording has no more; empty: that of its run, or the replay ended before.
    /// `reached`: what `--until` asks for.
    int end(const Replay& replay, const std::string& end, bool reached) const {
        if (options_.json) return end_json(replay, end.empty(), reached);
        for (const auto& other : others_) fmt::print("{}\n", other);
        if (!end.empty()) fmt::print("the recording {}. What is there was replayed.\n", end);
        if (differences_.empty()) {
            fmt::print("identical: {} ({} before the machine was up), {:.3f} s: every output byte, every set-point and every frame\n",
                       count_text(replay.cycles(), "cycle"), replay.cycles_before(),
                       to_seconds(std::max(replay.now(), replay.start()) - replay.start()));
            return exit_ok;
        }
        if (informational_)
            fmt::print(
                "with other programs, against the inputs of that day (open loop: what the machine would have answered to other outputs "
                "is not known), {} differ in {}:\n",
                count_text(signals_.size(), "signal"), count_text(replay.cycles(), "cycle"));
        for (const auto& [difference, start] : differences_)
            fmt::print("{}{}\n", informational_ ? "  " : "first difference: ", difference.text(start));
        if (signals_.size() > differences_.size()) fmt::print("  and {} more\n", signals_.size() - differences_.size());
        if (!informational_ && others_.empty())
            fmt::print(
                "taktwerk, the files of the machine and its programs are those that were recorded: this is a fault of taktwerk, or of a "
                "program that does not do the same twice (a clock, a random number, a file that it reads). Please report the first.\n");
        return informational_ ? exit_ok : exit_differs;
    }

private:
    static constexpr std::size_t most_told = 20;
    struct Told {
        ReplayDifference difference;
        Instant start;
    };

    int end_json(const Replay& replay, bool whole, bool reached) const {
        std::string out =
            fmt::format("{{\"identical\":{},\"cycles\":{},\"cycles_before\":{},\"seconds\":{:.6f},\"complete\":{}", differences_.empty(),
                        replay.cycles(), replay.cycles_before(), to_seconds(replay.now() - replay.start()), whole);
        if (!options_.until.empty()) out += fmt::format(",\"reached\":{}", reached);
        out += ",\"other\":[";
        for (std::size_t i = 0; i < others_.size(); ++i) out += (i > 0 ? "," : "") + json_text(others_[i]);
        out += "],\"differences\":[";
        for (std::size_t i = 0; i < differences_.size(); ++i) {
            const auto& d = differences_[i].difference;
            out += fmt::format("{}{{\"cycle\":{},\"seconds\":{:.6f},\"signal\":{},\"recorded\":{},\"replayed\":{}}}", i > 0 ? "," : "",
                               d.cycle, to_seconds(d.at - differences_[i].start), json_text(d.signal), json_text(d.recorded),
                               json_text(d.replayed));
        }
        fmt::print("{}]}}\n", out);
        return differences_.empty() || informational_ ? exit_ok : exit_differs;
    }

    const ReplayOptions& options_;
    std::vector<std::string> others_;
    bool informational_;
    std::vector<std::string> signals_;
    std::vector<Told> differences_;
};

bool stands(Machine& machine, const std::string& alarm) {
    const auto* snapshot = machine.latest();
    for (std::size_t i = 0; snapshot != nullptr && i < snapshot->alarm_count; ++i)
        if (snapshot->alarms[i].standing && machine.describe(snapshot->alarms[i].fact).name == alarm) return true;
    return false;
}

void say_state(Replay& replay) {
    const auto* snapshot = replay.machine().latest();
    if (snapshot == nullptr) return;
    fmt::print("\ncycle {}, {:.6f} s\n", replay.cycles(), to_seconds(replay.now() - replay.start()));
    const auto& axes = replay.machine().layout().axes;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const auto& view = snapshot->axes[i];
        fmt::print("  axis {}: {}, set {:.6g} {}, actual {:.6g}, following error {:.6g}, {:.6g} {}/s\n", axes[i].name, name(view.state),
                   view.set_position, axes[i].unit, view.actual_position, view.following_error, view.set_velocity, axes[i].unit);
    }
    for (std::size_t i = 0; i < snapshot->alarm_count; ++i) {
        const auto words = replay.machine().describe(snapshot->alarms[i].fact);
        fmt::print("  alarm {}: {} [{}]{}\n", words.source, words.english, words.name, snapshot->alarms[i].standing ? "" : " (over)");
    }
    const auto& outputs = replay.machine().layout().outputs;
    for (std::size_t i = 0; i < outputs.size(); ++i) fmt::print("  output {} = {}\n", outputs[i], snapshot->outputs[i]);
}

int replay(const ReplayOptions& options) {
    math::set_stepping_thread_float_environment();
    auto loaded = RecordingReader::open(options.recording);
    if (!loaded) return fail(options, exit_bad_file, {loaded.error()});
    auto& recording = **loaded;
    if (options.show) return show(recording, options);
    if (const auto wrong = wrong_until(options.until)) return fail(options, exit_usage, {*wrong});
    const auto* written = fact(recording, "machine_file");
    const auto file = !options.machine.empty() ? options.machine : written != nullptr ? *written : std::string{};
    if (file.empty())
        return fail(options, exit_bad_file,
                    {{"replay.not_of_a_machine", options.recording, "this recording does not say of which machine file it is",
                      "give the machine file behind it"}});
    std::vector<std::string> inputs{options.recording, file};
    for (const auto& program : options.programs) inputs.push_back(program.substr(program.find('=') + 1));
    if (const auto other = output_in_the_way(std::array{OutputFile{"--trace", options.trace}}, inputs))
        return fail(options, exit_usage, {*other});
    if (std::error_code failed; options.machine.empty() && !std::filesystem::exists(file, failed))
        return fail(options, exit_bad_file,
                    {{"replay.no_machine", file, "the machine file does not stand any more where it was recorded",
                      "give it behind the recording: taktwerk replay RECORDING MACHINE.yaml"}});
    const auto* simulated = fact(recording, "simulated");
    const config::FilesRead files;
    auto read = read_machine(file, simulated == nullptr || *simulated == "yes");
    if (const auto* errors = std::get_if<std::vector<Error>>(&read)) return fail(options, exit_bad_file, *errors);
    auto& machine_file = std::get<LoadedFile>(read);
    for (const auto& warning : machine_file.warnings) print_warning(warning);
    auto& config = machine_file.machine;
    for (const auto& program : options.programs)
        if (const auto wrong = put_program(config, program)) return fail(options, exit_usage, {*wrong});
    const RecordingInfo here{{}, facts_of(file, files, config, true)};
    auto others = other_facts(recording.info(), here);
    const auto until = options.until.empty() ? std::nullopt : time_of(options.until);
    auto made = Replay::make(std::move(config), recording);
    if (const auto* errors = std::get_if<1>(&made)) return fail(options, exit_bad_file, *errors, others);
    auto& replay = *std::get<0>(made);

    std::unique_ptr<TraceCsv> trace;
    if (!options.trace.empty()) {
        auto created = TraceCsv::create(options.trace, replay.machine().signals(), replay.machine().layout());
        if (!created) return fail(options, exit_bad_file, {created.error()});
        trace = std::move(*created);
        trace->count_from(replay.start());
    }
    MachineLog log{replay.machine(), replay.start(), options.json};
    Report report{options, std::move(others), !options.programs.empty()};
    bool reached = options.until.empty();
    auto step = Replay::Step::more;
    for (bool going = true; going;) {
        step = replay.step();
        if (step == Replay::Step::differs) report.note(*replay.difference(), replay.start());
        going = step == Replay::Step::more || (step == Replay::Step::differs && !options.programs.empty());
        if (trace) (void)trace->drain().ok();
        if (!options.quiet) log.step(replay.now(), replay.machine().latest());
        if (options.until.empty()) continue;
        reached = until ? replay.now() - replay.start() >= *until : stands(replay.machine(), options.until);
        going = going && !reached;
    }
    if (step == Replay::Step::malformed) return fail(options, exit_bad_file, {*replay.error()});
    if (trace)
        if (auto ok = trace->finish(); !ok) return fail(options, exit_bad_file, {ok.error()});
    const int code = report.end(replay, step == Replay::Step::ended ? how_it_ends(recording.end()) : std::string{}, reached);
    if (!options.until.empty() && !options.json) {
        if (!reached)
            fmt::print("`--until {}` was not reached: the recording ends at {:.3f} s\n", options.until,
                       to_seconds(replay.now() - replay.start()));
        say_state(replay);
    }
    return code;
}

}  // namespace

void add_replay(CLI::App& app, Action& action) {
    auto* sub = app.add_subcommand("replay", "let a recording of `run --record` drive its machine again, and compare what comes of it");
    auto options = std::make_shared<ReplayOptions>();
    sub->add_option("RECORDING", options->recording, "file of `taktwerk run --record`")->required();
    sub->add_option("MACHINE", options->machine, "machine file; default: the one that was recorded, where it stood then");
    sub->add_option("--until", options->until,
                    "stop at this time of the recording (12.5s), or when this alarm stands (drive_fault), and show the machine");
    sub->add_option("--trace", options->trace, "write every cycle to this CSV file (see `taktwerk plot`)");
    sub->add_option("--program", options->programs,
                    "with this program in the place of the recorded one: FILE.so, or NAME=FILE.so. What differs is told and is no failure");
    sub->add_flag("--show", options->show, "say what is in the recording, and replay nothing");
    sub->add_flag("--json", options->json, "events and result as JSON, one object a line, errors too; with --show one object");
    sub->add_flag("--quiet", options->quiet, "say only the result");
    sub->callback([&action, options] { action = [options] { return replay(*options); }; });
}

}  // namespace taktwerk::apps
