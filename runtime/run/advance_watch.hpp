#pragma once
// Seen from outside the cycle: does it advance? A base task that never returns takes the cycle with it, and every value that the cycle
// has published last goes on looking alive. Whoever looks here can say so, and by name.

#include <cstdint>
#include <optional>
#include <string>

#include "core/time.hpp"
#include "runtime/machine/machine.hpp"

namespace taktwerk::runtime {

/// The cycle does not advance.
struct StuckCycle {
    Duration lasts{};           ///< since it was last seen to advance
    std::string program, task;  ///< whose code it is in; empty: not in a program's
    /// One sentence, e.g. for people who wait.
    [[nodiscard]] std::string text() const;
};

/// One for each thread that wants to know. Component: look() often, at least a few times within patience().
class AdvanceWatch {
public:
    explicit AdvanceWatch(const Machine& machine);
    [[nodiscard]] std::optional<StuckCycle> look(Instant now);
    /// So long nobody says anything: far beyond what overruns and lateness report, short against a person's patience.
    [[nodiscard]] Duration patience() const noexcept { return patience_; }

private:
    const Machine& machine_;
    Duration patience_;
    std::uint64_t seen_ = 0;
    Instant advanced_{}, looked_{};
    bool first_ = true;
};

}  // namespace taktwerk::runtime
