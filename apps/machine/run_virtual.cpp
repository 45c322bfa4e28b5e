// In virtual time: one thread calls everything.
#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "apps/machine/history_file.hpp"
#include "apps/machine/run_options.hpp"
#include "apps/machine/run_words.hpp"
#include "apps/machine/stop_signal.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "core/math.hpp"
#include "hmi_bridge/history/alarm_history.hpp"
#include "runtime/run/realtime_runner.hpp"
#include "runtime/run/virtual_runner.hpp"

namespace taktwerk::apps {

using namespace runtime;

int run_virtual(LoadedFile loaded, const RunOptions& options, Facts facts) {
    math::set_stepping_thread_float_environment();
    VirtualClock clock{Instant{}};
    World world{loaded.machine, clock.now()};
    RunFiles files{options.pcap, options.trace, {}, {}, {}, {}, {}};
    auto machine = build_machine(std::move(loaded.machine), world.bus(), world.serial().lines(), world.modbus().exchanges());
    if (!machine) return exit_bad_file;
    if (auto ok = files.open(*machine, Duration{}); !ok) {
        if (options.from_bundle) options.from_bundle->excuse();
        print_error(ok.error());
        return exit_bad_file;
    }
    watch_stop_signals();
    SystemClock wall;
    const auto wall_start = wall.now();
    MachineLog log{*machine, clock.now(), options.json};
    say_bundle(log, clock.now(), options);
    say_kept(log, clock.now(), *machine, options);
    if (loaded.hmi.modbus_server && !options.quiet)
        log.say(clock.now(), "gateway", "no Modbus TCP client is served: in virtual time a second is not theirs");
    if (auto begun = files.record(*machine,
                                  {{options.record, {options.record_size, options.record_disk}},
                                   MachineRecording::memory_of(machine->config(), clock.now(), Duration{}, RecordedThreads::one)},
                                  std::move(facts), clock.now(), RecordedThreads::one);
        !begun) {
        if (options.from_bundle) options.from_bundle->excuse();
        print_error(begun.error());
        return exit_bad_file;
    }
    VirtualRunner runner{*machine, world, clock};
    runner.drain = [&] {
        if (files.recording) say_recorded(log, clock.now(), *files.recording, options.quiet);
    };
    std::optional<hmi::AlarmHistory> history;  // only where it was asked for: a run in virtual time leaves nothing behind by itself
    if (!options.history.empty() && loaded.hmi.history.rows > 0)
        history.emplace(
            history_path(options.history, machine->layout().machine), loaded.hmi.history.rows,
            [&](const AlarmFact& fact) { return machine->describe(fact); },
            [&](std::string_view text) { log.say(clock.now(), "history", std::string(text)); });
    int code = exit_ok;
    bool bundle_noted = false;
    runner.after_cycle = [&](Instant now) {
        if (files.trace) (void)files.trace->drain().ok();  // an error comes again from finish()
        if (files.capture) (void)files.capture->drain().ok();
        if (files.evidence && machine->latest() != nullptr) {
            files.evidence->look(*machine->latest());
            say_evidence(log, now, files.evidence->write_due(now));
        }
        if (files.recorder && machine->latest() != nullptr) {
            files.recorder->look(*machine->latest());
            say_recording(log, now, files.recorder->work());
        }
        if (machine->latest() != nullptr) files.look_for_replay(*machine->latest(), *machine);
        const auto* snapshot = machine->latest();
        if (history && snapshot != nullptr) {
            history->look(*snapshot, now, now.time_since_epoch() / std::chrono::microseconds{1});
            history->work(now);
        }
        judge(snapshot, code);
        if (options.from_bundle) {
            options.from_bundle->look(snapshot);
            note_bundle(log, now, *options.from_bundle, bundle_noted);
        }
        if (!options.quiet) log.step(now, snapshot);
        if (stop_requested()) machine->request_shutdown();
    };
    auto up = runner.bring_up();
    if (up && stop_requested())
        up = Error{std::string(RealtimeRunner::ended_early), "run",
                   fmt::format("ended by {}: the bus was not operational yet", stop_signal_name()), "nothing has moved; start it again"};
    if (const double took = to_seconds(clock.now() - Instant{}); up && options.duration_s > 0 && took >= options.duration_s)
        up = Error{std::string(RealtimeRunner::ended_early), "run",
                   fmt::format("ended by --duration: the bus needed {:.3g} s to become operational, and the run was to last {:.3g} s", took,
                               options.duration_s),
                   "nothing has moved; give --duration more than the bus needs"};
    const auto recorded = [&] {
        const bool whole = recording_finished(files, options);
        if (files.recording) finish_run_memory(log, clock.now(), *files.recording, options.quiet);
        return whole;
    };
    if (!up) {
        finish_capture(files, options);
        (void)recorded();
        print_error(up.error());
        return stop_requested() ? exit_ok : exit_bus;
    }
    const auto duration = options.duration_s > 0 ? from_seconds(options.duration_s) : Duration::max() / 4;
    runner.run_for(std::max(duration - (clock.now() - Instant{}), Duration{}));
    runner.shut_down();
    if (files.evidence) say_evidence(log, clock.now(), files.evidence->finish());
    if (files.recorder) finish_recordings(log, clock.now(), *files.recorder);
    const bool whole = recorded();
    if (history) history->finish(clock.now());
    finish_capture(files, options);
    print_summary(*machine, options, to_seconds(clock.now() - Instant{}), to_seconds(wall.now() - wall_start), &MachineLog::print);
    if (!whole) return exit_bad_file;
    if (files.trace)
        if (auto ok = files.trace->finish(); !ok) {
            print_error(ok.error());
            return exit_bad_file;
        }
    return code;
}

}  // namespace taktwerk::apps
