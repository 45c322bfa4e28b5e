// In real time: each kind of work has a thread of its own (docs/stopping.md).
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "apps/machine/about.hpp"
#include "apps/machine/crash_line.hpp"
#include "apps/machine/file_thread.hpp"
#include "apps/machine/history_file.hpp"
#include "apps/machine/journal.hpp"
#include "apps/machine/modbus_keeper.hpp"
#include "apps/machine/page_server.hpp"
#include "apps/machine/run_options.hpp"
#include "apps/machine/run_words.hpp"
#include "apps/machine/sim_hands.hpp"
#include "apps/machine/status_line.hpp"
#include "apps/machine/stop_signal.hpp"
#include "apps/machine/systemd_link.hpp"
#include "apps/machine/unfinished_run.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/json_text.hpp"
#include "apps/terminal/line_writer.hpp"
#include "apps/terminal/print_error.hpp"
#include "core/calendar_distance.hpp"
#include "core/realtime.hpp"
#include "ecat/ring/bus_interfaces.hpp"
#include "hmi_bridge/history/alarm_history.hpp"
#include "hmi_bridge/hmi_bridge.hpp"
#include "hmi_bridge/runtime_link.hpp"
#include "hmi_bridge/socket/socket_path.hpp"
#include "hmi_bridge/views/view_answers.hpp"
#include "modbus/line/tty_line.hpp"
#include "modbus/tcp/tcp_exchange.hpp"
#include "runtime/run/realtime_runner.hpp"

namespace taktwerk::apps {

using namespace runtime;

namespace {

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
               const RunOptions& options, Facts facts, const std::function<void()>& ended_in_order) {
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

    if (auto begun =
            files.record(machine,
                         {{options.record, {options.record_size, options.record_disk}},
                          MachineRecording::memory_of(machine.config(), start, calendar_minus_machine_time(), RecordedThreads::several)},
                         std::move(facts), start, RecordedThreads::several);
        !begun) {
        if (options.from_bundle) options.from_bundle->excuse();
        print_error(begun.error());
        return exit_bad_file;
    }
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
    if (files.recording) bridge_options.run_memory = files.recording->memory();
    auto views = hmi::ViewAnswers::make(hmi_config.views, hmi::view_values_of(machine.config(), machine.layout()));
    if (!views) {
        print_error(views.error());
        return exit_bad_file;
    }
    bridge_options.views = std::move(views).value();
    auto bridge = hmi::HmiBridge::open(hmi_config, link, std::move(bridge_options));
    if (!bridge) {
        if (options.from_bundle && bridge.error().code == "socket.in_use") options.from_bundle->excuse();
        print_error(bridge.error());
        return exit_bad_file;
    }

    say_crashes();
    const SignalsEndMachine signals{machine};
    const int of_cycle = machine.config().realtime.priority;
    const DoorKeeper door{(*bridge)->door(), clock, of_cycle > 1 ? std::optional<int>{of_cycle - 1} : std::nullopt};
    const ModbusKeeper modbus_clients{(*bridge)->modbus_server(), clock};
    std::vector<std::unique_ptr<FileThread>> writers;
    const auto write_beside = [&](const char* what, std::string name, auto file) {
        if (file)
            writers.push_back(std::make_unique<FileThread>(
                std::move(name), [file] { return Result<void>(file->drain()); }, [file] { return Result<void>(file->finish()); },
                [&, what](const Error& error) { log.say(clock.now(), what, error.text()); }));
    };
    if (files.trace) files.trace->count_from(start);
    write_beside("trace", "the trace", files.trace);
    write_beside("pcap", "the capture of frames", files.capture);
    if (files.evidence)
        writers.push_back(std::make_unique<FileThread>(
            "frames around alarms",
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
            "recordings around alarms",
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
            "the alarm history",
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
            "the record of the bundle",
            [&log, &clock, bundle, noted = false]() mutable {
                note_bundle(log, clock.now(), *bundle, noted);
                return Result<void>{};
            },
            [bundle] {
                (void)bundle->work().ok();  // what could not be written was said
                return Result<void>{};
            },
            [](const Error&) {}));
    auto written = FileThread::End::complete;  // the worst of all
    const auto not_taken = [&] {               // what hangs in a disk
        std::string what;
        for (auto& writer : writers) {
            const auto end = writer->finish(file_patience);
            if (end == FileThread::End::hangs) what += (what.empty() ? "" : ", ") + writer->what();
            written = std::max(written, end);
        }
        return what;
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
    if (files.recording) {
        writers.push_back(std::make_unique<FileThread>(
            "the record of the run",
            [&log, &clock, &options, recording = files.recording] {
                say_recorded(log, clock.now(), *recording, options.quiet);
                return Result<void>{};
            },
            [&log, &clock, &options, recording = files.recording] {
                auto done = recording->finish();
                finish_run_memory(log, clock.now(), *recording, options.quiet);
                return done;
            },
            [](const Error&) {}));
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
        (void)not_taken();
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
        if (const auto* snapshot = (*bridge)->snapshot(); snapshot != nullptr) files.look_for_replay(*snapshot, machine);
        time_up = options.duration_s > 0 && to_seconds(now - start) >= options.duration_s;
        if (stop_requested() && !said_stop) {
            said_stop = true;
            if (!options.quiet)
                log.say(now, "stop", fmt::format("{}: axes stop along their ramps, then power goes off", stop_signal_name()));
        }
        return !time_up && !stop_requested();
    });
    runner.finish();
    if (served) ended_in_order();  // whatever becomes of the files
    page.reset();
    if (const auto hangs = not_taken(); !hangs.empty()) {
        // Its thread hangs in the kernel and holds what it writes from: nothing of this process can be taken down any more.
        out.finish(last_lines_patience);
        say_directly({"run.disk_hangs", "run", "the machine is down, but a disk does not take the rest of " + hangs,
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
        if (time_up && options.from_bundle) options.from_bundle->excuse();
        const bool asked = error.code == RealtimeRunner::ended_early && !time_up;
        return asked ? exit_ok : exit_bus;
    }
    return written == FileThread::End::complete ? code : static_cast<int>(exit_bad_file);
}

int run_here(LoadedFile loaded, const RunOptions& options, Facts facts, const std::function<void()>& ended_in_order) {
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
    auto machine = build_machine(std::move(loaded.machine), transport, std::move(lines), std::move(exchanges));
    if (!machine) return exit_bad_file;
    if (auto ok = files.open(*machine, calendar_minus_machine_time()); !ok) {
        if (options.from_bundle) options.from_bundle->excuse();
        print_error(ok.error());
        return exit_bad_file;
    }
    return serve_real(*machine, world.get(), nic.get(), files, loaded.hmi, options, std::move(facts), ended_in_order);
}

}  // namespace

/// Who restarts a machine that crashed is no operator: it comes up without power, and nothing in it begins by itself.
int run_real(LoadedFile loaded, RunOptions options, Facts facts) {
    const auto socket = loaded.hmi.socket.empty() ? hmi::make_socket_path(loaded.machine.name) : Result<std::string>{loaded.hmi.socket};
    if (!socket) return run_here(std::move(loaded), options, std::move(facts), [] {});  // says why itself
    auto mark = UnfinishedRun::begin(std::filesystem::path(*socket).replace_extension(".running"), boot_of_this_computer());
    if (mark.trouble()) print_error(*mark.trouble());
    if (mark.before()) {
        loaded.machine.start_mode = Mode::manual;
        options.run_before = fmt::format(
            "the run before this one{} did not end in order: this one begins in manual mode, and no program starts by "
            "itself. Look why it ended; then `taktwerk mode automatic` and `taktwerk start PROGRAM`",
            mark.before()->process != 0 ? fmt::format(" (process {})", mark.before()->process)
                                        : std::string(", as far as its mark can be read,"));
    }
    const int code = run_here(std::move(loaded), options, std::move(facts), [&mark] { mark.ended(); });
    // Behind a crash a start that fails (the bus is not there yet) changes nothing: whoever tries again is no operator either.
    const bool ran = code == exit_ok || code == exit_alarm;
    if (ran || !mark.before()) mark.ended();
    return code;
}

}  // namespace taktwerk::apps
