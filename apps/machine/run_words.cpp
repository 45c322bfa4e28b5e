#include "apps/machine/run_words.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "apps/terminal/count_text.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "core/installed_memory.hpp"
#include "runtime/alarms.hpp"
#include "runtime/check/recording_memory.hpp"

namespace taktwerk::apps {

using namespace runtime;

void judge(const Snapshot* s, int& code) {
    if (!s || s->phase != MachinePhase::running) return;
    code = exit_ok;
    for (std::size_t i = 0; i < s->alarm_count; ++i)
        if (s->alarms[i].standing && s->alarms[i].reaction >= Reaction::stop_machine &&
            s->alarms[i].fact.id != id(MachineAlarm::stopped_by_signal))
            code = exit_alarm;
}

void print_summary(Machine& machine, const RunOptions& options, double machine_seconds, double wall_seconds, const MachineLog::Sink& put) {
    const auto* s = machine.latest();
    if (!s || options.quiet) return;
    const auto& total = machine.step_statistics().total();
    if (options.json) {
        put(fmt::format(
            "{{\"cycles\":{},\"missed\":{},\"lateness_max_us\":{:.1f},\"compute_p50_us\":{:.2f},\"compute_p99_us\":{:.2f},\"compute_max_"
            "us\":{:.2f},"
            "\"frames_lost\":{},\"page_faults\":{},\"machine_s\":{:.3f},\"wall_s\":{:.3f}}}\n",
            s->statistics.cycles, s->statistics.missed_ticks, to_seconds(s->statistics.lateness_max) * 1e6,
            to_seconds(total.percentile(50)) * 1e6, to_seconds(total.percentile(99)) * 1e6, to_seconds(total.max()) * 1e6,
            s->bus.frames_lost, s->statistics.page_faults, machine_seconds, wall_seconds));
        return;
    }
    std::string lines;
    const auto say = [&lines]<class... T>(fmt::format_string<T...> format, T&&... values) {
        lines += fmt::format(format, std::forward<T>(values)...);
    };
    say("\n{} cycles of {} us, {} missed; {} frames lost, {} late\n", s->statistics.cycles, machine.layout().cycle.count() / 1000,
        s->statistics.missed_ticks, s->bus.frames_lost, s->bus.frames_late);
    say("computing per cycle: p50 {:.1f} us, p99 {:.1f} us, max {:.1f} us", to_seconds(total.percentile(50)) * 1e6,
        to_seconds(total.percentile(99)) * 1e6, to_seconds(total.max()) * 1e6);
    if (options.virtual_time)
        say("\n{:.1f} s of machine time in {:.2f} s: {:.0f} times real time\n", machine_seconds, wall_seconds,
            machine_seconds / std::max(wall_seconds, 1e-9));
    else
        say("; wake-up at most {:.0f} us late; {} page faults of the cycle\n", to_seconds(s->statistics.lateness_max) * 1e6,
            s->statistics.page_faults);
    if (s->statistics.snapshots_dropped > 0) say("{} rows of the trace did not fit and are missing\n", s->statistics.snapshots_dropped);
    for (std::size_t i = 0; i < machine.layout().variables.size(); ++i) {
        const auto& v = machine.layout().variables[i];
        say("{}.{} = {}{}{}\n", v.program, v.name, s->variables[i], v.unit.empty() ? "" : " ", v.unit);
    }
    put(std::move(lines));
}

void finish_capture(const RunFiles& files, const RunOptions& options) {
    files.finish_capture();
    files.say_frames(options.quiet || options.json, &MachineLog::print);
}

void say_losses(const RunFiles& files, const RunOptions& options) {
    if (const auto lost = files.recording && !options.record.empty() ? files.recording->lost() : 0; lost > 0)
        print_warning(Error{"recording.lost", options.record,
                            fmt::format("{} did not fit: it cannot be replayed", count_text(lost, "record")),
                            "record onto a disk that keeps up"});
}

bool recording_finished(const RunFiles& files, const RunOptions& options) {
    if (!files.recording) return true;
    if (auto ok = files.recording->finish(); !ok) {
        print_error(ok.error());
        return false;
    }
    say_losses(files, options);
    return true;
}

void say_evidence(const MachineLog& log, Instant now, const Result<Evidence::File>& file) {
    if (!file) log.say(now, "evidence", file.error().text());
    else if (const auto text = evidence_text(*file); !text.empty()) log.say(now, "evidence", text);
}

void say_recording(const MachineLog& log, Instant now, const Result<FlightRecorder::File>& file) {
    if (!file) log.say(now, "recording", file.error().text());
    else if (const auto text = recording_text(*file); !text.empty()) log.say(now, "recording", text);
}

void finish_recordings(const MachineLog& log, Instant now, FlightRecorder& recorder) {
    for (bool more = true; more;) {
        const auto file = recorder.finish();
        more = !file || !file->path.empty();
        say_recording(log, now, file);
    }
}

namespace {

/// False: nothing was due.
bool say_kept_run(const MachineLog& log, Instant now, const Result<RunMemory::Kept>& kept, bool quiet) {
    if (!kept) log.say(now, "replay", kept.error().text());
    else if (kept->path.empty()) return false;
    else if (!quiet)
        log.say(now, "replay",
                fmt::format("the run{} can be replayed ({:.1f} s, {:.1f} MB): taktwerk replay {}",
                            kept->why.empty() ? std::string{} : fmt::format(" up to '{}'", kept->why), to_seconds(kept->covered),
                            static_cast<double>(kept->bytes) / 1e6, kept->path));
    return true;
}

}  // namespace

void say_recorded(const MachineLog& log, Instant now, MachineRecording& recording, bool quiet) {
    if (const auto failed = recording.drain()) log.say(now, "record", failed->text());
    if (auto* memory = recording.memory()) (void)say_kept_run(log, now, memory->work(), quiet);
}

void finish_run_memory(const MachineLog& log, Instant now, MachineRecording& recording, bool quiet) {
    auto* memory = recording.memory();
    if (memory == nullptr) return;
    while (say_kept_run(log, now, memory->work(), quiet)) {}
    (void)say_kept_run(log, now, memory->finish(), quiet);
}

void say_kept(const MachineLog& log, Instant now, const Machine& machine, const RunOptions& options) {
    if (options.quiet) return;
    for (auto& line : lines_of(machine.retain_notes())) log.say(now, "retain", std::move(line));
}

void say_bundle(const MachineLog& log, Instant now, const RunOptions& options) {
    if (!options.from_bundle) return;
    for (const auto& remark : options.from_bundle->start().remarks) log.say(now, "BUNDLE", remark.text());
    if (!options.quiet) log.say(now, "bundle", options.from_bundle->title());
}

void note_bundle(const MachineLog& log, Instant now, BundleRun& bundle, bool& noted) {
    if (noted || !bundle.reached()) return;
    noted = true;
    if (const auto written = bundle.work(); !written) log.say(now, "bundle", written.error().text());
}

std::unique_ptr<Machine> build_machine(MachineConfig config, ecat::Transport& transport, std::vector<modbus::SerialLine*> lines,
                                       std::vector<modbus::tcp::Exchange*> exchanges) {
    auto built = Machine::build(std::move(config), transport, std::move(lines), std::move(exchanges));
    if (auto* errors = std::get_if<1>(&built)) {
        print_errors(*errors);
        return nullptr;
    }
    auto machine = std::move(std::get<0>(built));
    const auto& recording = machine->config().recording;
    if (auto fits = runtime::recording_fits(recording.depth, machine->signals().bytes(), installed_memory()); !fits) {
        print_error(fits.error());
        return nullptr;
    }
    return machine;
}

}  // namespace taktwerk::apps
