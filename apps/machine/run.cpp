// taktwerk run FILE: runs a machine, in real time or in virtual time, on its bus or simulated.

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "apps/machine/about.hpp"
#include "apps/machine/bundle_run.hpp"
#include "apps/machine/crash_line.hpp"
#include "apps/machine/file_thread.hpp"
#include "apps/machine/history_file.hpp"
#include "apps/machine/journal.hpp"
#include "apps/machine/load.hpp"
#include "apps/machine/machine_log.hpp"
#include "apps/machine/modbus_keeper.hpp"
#include "apps/machine/page_server.hpp"
#include "apps/machine/recordings_folder.hpp"
#include "apps/machine/run_files.hpp"
#include "apps/machine/sim_hands.hpp"
#include "apps/machine/status_line.hpp"
#include "apps/machine/stop_signal.hpp"
#include "apps/machine/systemd_link.hpp"
#include "apps/machine/unfinished_run.hpp"
#include "apps/taktwerk.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/duration_option.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/json_text.hpp"
#include "apps/terminal/line_writer.hpp"
#include "apps/terminal/print_error.hpp"
#include "core/calendar_distance.hpp"
#include "core/installed_memory.hpp"
#include "core/math.hpp"
#include "core/realtime.hpp"
#include "ecat/ring/bus_interfaces.hpp"
#include "hmi_bridge/history/alarm_history.hpp"
#include "hmi_bridge/hmi_bridge.hpp"
#include "hmi_bridge/runtime_link.hpp"
#include "hmi_bridge/socket/socket_path.hpp"
#include "hmi_bridge/views/view_answers.hpp"
#include "modbus/line/tty_line.hpp"
#include "modbus/tcp/tcp_exchange.hpp"
#include "runtime/alarms.hpp"
#include "runtime/check/recording_memory.hpp"
#include "runtime/run/realtime_runner.hpp"
#include "runtime/run/virtual_runner.hpp"

namespace taktwerk::apps {

namespace {

using namespace runtime;

struct RunOptions {
    std::string start = "warm";
    std::string run_before;  ///< what is to be said of it; empty: it ended in order
    std::string file, trace, pcap, record, retain, evidence, recordings, history, hmi;
    bool simulate = false, virtual_time = false, json = false, quiet = false, with_hmi = false, without_events = false;
    double duration_s = 0;
    std::string bundle, root;
    unsigned tries = usual_tries;
    std::shared_ptr<BundleRun> from_bundle{};  ///< with --bundle, once it is chosen
};

/// A run that ends with something machine-wide still standing did not end well. What stands while the machine goes down does not
/// count: then the bus is meant to be silent.
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
            "\"frames_lost\":{},\"machine_s\":{:.3f},\"wall_s\":{:.3f}}}\n",
            s->statistics.cycles, s->statistics.missed_ticks, to_seconds(s->statistics.lateness_max) * 1e6,
            to_seconds(total.percentile(50)) * 1e6, to_seconds(total.percentile(99)) * 1e6, to_seconds(total.max()) * 1e6,
            s->bus.frames_lost, machine_seconds, wall_seconds));
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
    else say("; wake-up at most {:.0f} us late\n", to_seconds(s->statistics.lateness_max) * 1e6);
    if (s->statistics.snapshots_dropped > 0) say("{} rows of the trace did not fit and are missing\n", s->statistics.snapshots_dropped);
    for (std::size_t i = 0; i < machine.layout().variables.size(); ++i) {
        const auto& v = machine.layout().variables[i];
        say("{}.{} = {}{}{}\n", v.program, v.name, s->variables[i], v.unit.empty() ? "" : " ", v.unit);
    }
    put(std::move(lines));
}

void finish(const RunFiles& files, const RunOptions& options) {
    files.finish_capture();
    files.say_frames(options.quiet || options.json, &MachineLog::print);
}

using Facts = std::vector<std::pair<std::string, std::string>>;

void say_losses(const RunFiles& files, const RunOptions& options) {
    if (const auto lost = files.recording ? files.recording->lost() : 0; lost > 0)
        print_warning(Error{"recording.lost", options.record,
                            fmt::format("{} did not fit: it cannot be replayed", count_text(lost, "record")),
                            "record onto a disk that keeps up"});
}

/// False: it is not whole, and why has been told.
bool recording_finished(const RunFiles& files, const RunOptions& options) {
    if (!files.recording) return true;
    if (auto ok = files.recording->finish(); !ok) {
        print_error(ok.error());
        return false;
    }
    say_losses(files, options);
    return true;
}

/// A file that could not be written is told; the next one is tried all the same.
void say_evidence(const MachineLog& log, Instant now, const Result<Evidence::File>& file) {
    if (!file) log.say(now, "evidence", file.error().text());
    else if (const auto text = evidence_text(*file); !text.empty()) log.say(now, "evidence", text);
}

void say_recording(const MachineLog& log, Instant now, const Result<FlightRecorder::File>& file) {
    if (!file) log.say(now, "recording", file.error().text());
    else if (const auto text = recording_text(*file); !text.empty()) log.say(now, "recording", text);
}

/// What could not be written so far; however many there are.
void finish_recordings(const MachineLog& log, Instant now, FlightRecorder& recorder) {
    for (bool more = true; more;) {
        const auto file = recorder.finish();
        more = !file || !file->path.empty();
        say_recording(log, now, file);
    }
}

void say_kept(const MachineLog& log, Instant now, const Machine& machine, const RunOptions& options) {
    if (options.quiet) return;
    for (auto& line : lines_of(machine.retain_notes())) log.say(now, "retain", std::move(line));
}

/// Which bundle it is, and why it may be another than the one that was active.
void say_bundle(const MachineLog& log, Instant now, const RunOptions& options) {
    if (!options.from_bundle) return;
    for (const auto& remark : options.from_bundle->start().remarks) log.say(now, "BUNDLE", remark.text());
    if (!options.quiet) log.say(now, "bundle", options.from_bundle->title());
}

/// Once; a disk that takes nothing is not asked in every round.
void note_bundle(const MachineLog& log, Instant now, BundleRun& bundle, bool& noted) {
    if (noted || !bundle.reached()) return;
    noted = true;
    if (const auto written = bundle.work(); !written) log.say(now, "bundle", written.error().text());
}

std::unique_ptr<Machine> build(MachineConfig config, ecat::Transport& transport, std::vector<modbus::SerialLine*> lines,
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

int run_virtual(LoadedFile loaded, const RunOptions& options, Facts facts) {
    math::set_stepping_thread_float_environment();
    VirtualClock clock{Instant{}};
    World world{loaded.machine, clock.now()};
    RunFiles files{options.pcap, options.trace, {}, {}, {}, {}, {}};
    auto machine = build(std::move(loaded.machine), world.bus(), world.serial().lines(), world.modbus().exchanges());
    if (!machine) return exit_bad_file;
    if (auto ok = files.open(*machine, Duration{}); !ok) {
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
    if (!options.record.empty()) {
        auto created = MachineRecording::create(options.record, *machine, std::move(facts), clock.now(), RecordedThreads::one);
        if (!created) {
            print_error(created.error());
            return exit_bad_file;
        }
        files.recording = std::move(*created);
    }
    VirtualRunner runner{*machine, world, clock};
    runner.drain = [&] {
        if (files.recording) (void)files.recording->drain().ok();  // an error comes again from finish()
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
    if (!up) {
        finish(files, options);
        (void)recording_finished(files, options);
        print_error(up.error());
        return stop_requested() ? exit_ok : exit_bus;
    }
    const auto duration = options.duration_s > 0 ? from_seconds(options.duration_s) : Duration::max() / 4;
    runner.run_for(std::max(duration - (clock.now() - Instant{}), Duration{}));
    runner.shut_down();
    if (files.evidence) say_evidence(log, clock.now(), files.evidence->finish());
    if (files.recorder) finish_recordings(log, clock.now(), *files.recorder);
    if (history) history->finish(clock.now());
    finish(files, options);
    print_summary(*machine, options, to_seconds(clock.now() - Instant{}), to_seconds(wall.now() - wall_start), &MachineLog::print);
    if (!recording_finished(files, options)) return exit_bad_file;
    if (files.trace)
        if (auto ok = files.trace->finish(); !ok) {
            print_error(ok.error());
            return exit_bad_file;
        }
    return code;
}

constexpr Duration file_patience = std::chrono::seconds{3};
constexpr Duration last_lines_patience = std::chrono::seconds{1};
constexpr Duration door_look = std::chrono::milliseconds{5};

/// A line on standard error without stdio, which another thread may hold; a terminal that takes nothing is left alone.
void say_directly(const Error& error) {
    const auto text = "error: " + error.text() + "\n";
    pollfd ready{STDERR_FILENO, POLLOUT, 0};
    if (::poll(&ready, 1, 100) <= 0) return;
    [[maybe_unused]] const auto put = ::write(STDERR_FILENO, text.data(), std::min<std::size_t>(text.size(), 4096));
}

/// Its own thread, so that nothing which the service side does holds up a stop (hmi_bridge/socket/door.hpp).
class DoorKeeper {
public:
    /// `priority`: SCHED_FIFO, just below the cycle, or busy clients would take this thread's time; nothing where the system refuses it, which the
    /// report of the cycle's own priority has said.
    DoorKeeper(hmi::Door& door, Clock& clock, std::optional<int> priority)
        : thread_{[this, &door, &clock, priority] {
              if (priority) (void)set_fifo_priority(*priority).ok();
              while (!ended_.load(std::memory_order_acquire)) {
                  door.wait(door_look);
                  door.step(clock.now());
              }
          }} {}
    ~DoorKeeper() {
        ended_.store(true, std::memory_order_release);
        thread_.join();
    }
    DoorKeeper(const DoorKeeper&) = delete;
    DoorKeeper& operator=(const DoorKeeper&) = delete;

private:
    std::atomic<bool> ended_{false};
    std::thread thread_;
};

/// From here on nothing that may wait happens on a thread that somebody else waits for (docs/stopping.md).
int serve_real(Machine& machine, World* world, ecat::BusInterfaces* nic, RunFiles& files, const hmi::HmiConfig& hmi_config,
               const RunOptions& options, Facts facts) {
    SystemClock clock;
    const auto start = clock.now();
    LineWriter out{STDOUT_FILENO, [&options](std::uint64_t count) {
                       const auto text = fmt::format("{} lines are missing here: standard output did not take them", count);
                       return options.json ? fmt::format("{{\"event\":\"missing\",\"text\":{}}}\n", json_text(text)) : text + "\n";
                   }};
    const auto put = [&out](std::string lines) { out.put(std::move(lines)); };
    const Journal journal{machine.layout().machine};
    const bool to_journal = !options.json && output_is_journal(std::getenv("JOURNAL_STREAM"));
    MachineLog log{machine, start, [&](const LogEntry& entry) {
                       if (!to_journal || !journal.take(entry)) put(options.json ? json_line(entry) : text_lines(entry));
                   }};
    // For the page: in text, also what is not printed.
    const auto tail = std::make_shared<hmi::LogTail>();
    MachineLog kept{machine, start, false, [tail](const std::string& lines) { tail->add(lines); }};

    if (!options.run_before.empty())
        for (auto* each : {&log, &kept}) each->say(start, "restart", options.run_before);
    say_bundle(log, start, options);
    say_bundle(kept, start, options);
    say_kept(log, start, machine, options);
    say_kept(kept, start, machine, options);

    hmi::RuntimeLink link{machine};
    hmi::HmiOptions bridge_options;
    bridge_options.door = hmi::DoorThread::own;
    bridge_options.log = [&](std::string_view text) {
        kept.say(clock.now(), "gateway", std::string(text));
        const bool of_the_house = text.ends_with(" connected") || text.starts_with("commands are taken");
        if (options.quiet && of_the_house) return;
        log.say(clock.now(), "gateway", std::string(text));
    };
    bridge_options.about = about();
    bridge_options.log_tail = tail;
    std::optional<SimHands> hands;
    if (world) {
        hands.emplace(*world, machine.config());
        world->also = [&hands](Instant now) { hands->step(now); };
        bridge_options.simulate = [&hands](const std::string& line) { return hands->ask(line); };
    }
    bridge_options.recorder = files.recorder.get();
    link.set_recorder(files.recorder.get());
    auto views = hmi::ViewAnswers::make(hmi_config.views, hmi::view_values_of(machine.config(), machine.layout()));
    if (!views) {
        print_error(views.error());
        return exit_bad_file;
    }
    bridge_options.views = std::move(views).value();
    auto bridge = hmi::HmiBridge::open(hmi_config, link, std::move(bridge_options));
    if (!bridge) {
        print_error(bridge.error());
        return exit_bad_file;
    }

    say_crashes();
    const SignalsEndMachine signals{machine};
    const int of_cycle = machine.config().realtime.priority;
    const DoorKeeper door{(*bridge)->door(), clock, of_cycle > 1 ? std::optional<int>{of_cycle - 1} : std::nullopt};
    const ModbusKeeper modbus_clients{(*bridge)->modbus_server(), clock};
    std::vector<std::unique_ptr<FileThread>> writers;
    const auto write_beside = [&](const char* what, auto file) {
        if (file)
            writers.push_back(std::make_unique<FileThread>([file] { return Result<void>(file->drain()); },
                                                           [file] { return Result<void>(file->finish()); },
                                                           [&, what](const Error& error) { log.say(clock.now(), what, error.text()); }));
    };
    if (files.trace) files.trace->count_from(start);
    write_beside("trace", files.trace);
    write_beside("pcap", files.capture);
    if (files.evidence)
        writers.push_back(std::make_unique<FileThread>(
            [&log, &clock, evidence = files.evidence] {
                say_evidence(log, clock.now(), evidence->write_due(clock.now()));
                return Result<void>{};
            },
            [&log, &clock, evidence = files.evidence] {
                say_evidence(log, clock.now(), evidence->finish());
                return Result<void>{};
            },
            [](const Error&) {}));
    if (files.recorder)
        writers.push_back(std::make_unique<FileThread>(
            [&log, &clock, recorder = files.recorder] {
                say_recording(log, clock.now(), recorder->work());
                return Result<void>{};
            },
            [&log, &clock, recorder = files.recorder] {
                finish_recordings(log, clock.now(), *recorder);
                return Result<void>{};
            },
            [](const Error&) {}));
    if (hmi_config.history.rows > 0) {
        const auto place = history_place(hmi_config.history, machine.layout(), (*bridge)->socket_path());
        const auto say = [&log, &clock](std::string_view text) { log.say(clock.now(), "history", std::string(text)); };
        const auto history = std::make_shared<hmi::AlarmHistory>(
            place.path, hmi_config.history.rows, [&link](const AlarmFact& fact) { return link.describe(fact); }, say);
        history->set_recordings([&link](const AlarmFact& fact, Instant since) { return link.recording_of(fact, since); });
        (*bridge)->keep(history);
        if (!place.remark.empty() && !options.quiet) say(place.remark);
        writers.push_back(std::make_unique<FileThread>(
            [history, &clock] {
                history->work(clock.now());
                return Result<void>{};
            },
            [history, &clock] {
                history->finish(clock.now());
                return Result<void>{};
            },
            [](const Error&) {}));
    }
    if (const auto bundle = options.from_bundle)
        writers.push_back(std::make_unique<FileThread>(
            [&log, &clock, bundle, noted = false]() mutable {
                note_bundle(log, clock.now(), *bundle, noted);
                return Result<void>{};
            },
            [bundle] {
                (void)bundle->work().ok();  // what could not be written was said
                return Result<void>{};
            },
            [](const Error&) {}));
    const auto files_written = [&] {
        auto worst = FileThread::End::complete;
        for (auto& writer : writers) worst = std::max(worst, writer->finish(file_patience));
        return worst;
    };

    std::unique_ptr<PageServer> page;
    if (options.with_hmi) {
        auto begun =
            PageServer::start((*bridge)->socket_path(), options.hmi, [&](const std::string& line) { log.say(clock.now(), "page", line); });
        if (begun) page = std::move(*begun);
        else log.say(clock.now(), "page", begun.error().text());
    }

    SystemdLink manager{[](const char* name) -> const char* { return std::getenv(name); }};
    StatusLine status;
    RealtimeRunner runner{machine, world};
    if (!options.record.empty()) {
        auto created = MachineRecording::create(options.record, machine, std::move(facts), start, RecordedThreads::several);
        if (!created) {
            print_error(created.error());
            return exit_bad_file;
        }
        files.recording = std::move(*created);
        write_beside("record", files.recording);
        runner.record_in_step();
    }
    bool said_stuck = false;
    runner.on_stuck = [&](const StuckCycle* stuck) {
        link.tell_stuck(stuck);
        if (stuck != nullptr && !said_stuck) log.say(clock.now(), "STUCK", stuck->text());
        if (stuck == nullptr && said_stuck) log.say(clock.now(), "STUCK", "gone: the cycle advances again");
        said_stuck = stuck != nullptr;
    };
    // What hangs holds a thread that cannot be taken back: the process ends as it is, and the drives fall to their watchdogs.
    runner.give_up = [&](const Error& error) {
        (void)files_written();
        out.finish(last_lines_patience);
        say_directly(error);
        std::_Exit(exit_hung);
    };
    auto started = runner.start();
    if (!started) {
        print_error(started.error());
        return exit_realtime;
    }
    if (!options.quiet && !options.json && !started->all_granted()) {
        std::string lines = "Without real time (the machine runs, but not punctually):\n";
        for (const auto& item : started->items)
            if (!item.granted) lines += fmt::format("  {}: {}. It costs: {}\n", item.what, item.reason, item.consequence);
        if (world && machine.config().simulation.supervision == Supervision::strict)
            lines +=
                "  This simulation is supervised as strictly as a real bus: a stall of this computer stops it. If that happens, write\n"
                "  `simulation: {supervision: relaxed}` into the machine file.\n";
        out.put(std::move(lines));
    }
    int code = exit_ok;
    bool said_stop = false, time_up = false;
    auto served = runner.serve([&](Instant now) {
        if (nic) {
            nic->refresh();
            for (const auto& said : nic->news()) log.say(now, "bus", said);
        }
        (*bridge)->set_progress(machine.bus_progress());
        (*bridge)->step(now);
        if (page) page->step();
        if (const auto* snapshot = (*bridge)->snapshot(); snapshot == nullptr) {
            manager.starting(now, machine.bus_progress());
        } else {
            manager.ready();
            if (status.due(now)) manager.status(status.text(*snapshot));
        }
        manager.alive(now, machine.pulse().cycles);
        if (stop_requested() || machine.shutdown_asked()) manager.stopping();
        judge((*bridge)->snapshot(), code);
        if (options.from_bundle) options.from_bundle->look((*bridge)->snapshot());
        if (!options.quiet) log.step(now, (*bridge)->snapshot());
        kept.step(now, (*bridge)->snapshot());
        if (const auto* snapshot = (*bridge)->snapshot(); files.evidence && snapshot != nullptr) files.evidence->look(*snapshot);
        if (const auto* snapshot = (*bridge)->snapshot(); files.recorder && snapshot != nullptr) files.recorder->look(*snapshot);
        time_up = options.duration_s > 0 && to_seconds(now - start) >= options.duration_s;
        if (stop_requested() && !said_stop) {
            said_stop = true;
            if (!options.quiet)
                log.say(now, "stop", fmt::format("{}: axes stop along their ramps, then power goes off", stop_signal_name()));
        }
        return !time_up && !stop_requested();
    });
    runner.finish();
    page.reset();
    const auto written = files_written();
    if (written == FileThread::End::hangs) {
        // Its thread hangs in the kernel and holds what it writes from: nothing of this process can be taken down any more.
        out.finish(last_lines_patience);
        say_directly({"run.disk_hangs", "run",
                      "the machine is down, but a disk does not take the rest of the trace, capture or alarm history",
                      "Look at that disk; the file is not complete."});
        std::_Exit(exit_bad_file);
    }
    files.say_frames(options.quiet || options.json, put);
    say_losses(files, options);
    if (served) print_summary(machine, options, to_seconds(clock.now() - start), to_seconds(clock.now() - start), put);
    out.finish(last_lines_patience);
    if (!served) {
        auto error = served.error();
        if (error.code == RealtimeRunner::ended_early)
            error.what.replace(0, std::string_view("ended").size(),
                               fmt::format("ended by {}", stop_requested() ? stop_signal_name()
                                                          : time_up        ? "--duration"
                                                                           : "a client's shutdown"));
        print_error(error);
        // Who asked for the end got it: a service that is stopped while it starts has not failed. A run that was to last has.
        const bool asked = error.code == RealtimeRunner::ended_early && !time_up;
        return asked ? exit_ok : exit_bus;
    }
    return written == FileThread::End::complete ? code : static_cast<int>(exit_bad_file);
}

int run_real(LoadedFile loaded, const RunOptions& options, Facts facts) {
    SystemClock clock;
    std::unique_ptr<World> world;
    std::unique_ptr<ecat::BusInterfaces> nic;
    if (loaded.machine.bus.interface.empty()) {
        world = std::make_unique<World>(loaded.machine, clock.now());
    } else {
        const auto& bus = loaded.machine.bus;
        auto opened = ecat::BusInterfaces::open(bus.interface, bus.ring ? bus.ring->interface2 : std::string{}, ecat::ring_patience(bus),
                                                bus.transport, {.clock = &clock});
        if (!opened) {
            print_error(opened.error());
            return exit_bus;
        }
        nic = std::move(*opened);
        if (!options.quiet && !options.json)
            for (const auto& remark : nic->remarks()) fmt::print("{}\n", remark);
    }
    ecat::Transport& transport = world ? world->bus() : nic->bus();
    RunFiles files{options.pcap, options.trace, {}, {}, {}, {}, {}};
    auto lines = world ? world->serial().lines() : std::vector<modbus::SerialLine*>(loaded.machine.serial.size());
    std::vector<std::unique_ptr<modbus::TtyLine>> ports;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const auto& line = loaded.machine.serial[i];
        if (line.device.empty()) continue;  // simulated; without a simulation Machine::build says who misses it
        auto opened = modbus::TtyLine::open(line.device, line.settings);
        if (!opened) {
            print_error(opened.error());
            return exit_bus;
        }
        lines[i] = opened->get();
        ports.push_back(std::move(*opened));
    }
    auto exchanges = world ? world->modbus().exchanges() : std::vector<modbus::tcp::Exchange*>(loaded.machine.modbus.size());
    std::vector<std::unique_ptr<modbus::tcp::TcpExchange>> devices;
    for (std::size_t i = 0; i < exchanges.size(); ++i) {
        if (loaded.machine.modbus[i].host.empty()) continue;  // likewise
        devices.push_back(std::make_unique<modbus::tcp::TcpExchange>(loaded.machine.modbus[i]));
        exchanges[i] = devices.back().get();
    }
    auto machine = build(std::move(loaded.machine), transport, std::move(lines), std::move(exchanges));
    if (!machine) return exit_bad_file;
    if (auto ok = files.open(*machine, calendar_minus_machine_time()); !ok) {
        print_error(ok.error());
        return exit_bad_file;
    }
    return serve_real(*machine, world.get(), nic.get(), files, loaded.hmi, options, std::move(facts));
}

/// Who restarts a machine that crashed is no operator: it comes up without power, and nothing in it begins by itself.
int run_marked(LoadedFile loaded, RunOptions options, Facts facts) {
    const auto socket = loaded.hmi.socket.empty() ? hmi::make_socket_path(loaded.machine.name) : Result<std::string>{loaded.hmi.socket};
    if (!socket) return run_real(std::move(loaded), options, std::move(facts));  // says why itself
    auto mark = UnfinishedRun::begin(std::filesystem::path(*socket).replace_extension(".running"), boot_of_this_computer());
    if (!mark && !options.quiet) print_error(mark.error());
    if (mark && mark->before()) {
        loaded.machine.start_mode = Mode::manual;
        options.run_before = fmt::format(
            "the run before this one (process {}) did not end in order: this one begins in manual mode, and no program starts by "
            "itself. Look why it ended; then `taktwerk mode automatic` and `taktwerk start PROGRAM`",
            mark->before()->process);
    }
    const int code = run_real(std::move(loaded), options, std::move(facts));
    if (mark) mark->ended();
    return code;
}

/// The file or the bundle, whichever was asked for.
Result<void> choose(RunOptions& options, config::LoadOptions& loading) {
    if (options.file.empty() == options.bundle.empty())
        return Error{"usage.run", "run", options.file.empty() ? "nothing is named that shall run" : "a file and a bundle are named",
                     "write `taktwerk run FILE` or `taktwerk run --bundle MACHINE`"};
    if (options.bundle.empty()) return {};
    auto begun = begin_start(BundleStore(bundle_root(options.root)), options.bundle, options.tries, this_host(), deed_now());
    if (!begun) return begun.error();
    options.from_bundle = std::make_shared<BundleRun>(std::move(begun).value());
    const auto& start = options.from_bundle->start();
    for (const auto& remark : start.remarks) print_warning(remark);
    options.file = start.bundle.machine_file().string();
    loading.state_dir = start.state.string();
    return {};
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
    auto* sub = app.add_subcommand("run", "run a machine");
    auto options = std::make_shared<RunOptions>();
    sub->add_option("FILE", options->file, "machine file");
    sub->add_option("--bundle", options->bundle, "instead of a file: the active version of this machine (`taktwerk bundle`)");
    sub->add_option("--root", options->root, "with --bundle: where bundles are; default: $STATE_DIRECTORY, else /var/lib/taktwerk");
    sub->add_option("--tries", options->tries, "with --bundle: starts that may fail before the version before is taken again")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    sub->add_flag("--simulate", options->simulate, "simulated bus and drives, whatever the file says");
    sub->add_flag("--virtual-time", options->virtual_time, "as fast as the CPU allows, bit-identical each time (simulated only)");
    add_duration(*sub, "--duration", options->duration_s, "machine time, e.g. 60s; default: until stopped");
    sub->add_option("--retain", options->retain,
                    "keep variables, parameters and positions over a time without power in this directory, also on a simulated bus");
    sub->add_option("--start", options->start, "which kept values it begins with: warm: all (default); cold: persistent ones; origin: none")
        ->check(CLI::IsMember({"warm", "cold", "origin"}));
    sub->add_option("--trace", options->trace, "write every cycle to this CSV file (see `taktwerk plot`)");
    sub->add_option("--pcap", options->pcap, "write every frame of the bus to this file, for Wireshark and tshark");
    sub->add_option("--record", options->record, "write everything that comes in to this file, for `taktwerk replay`");
    sub->add_option("--evidence", options->evidence,
                    "write what was on the bus around each alarm that stops something into this directory, also on a simulated bus");
    auto* hmi = sub->add_flag(
        "--hmi{}", options->hmi,
        "serve the page as well, by a process of its own: --hmi=ADDRESS:PORT, default 127.0.0.1 and port 8080 or the next free one");
    sub->add_flag("--no-events", options->without_events, "what stands under `simulation: events` does not happen");
    sub->add_option("--recordings", options->recordings,
                    "keep the seconds around each alarm that stops something in this directory, also of a simulated machine");
    sub->add_option("--history", options->history, "keep the alarms in this directory, also in virtual time");
    sub->add_flag("--json", options->json, "events as one JSON object a line");
    sub->add_flag("--quiet", options->quiet, "say only errors and what clients change");
    sub->callback([&action, options, hmi] {
        options->with_hmi = hmi->count() > 0;
        action = [options] {
            if (options->with_hmi && options->virtual_time) {
                print_error(Error{"usage.hmi", "--hmi", "a machine in virtual time has no page: its seconds are nobody's",
                                  "Leave out --virtual-time."});
                return static_cast<int>(exit_usage);
            }
            const config::FilesRead read;
            auto loading = load_options(options->simulate || options->virtual_time);
            if (const auto chosen = choose(*options, loading); !chosen) {
                print_error(chosen.error());
                return static_cast<int>(chosen.error().code == "usage.run" ? exit_usage : exit_bad_file);
            }
            auto loaded = load(options->file, loading);
            if (!loaded) return static_cast<int>(exit_bad_file);
            if (options->without_events) loaded->machine.simulation.events.clear();
            if (!options->retain.empty()) loaded->machine.retain.directory = options->retain;
            loaded->machine.retain.start = options->start == "cold"     ? runtime::RetainStart::cold
                                           : options->start == "origin" ? runtime::RetainStart::origin
                                                                        : runtime::RetainStart::warm;
            if (!options->evidence.empty()) loaded->machine.evidence.directory = options->evidence;
            auto& recordings = loaded->machine.recording.directory;
            if (!options->recordings.empty()) recordings = options->recordings;
            else if (recordings.empty() && !options->virtual_time) recordings = usual_recordings(loaded->machine);
            if (!options->history.empty()) loaded->hmi.history.directory = options->history;
            const bool simulated = options->simulate || options->virtual_time;
            auto facts = options->record.empty() ? Facts{} : facts_of(options->file, read, loaded->machine, simulated);
            const int code = options->virtual_time ? run_virtual(std::move(*loaded), *options, std::move(facts))
                                                   : run_marked(std::move(*loaded), *options, std::move(facts));
            if (options->from_bundle && code == exit_ok) options->from_bundle->ended_as_asked();
            return code;
        };
    });
}

}  // namespace taktwerk::apps
