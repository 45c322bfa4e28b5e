#pragma once
// What happens to a simulated machine beyond its bus, on command: a drive's fault, power, mechanics, inputs, serial lines. The words are
// those of `simulation: events` in a machine file, with dashes. Not real-time.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"
#include "runtime/world/world.hpp"

namespace taktwerk::apps {

struct HappeningWord {
    std::string_view word, arguments, effect;
    runtime::SimulationEvent::Kind kind;
    std::int64_t value;
};
[[nodiscard]] std::span<const HappeningWord> happening_words() noexcept;

/// "drive-fault sv33 0x3130", "line-cut rs485", "input estop_ok 0"; any of them may begin with a delay, as "after 2s jam x". `at` is
/// that delay. Errors: fault.unknown (another word), fault.arguments, fault.no_target (with the names there are).
[[nodiscard]] Result<runtime::SimulationEvent> parse_happening(std::string_view line, const runtime::MachineConfig& machine);

/// Lets them happen when their time has come.
class Happenings {
public:
    /// `world` outlives it.
    explicit Happenings(runtime::World& world) : world_(world) {}
    void take(runtime::SimulationEvent event, Instant now);
    void step(Instant now);
    /// Instant::max(): nothing waits.
    [[nodiscard]] Instant next_event() const noexcept;

private:
    struct Waiting {
        runtime::SimulationEvent event;
        Instant at;
    };
    runtime::World& world_;
    std::vector<Waiting> waiting_;  // in the order in which they were asked for
};

}  // namespace taktwerk::apps
