// taktwerk sim FILE --nic IF: plays the slaves of a machine file on a network interface, for any master on the cable. Commands on
// standard input make things go wrong while it runs.

#include <poll.h>
#include <unistd.h>

#include <cstdio>

#include <fmt/format.h>

#include "apps/machine/load.hpp"
#include "apps/machine/sim_hands.hpp"
#include "apps/machine/sim_lines.hpp"
#include "apps/machine/stop_signal.hpp"
#include "apps/taktwerk.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/duration_option.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/line_input.hpp"
#include "apps/terminal/print_error.hpp"
#include "core/clock.hpp"
#include "ecat/transport/raw_socket.hpp"
#include "runtime/world/world.hpp"

namespace taktwerk::apps {

namespace {

struct SimOptions {
    std::string file, nic, nic2;
    bool strict = false;
    double duration_s = 0;
    std::vector<std::string> faults, serial;
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
            auto& slave = network_.slave(i);
            fmt::print("slave {} '{}' {} -> {}\n", i, slave.options().name, name(states_[i]), name(state));
            if (states_[i] == ecat::sim::EsmState::preop && state == ecat::sim::EsmState::safeop && slave.runs_without_required_sync0())
                fmt::print("slave {} '{}' runs without SYNC0; a real {} refuses that (002Dh), as it does here with --strict\n", i,
                           slave.options().name, slave.description().name);
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

/// The language of standard input: that of the faults on the bus, what else happens to the machine, and a few words about the simulation
/// itself.
class Commands {
public:
    Commands(runtime::World& world, const runtime::MachineConfig& machine) : network_(world.network()), hands_(world, machine) {}

    /// False: `quit`.
    bool obey(const std::string& line, Instant now) {
        if (line.find_first_not_of(" \t\r") == std::string::npos || line.front() == '#') return true;
        if (line == "quit") return false;
        if (line == "help") help();
        else if (line == "slaves") slaves();
        else if (const auto done = inject(line, now); !done) print_error(done.error());
        else fmt::print("{}\n", line);
        std::fflush(stdout);
        return true;
    }
    Result<void> inject(const std::string& line, Instant now) { return hands_.happen(line, now); }
    void step(Instant now) { hands_.step(now); }
    [[nodiscard]] Instant next_event() const noexcept { return hands_.next_event(); }

private:
    static void help() {
        for (const auto& word : sim_words()) fmt::print("  {:<40} {}\n", fmt::format("{} {}", word.word, word.arguments), word.effect);
        fmt::print("  {:<40} position, name and state of each slave\n", "slaves");
        fmt::print("  {:<40} ends the simulation\n", "quit");
    }
    void slaves() {
        for (std::size_t i = 0; i < network_.size(); ++i) {
            auto& slave = network_.slave(i);
            fmt::print("  {:>3} {:<20} {}\n", i, slave.options().name, slave.powered() ? name(slave.state()) : "no power");
        }
    }
    ecat::sim::SimNetwork& network_;
    SimHands hands_;
};

/// What comes back to the master, at the time at which it would come back through the slaves. Returns the frames sent.
std::uint64_t return_answers(ecat::LoopbackTransport& cable, ecat::RawSocketTransport& nic, SystemClock& clock) {
    constexpr Duration worth_waiting = std::chrono::microseconds{200};  // a flight through 100 slaves; later ones wait in poll
    std::array<std::byte, ecat::max_frame_size> frame{};
    std::uint64_t sent = 0;
    while (const auto next = cable.next_arrival()) {
        Instant now = clock.now();
        if (*next - now > worth_waiting) break;
        while (now < *next) now = clock.now();
        const auto received = cable.receive(frame, now);
        if (!received) break;
        sent += nic.send(std::span{frame}.first(received->size), now) ? 1 : 0;
    }
    return sent;
}

/// Where a cable from the master ends: an interface, and the simulated cable behind it.
struct CableEnd {
    std::unique_ptr<ecat::RawSocketTransport> nic;
    ecat::LoopbackTransport* cable = nullptr;
};

/// One, or two of a ring; nothing: it has been said why.
std::vector<CableEnd> open_ends(const SimOptions& options, runtime::World& world) {
    std::vector<CableEnd> ends;
    const auto open = [&](const std::string& name, ecat::LoopbackTransport* cable) {
        auto opened = ecat::RawSocketTransport::open(name);
        if (opened) ends.push_back({std::move(*opened), cable});
        else print_error(opened.error());
        return opened.ok();
    };
    if (!open(options.nic, &world.transport())) return {};
    if (options.nic2.empty()) world.set_ring_cable(false);
    else if (world.second_transport() == nullptr) {
        print_error(
            Error{"usage", options.nic2, "no slave of the machine file can be the last one of a ring", "add slaves, or leave out --nic2"});
        return {};
    } else if (!open(options.nic2, world.second_transport())) return {};
    return ends;
}

/// Of a ring: a cable that is really out is out for the simulated slave at its end, too, which closes its port.
class Carriers {
public:
    Carriers(const std::vector<CableEnd>& ends, runtime::World& world) : ends_(ends), world_(world) {}
    void step(Instant now) {
        constexpr Duration period = std::chrono::milliseconds{20};
        if (ends_.size() < there_.size() || now < next_) return;
        next_ = now + period;
        for (std::size_t i = 0; i < there_.size(); ++i) {
            ends_[i].nic->refresh();
            const bool there = ends_[i].nic->link_up();
            seen_[i] = seen_[i] || there;  // a new interface is told of its carrier up to a second late
            if (!seen_[i] || there == there_[i]) continue;
            there_[i] = there;
            if (i == 0) world_.set_cable(world_.network().slave(0).options().name, there);
            else world_.set_ring_cable(there);
        }
    }

private:
    const std::vector<CableEnd>& ends_;
    runtime::World& world_;
    std::array<bool, 2> there_{true, true}, seen_{};
    Instant next_{};
};

int play(const SimOptions& options) {
    auto loaded = load_without_programs(options.file, true);
    if (!loaded) return exit_bad_file;
    if (!options.nic2.empty() && !loaded->machine.bus.ring) {
        print_error(Error{"usage", options.nic2, "a second interface, and the machine file has no ring",
                          "add `ring` to its bus, or leave out --nic2"});
        return exit_usage;
    }
    watch_stop_signals();
    SystemClock clock;
    const Instant start = clock.now();
    runtime::World world{loaded->machine, start};
    auto& network = world.network();
    const auto ends = open_ends(options, world);
    if (ends.empty()) return exit_bus;
    for (std::size_t i = 0; i < network.size(); ++i)
        network.slave(i).require_sync0(options.strict ? ecat::sim::SyncRequirement::as_described : ecat::sim::SyncRequirement::waived);
    StateLog log{network, world, loaded->machine};
    Commands commands{world, loaded->machine};
    auto lines = SimLines::open(loaded->machine, world, options.serial);
    if (!lines) {
        print_error(lines.error());
        return exit_usage;
    }
    for (const auto& fault : options.faults)
        if (const auto done = commands.inject(fault, start); !done) {
            print_error(done.error());
            return exit_usage;
        }
    LineInput input{STDIN_FILENO};
    Carriers carriers{ends, world};
    for (const auto& line : (*lines)->lines()) fmt::print("serial line '{}' is {}\n", line.name, line.path);
    fmt::print("{} of '{}' on {}; `help` lists what can go wrong; Ctrl-C ends\n", count_text(network.size(), "slave"), loaded->machine.name,
               options.nic + (options.nic2.empty() ? "" : " and " + options.nic2));
    std::fflush(stdout);

    std::array<std::byte, ecat::max_frame_size> frame{};
    std::uint64_t frames = 0, answers = 0;
    bool wanted = true;
    while (wanted && !stop_requested()) {
        Instant now = clock.now();
        if (options.duration_s > 0 && to_seconds(now - start) > options.duration_s) break;
        Instant next = std::min(network.next_event(), commands.next_event());
        for (const auto& end : ends) next = std::min(next, end.cable->next_arrival().value_or(Instant::max()));
        const Duration wait = std::clamp(next - now, Duration{}, Duration{std::chrono::milliseconds{10}});
        std::vector<pollfd> ready{{input.descriptor(), POLLIN, 0}};
        for (const auto& end : ends) ready.push_back({end.nic->descriptor(), POLLIN, 0});
        (*lines)->add_to(ready);
        timespec timeout{0, static_cast<long>(wait.count())};
        ::ppoll(ready.data(), ready.size(), &timeout, nullptr);
        now = clock.now();
        world.apply_events(now);
        carriers.step(now);
        commands.step(now);
        network.advance(now);
        const auto return_all = [&] {
            for (const auto& end : ends) answers += return_answers(*end.cable, *end.nic, clock);
        };
        for (const auto& end : ends)
            while (auto received = end.nic->receive(frame, now)) {
                end.cable->send(std::span{frame}.first(received->size), now);
                ++frames;
                return_all();
                now = clock.now();
            }
        return_all();
        (*lines)->step(clock.now());
        while (const auto line = input.next()) wanted = wanted && commands.obey(*line, clock.now());
        log.step();
    }
    fmt::print("{} frames came, {} answers went back\n", frames, answers);
    for (std::size_t i = 0; i < network.size(); ++i)
        if (const auto missed = network.slave(i).missed_outputs())
            fmt::print("slave {} '{}': {} SYNC0 pulses found no new outputs\n", i, network.slave(i).options().name, missed);
    return exit_ok;
}

}  // namespace

void add_sim(CLI::App& app, Action& action) {
    auto* sub = app.add_subcommand("sim", "play the slaves of a machine file on a network interface, for any EtherCAT master");
    auto options = std::make_shared<SimOptions>();
    sub->add_option("FILE", options->file, "machine file")->required();
    sub->add_option("--nic", options->nic, "network interface, e.g. eth1")->required();
    sub->add_option("--nic2", options->nic2, "where the ring of the file comes back, e.g. eth2");
    sub->add_flag("--strict", options->strict, "slaves that need SYNC0 refuse SAFEOP without it, as real ones do");
    sub->add_option("--fault", options->faults, "what goes wrong: a command as on standard input; may be given several times")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    sub->add_option("--serial", options->serial, "LINE=PATH: a link to the pseudo-terminal that plays this serial line")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    add_duration(*sub, "--duration", options->duration_s, "default: until Ctrl-C");
    sub->callback([&action, options] { action = [options] { return play(*options); }; });
}

}  // namespace taktwerk::apps
