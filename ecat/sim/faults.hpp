#pragma once
// What can go wrong, on demand: one list for tests, for a campaign and for the command line. A fault is a value; FaultInjector
// makes it happen to a simulated network and the cable that leads to it. Not real-time. The words are those of `taktwerk sim`.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"
#include "ecat/sim/sim_network.hpp"
#include "ecat/transport/loopback.hpp"

namespace taktwerk::ecat::sim {

enum class FaultKind : std::uint8_t {
    unplug,
    plug,
    power_off,
    power_on,
    power_cycle,
    drop,
    drop_answers,
    duplicate,
    delay,
    reorder,
    corrupt,
    noise,
    stick_mailbox,
    wrong_length,
    refuse,
    abort,
    hang,
    drift,
    clock_step,
    forget_address,
};

/// One thing that goes wrong. Only the fields that its kind names in fault_commands() count.
struct Fault {
    FaultKind kind{};
    Duration after{};         ///< happens so much later than it was asked for
    std::string slave{};      ///< name; `master` (unplug, plug): the cable at the master's own port
    std::uint32_t count = 1;  ///< frames, or mailbox answers
    Duration time{};          ///< delay; how long the power is away; by how much the clock jumps
    std::uint32_t bit = 0;    ///< corrupt: which bit of the frame flips (modulo its size)
    bool on = true;           ///< stick_mailbox, hang, refuse, abort: false ends it
    EsmState state{};         ///< refuse
    std::uint16_t al_code = 0;
    std::uint16_t index = 0;  ///< abort
    std::uint8_t sub = 0;
    std::uint32_t abort_code = 0;
    double drift_ppm = 0;  ///< of the quartz from now on
};

/// One word of the language: how it is written, and what it does.
struct FaultCommand {
    FaultKind kind;
    std::string_view word;
    std::string_view arguments;
    std::string_view effect;
};
[[nodiscard]] std::span<const FaultCommand> fault_commands() noexcept;

/// "unplug y_drive", "drop 5", "delay 3 5ms", "refuse x_drive OP 0x001B"; any of them may begin with a delay: "after 2s unplug
/// y_drive". Errors (with what was meant, where it can be guessed):
/// fault.unknown, fault.arguments.
[[nodiscard]] Result<Fault> parse_fault(std::string_view text);

class FaultInjector {
public:
    /// Both outlive it.
    FaultInjector(SimNetwork& network, FaultPlan& cable) : network_(network), cable_(cable) {}

    /// Makes it happen at `now`, or lets it wait for its time. Errors: fault.no_slave (with a suggestion), fault.no_mailbox.
    [[nodiscard]] Result<void> apply(const Fault& fault, Instant now);
    /// Does what waited for its time.
    void step(Instant now);
    /// When something waits next; Instant::max(): nothing.
    [[nodiscard]] Instant next_event() const noexcept;

private:
    [[nodiscard]] Result<void> happen(const Fault& fault, Instant now);
    [[nodiscard]] Result<SimSlave*> find(const std::string& name);
    [[nodiscard]] Result<void> happen_to(SimSlave& slave, const Fault& fault, Instant now);

    struct Waiting {
        Fault fault;
        Instant at;
    };
    SimNetwork& network_;
    FaultPlan& cable_;
    std::vector<Waiting> waiting_;  // in the order in which they were asked for
};

}  // namespace taktwerk::ecat::sim
