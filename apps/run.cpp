// taktwerk run FILE: runs a machine, in real time or in virtual time, on its bus or simulated.

#include <algorithm>
#include <cstdio>
#include <memory>

#include <fmt/format.h>

#include "apps/duration_option.hpp"
#include "apps/exit_code.hpp"
#include "apps/load.hpp"
#include "apps/machine_log.hpp"
#include "apps/sim_hands.hpp"
#include "apps/stop_signal.hpp"
#include "apps/taktwerk.hpp"
#include "apps/trace_csv.hpp"
#include "core/calendar_distance.hpp"
#include "core/math.hpp"
#include "ecat/diagnosis/frame_capture.hpp"
#include "ecat/transport/raw_socket.hpp"
#include "hmi_bridge/hmi_bridge.hpp"
#include "hmi_bridge/runtime_link.hpp"
#include "modbus/line/tty_line.hpp"
#include "runtime/alarms.hpp"
#include "runtime/keeps_positions.hpp"
#include "runtime/realtime_runner.hpp"
#include "runtime/virtual_runner.hpp"

namespace taktwerk::apps {

namespace {

using namespace runtime;

struct Options {
    std::string file, trace, pcap, retain;
    bool simulate = false, virtual_time = false, json = false, quiet = false;
    double duration_s = 0;
};

constexpr std::size_t trace_rows = 8192;

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

void print_summary(Machine& machine, const Options& options, double machine_seconds, double wall_seconds) {
    const auto* s = machine.latest();
    if (!s || options.quiet) return;
    const auto& total = machine.step_statistics().total();
    if (options.json) {
        fmt::print(
            "{{\"cycles\":{},\"missed\":{},\"lateness_max_us\":{:.1f},\"compute_p50_us\":{:.2f},\"compute_p99_us\":{:.2f},\"compute_max_"
            "us\":{:.2f},"
            "\"frames_lost\":{},\"machine_s\":{:.3f},\"wall_s\":{:.3f}}}\n",
            s->statistics.cycles, s->statistics.missed_ticks, to_seconds(s->statistics.lateness_max) * 1e6,
            to_seconds(total.percentile(50)) * 1e6, to_seconds(total.percentile(99)) * 1e6, to_seconds(total.max()) * 1e6,
            s->bus.frames_lost, machine_seconds, wall_seconds);
        return;
    }
    fmt::print("\n{} cycles of {} us, {} missed; {} frames lost, {} late\n", s->statistics.cycles, machine.layout().cycle.count() / 1000,
               s->statistics.missed_ticks, s->bus.frames_lost, s->bus.frames_late);
    fmt::print("computing per cycle: p50 {:.1f} us, p99 {:.1f} us, max {:.1f} us", to_seconds(total.percentile(50)) * 1e6,
               to_seconds(total.percentile(99)) * 1e6, to_seconds(total.max()) * 1e6);
    if (options.virtual_time)
        fmt::print("\n{:.1f} s of machine time in {:.2f} s: {:.0f} times real time\n", machine_seconds, wall_seconds,
                   machine_seconds / std::max(wall_seconds, 1e-9));
    else fmt::print("; wake-up at most {:.0f} us late\n", to_seconds(s->statistics.lateness_max) * 1e6);
    for (std::size_t i = 0; i < machine.layout().variables.size(); ++i) {
        const auto& v = machine.layout().variables[i];
        fmt::print("{}.{} = {}{}{}\n", v.program, v.name, s->variables[i], v.unit.empty() ? "" : " ", v.unit);
    }
}

/// The frames of the bus go into a file, if that was asked for. `capture` outlives the machine's cycle.
Result<void> capture_frames(Machine& machine, const Options& options, Duration epoch, std::unique_ptr<ecat::FrameCapture>& capture) {
    if (options.pcap.empty()) return {};
    auto created = ecat::FrameCapture::create(options.pcap, epoch);
    if (!created) return created.error();
    capture = std::move(*created);
    machine.bus().set_tap(&ecat::FrameCapture::tap, capture.get());
    return {};
}

/// After the cycle has ended. Says what is missing.
void finish(ecat::FrameCapture* capture, const Options& options) {
    if (capture == nullptr) return;
    if (auto ok = capture->finish(); !ok) print_error(ok.error());
    if (capture->dropped() > 0)
        print_warning(Error{"capture.dropped", options.pcap, fmt::format("{} frames did not fit and are missing", capture->dropped()), ""});
    if (!options.quiet && !options.json) fmt::print("{} frames in {}\n", capture->frames(), options.pcap);
}

std::unique_ptr<Machine> build(MachineConfig config, ecat::Transport& transport, std::vector<modbus::SerialLine*> lines) {
    auto built = Machine::build(std::move(config), transport, std::move(lines));
    if (auto* errors = std::get_if<1>(&built)) {
        print_errors(*errors);
        return nullptr;
    }
    return std::move(std::get<0>(built));
}

int run_virtual(LoadedFile loaded, const Options& options) {
    math::set_stepping_thread_float_environment();
    VirtualClock clock{Instant{}};
    World world{loaded.machine, clock.now()};
    std::unique_ptr<ecat::FrameCapture> capture;
    auto machine = build(std::move(loaded.machine), world.transport(), world.serial().lines());
    if (!machine) return exit_bad_file;
    if (auto ok = capture_frames(*machine, options, Duration{}, capture); !ok) {
        print_error(ok.error());
        return exit_bad_file;
    }
    std::unique_ptr<TraceCsv> trace;
    if (!options.trace.empty()) {
        auto created = TraceCsv::create(options.trace, machine->enable_trace(trace_rows), machine->layout());
        if (!created) {
            print_error(created.error());
            return exit_bad_file;
        }
        trace = std::move(*created);
    }
    watch_stop_signals();
    SystemClock wall;
    const auto wall_start = wall.now();
    MachineLog log{*machine, clock.now(), options.json};
    VirtualRunner runner{*machine, world, clock};
    int code = exit_ok;
    runner.after_cycle = [&](Instant now) {
        if (trace) trace->drain();
        if (capture) (void)capture->drain().ok();  // an error comes again from finish()
        const auto* snapshot = machine->latest();
        judge(snapshot, code);
        if (!options.quiet) log.step(now, snapshot);
        if (stop_requested()) machine->request_shutdown();
    };
    if (auto up = runner.bring_up(); !up) {
        finish(capture.get(), options);
        print_error(up.error());
        return exit_bus;
    }
    const auto duration = options.duration_s > 0 ? from_seconds(options.duration_s) : Duration::max() / 4;
    runner.run_for(std::max(duration - (clock.now() - Instant{}), Duration{}));
    runner.shut_down();
    finish(capture.get(), options);
    print_summary(*machine, options, to_seconds(clock.now() - Instant{}), to_seconds(wall.now() - wall_start));
    if (trace)
        if (auto ok = trace->finish(); !ok) {
            print_error(ok.error());
            return exit_bad_file;
        }
    return code;
}

int run_real(LoadedFile loaded, const Options& options) {
    SystemClock clock;
    std::unique_ptr<World> world;
    std::unique_ptr<ecat::RawSocketTransport> nic;
    if (loaded.machine.bus.interface.empty()) {
        world = std::make_unique<World>(loaded.machine, clock.now());
    } else {
        auto opened = ecat::RawSocketTransport::open(loaded.machine.bus.interface, {.clock = &clock});
        if (!opened) {
            print_error(opened.error());
            return exit_bus;
        }
        nic = std::move(*opened);
        if (!options.quiet && !options.json)
            for (const auto& refused : nic->report().refused) fmt::print("{}: {}\n", nic->interface(), refused);
    }
    ecat::Transport& transport = world ? static_cast<ecat::Transport&>(world->transport()) : *nic;
    std::unique_ptr<ecat::FrameCapture> capture;
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
    auto machine = build(std::move(loaded.machine), transport, std::move(lines));
    if (!machine) return exit_bad_file;
    if (auto ok = capture_frames(*machine, options, calendar_minus_machine_time(), capture); !ok) {
        print_error(ok.error());
        return exit_bad_file;
    }
    std::unique_ptr<TraceCsv> trace;
    if (!options.trace.empty()) {
        auto created = TraceCsv::create(options.trace, machine->enable_trace(trace_rows), machine->layout());
        if (!created) {
            print_error(created.error());
            return exit_bad_file;
        }
        trace = std::move(*created);
    }
    hmi::RuntimeLink link{*machine};
    hmi::HmiOptions bridge_options;
    if (!options.quiet && !options.json)
        bridge_options.log = [](std::string_view text) {
            fmt::print("{}\n", text);
            std::fflush(stdout);
        };
    std::optional<SimHands> hands;
    if (world) {
        hands.emplace(*world, machine->config());
        world->also = [&hands](Instant now) { hands->step(now); };
        bridge_options.simulate = [&hands](const std::string& line) { return hands->ask(line); };
    }
    auto bridge = hmi::HmiBridge::open(loaded.hmi, link, std::move(bridge_options));
    if (!bridge) {
        print_error(bridge.error());
        return exit_bad_file;
    }
    // Otherwise the bridge's own log has said it.
    if ((options.quiet || options.json) && (*bridge)->lcm_problem()) print_warning(*(*bridge)->lcm_problem());

    watch_stop_signals();
    RealtimeRunner runner{*machine, world.get()};
    auto started = runner.start();
    if (!started) {
        print_error(started.error());
        return exit_realtime;
    }
    if (!options.quiet && !options.json && !started->all_granted()) {
        fmt::print("Without real time (the machine runs, but not punctually):\n");
        for (const auto& item : started->items)
            if (!item.granted) fmt::print("  {}: {}. It costs: {}\n", item.what, item.reason, item.consequence);
        if (world && machine->config().simulation.supervision == Supervision::strict)
            fmt::print(
                "  This simulation is supervised as strictly as a real bus: a stall of this computer stops it. If that happens, write\n"
                "  `simulation: {{supervision: relaxed}}` into the machine file.\n");
    }
    const auto start = clock.now();
    if (trace) trace->count_from(start);
    MachineLog log{*machine, start, options.json};
    int code = exit_ok;
    bool said_stop = false;
    auto served = runner.serve([&](Instant now) {
        if (trace) trace->drain();
        if (capture) (void)capture->drain().ok();
        if (nic) nic->refresh();
        (*bridge)->set_progress(machine->bus_progress());
        (*bridge)->step(now);
        judge((*bridge)->snapshot(), code);
        if (!options.quiet) log.step(now, (*bridge)->snapshot());
        const bool time_up = options.duration_s > 0 && to_seconds(now - start) >= options.duration_s;
        if (stop_requested() && !said_stop) {
            said_stop = true;
            if (!options.quiet)
                log.say(now, "stop", fmt::format("{}: axes stop along their ramps, then power goes off", stop_signal_name()));
        }
        return !time_up && !stop_requested();
    });
    runner.finish();
    finish(capture.get(), options);
    if (!served) {
        print_error(served.error());
        return exit_bus;
    }
    print_summary(*machine, options, to_seconds(clock.now() - start), to_seconds(clock.now() - start));
    if (trace)
        if (auto ok = trace->finish(); !ok) {
            print_error(ok.error());
            return exit_bad_file;
        }
    return code;
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
    auto* sub = app.add_subcommand("run", "run a machine");
    auto options = std::make_shared<Options>();
    sub->add_option("FILE", options->file, "machine file")->required();
    sub->add_flag("--simulate", options->simulate, "simulated bus and drives, whatever the file says");
    sub->add_flag("--virtual-time", options->virtual_time, "as fast as the CPU allows, bit-identical each time (simulated only)");
    add_duration(*sub, "--duration", options->duration_s, "machine time, e.g. 60s; default: until stopped");
    sub->add_option("--retain", options->retain,
                    "keep the positions of axes with absolute encoders in this directory, also on a simulated bus");
    sub->add_option("--trace", options->trace, "write every cycle to this CSV file (see `taktwerk plot`)");
    sub->add_option("--pcap", options->pcap, "write every frame of the bus to this file, for Wireshark and tshark");
    sub->add_flag("--json", options->json, "events as one JSON object a line");
    sub->add_flag("--quiet", options->quiet, "say nothing but errors");
    sub->callback([&action, options] {
        action = [options] {
            auto loaded = load(options->file, options->simulate || options->virtual_time);
            if (!loaded) return static_cast<int>(exit_bad_file);
            if (!options->retain.empty()) loaded->machine.retain = options->retain;
            if (!options->retain.empty() && !runtime::keeps_positions(loaded->machine))
                print_warning(Error{"config.nothing_to_retain", "--retain " + options->retain,
                                    "no axis has an absolute encoder: nothing will be kept",
                                    "add `position_memory: {absolute: true}` to the axes that have one"});
            return options->virtual_time ? run_virtual(std::move(*loaded), *options) : run_real(std::move(*loaded), *options);
        };
    });
}

}  // namespace taktwerk::apps
