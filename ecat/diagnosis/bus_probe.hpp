#pragma once
// A bus in an engineer's hands: runs one script after the other on it, first without process data (pump), after bring_up()
// inside a running cycle. Service side and cycle in one thread; time comes from the caller, so that the same code asks a
// real bus and one in virtual time. Not real-time.
//
//     BusProbe probe{transport, {}, [&](Duration period) { clock.advance(period); return std::optional{clock.now()}; }};
//     Result<Survey> found = probe.run(survey(probe.port()));

#include <functional>
#include <optional>

#include "core/result.hpp"
#include "core/time.hpp"
#include "ecat/bringup/bus.hpp"
#include "ecat/master.hpp"
#include "ecat/script/script.hpp"
#include "ecat/script/waits.hpp"

namespace taktwerk::ecat {

class BusProbe {
public:
    /// Lets `period` pass and gives the time then. Nothing: the user wants to end.
    using NextRound = std::function<std::optional<Instant>(Duration period)>;

    /// `transport` outlives the probe. An empty configuration is enough for everything but bring_up().
    BusProbe(Transport& transport, BusConfig config, NextRound next_round);

    [[nodiscard]] Master& master() noexcept { return master_; }
    [[nodiscard]] Bus& bus() noexcept { return master_.bus(); }
    [[nodiscard]] DatagramPort& port() noexcept;

    /// Runs a script to its end. Error bus.interrupted when the user ended it.
    template <class T>
    [[nodiscard]] Result<T> run(Script<Result<T>> script) {
        BasicRunner<Result<T>> runner{std::move(script)};
        for (;;) {
            const std::optional<Instant> now = next_round();
            if (!now) return interrupted();
            runner.step(*now);
            if (runner.done()) return runner.result();
        }
    }

    /// Starts the master and its cycle and waits for OP, or for the reason why not. The cycle then runs on in run() and run_for().
    [[nodiscard]] Result<void> bring_up();
    /// Lets time pass; the cycle runs if it runs.
    [[nodiscard]] Result<void> run_for(Duration length);
    /// In order down to INIT.
    [[nodiscard]] Result<void> take_down();
    /// Says nothing for so long and counts the EtherCAT frames of others. More than 0: another master is on this cable.
    [[nodiscard]] Result<std::uint64_t> listen(Duration length);

private:
    [[nodiscard]] std::optional<Instant> next_round();
    [[nodiscard]] static Error interrupted();

    BusConfig config_;
    Master master_;
    NextRound next_round_;
    bool cycling_ = false;
};

/// Between two looks at the wire while no cycle runs.
inline constexpr Duration pump_period = std::chrono::microseconds{50};

}  // namespace taktwerk::ecat
