// taktwerk sim FILE --nic IF: plays the slaves of a machine file on a network interface, for any master on the cable.

#include <poll.h>

#include <cstdio>

#include <fmt/format.h>

#include "apps/duration_option.hpp"
#include "apps/exit_code.hpp"
#include "apps/load.hpp"
#include "apps/stop_signal.hpp"
#include "apps/taktwerk.hpp"
#include "core/clock.hpp"
#include "ecat/transport/raw_socket.hpp"
#include "runtime/world.hpp"

namespace taktwerk::apps {

namespace {

struct Options {
    std::string file, nic;
    double duration_s = 0;
};

std::string_view name(ecat::sim::EsmState state) {
    using S = ecat::sim::EsmState;
    switch (state) {
        case S::init: return "INIT";
        case S::preop: return "PREOP";
        case S::boot: return "BOOT";
        case S::safeop: return "SAFEOP";
        case S::op: return "OP";
    }
    return "?";
}

std::string_view name(axes::sim::Cia402Axis::State state) {
    using S = axes::sim::Cia402Axis::State;
    switch (state) {
        case S::not_ready: return "not ready";
        case S::disabled: return "switch on disabled";
        case S::ready: return "ready";
        case S::switched_on: return "switched on";
        case S::enabled: return "operation enabled";
        case S::quick_stop: return "quick stop";
        case S::fault_reaction: return "fault reaction";
        case S::fault: return "fault";
    }
    return "?";
}

/// Says when a slave or a drive changes its state: what one watches while a master brings the bus up, or dies.
class StateLog {
public:
    StateLog(ecat::sim::SimNetwork& network, runtime::World& world, const runtime::MachineConfig& machine)
        : network_(network), states_(network.size(), ecat::sim::EsmState::init) {
        for (const auto& binding : machine.axes)
            if (auto* drive = world.drive(binding.axis.name)) drives_.push_back({binding.axis.name, drive, drive->state()});
    }
    void step() {
        for (auto& known : drives_) {
            const auto state = known.drive->state();
            if (state == known.state) continue;
            fmt::print("drive of axis {}: {} -> {}\n", known.axis, name(known.state), name(state));
            std::fflush(stdout);
            known.state = state;
        }
        for (std::size_t i = 0; i < states_.size(); ++i) {
            const auto state = network_.slave(i).state();
            if (state == states_[i]) continue;
            fmt::print("slave {} '{}' {} -> {}\n", i, network_.slave(i).options().name, name(states_[i]), name(state));
            std::fflush(stdout);
            states_[i] = state;
        }
    }

private:
    struct Drive {
        std::string axis;
        axes::sim::Cia402Axis* drive;
        axes::sim::Cia402Axis::State state;
    };
    ecat::sim::SimNetwork& network_;
    std::vector<ecat::sim::EsmState> states_;
    std::vector<Drive> drives_;
};

int play(const Options& options) {
    auto loaded = load(options.file, true);
    if (!loaded) return exit_bad_file;
    auto opened = ecat::RawSocketTransport::open(options.nic);
    if (!opened) {
        print_error(opened.error());
        return exit_bus;
    }
    auto& nic = **opened;
    watch_stop_signals();
    SystemClock clock;
    const Instant start = clock.now();
    runtime::World world{loaded->machine, start};
    auto& network = world.network();
    StateLog log{network, world, loaded->machine};
    fmt::print("{} slaves of '{}' on {}; Ctrl-C ends\n", network.size(), loaded->machine.name, options.nic);
    std::fflush(stdout);

    std::array<std::byte, ecat::max_frame_size> frame{};
    std::uint64_t frames = 0, unanswered = 0;
    while (!stop_requested()) {
        Instant now = clock.now();
        if (options.duration_s > 0 && to_seconds(now - start) > options.duration_s) break;
        const Duration wait = std::clamp(network.next_event() - now, Duration{}, Duration{std::chrono::milliseconds{10}});
        pollfd ready{nic.descriptor(), POLLIN, 0};
        timespec timeout{0, static_cast<long>(wait.count())};
        ::ppoll(&ready, 1, &timeout, nullptr);
        now = clock.now();
        world.apply_events(now);
        network.advance(now);
        while (auto received = nic.receive(frame, now)) {
            const auto bytes = std::span{frame}.first(received->size);
            if (network.process(bytes, now)) {
                nic.send(bytes, now);
                ++frames;
            } else {
                ++unanswered;
            }
            now = clock.now();
        }
        log.step();
    }
    fmt::print("{} frames answered, {} not\n", frames, unanswered);
    for (std::size_t i = 0; i < network.size(); ++i)
        if (const auto missed = network.slave(i).missed_outputs())
            fmt::print("slave {} '{}': {} SYNC0 pulses found no new outputs\n", i, network.slave(i).options().name, missed);
    return exit_ok;
}

}  // namespace

void add_sim(CLI::App& app, Action& action) {
    auto* sub = app.add_subcommand("sim", "play the slaves of a machine file on a network interface, for any EtherCAT master");
    auto options = std::make_shared<Options>();
    sub->add_option("FILE", options->file, "machine file")->required();
    sub->add_option("--nic", options->nic, "network interface, e.g. eth1")->required();
    add_duration(*sub, "--duration", options->duration_s, "default: until Ctrl-C");
    sub->callback([&action, options] { action = [options] { return play(*options); }; });
}

}  // namespace taktwerk::apps
