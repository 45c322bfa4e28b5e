#pragma once
// The serial lines of a simulated machine as pseudo-terminals: whoever opens one finds its drives. Not real-time.

#include <poll.h>

#include <memory>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"
#include "modbus/line/pseudo_terminal.hpp"
#include "runtime/world/world.hpp"

namespace taktwerk::apps {

class SimLines {
public:
    /// One for each line of `machine`. `links`: "rs485=/tmp/rs485" makes a symbolic link there to the line's terminal, for a machine file
    /// that names the device; it goes with this object. `world` outlives it.
    /// Errors: serial.pseudo_terminal, sim.line (no such line, or the link cannot be made).
    static Result<std::unique_ptr<SimLines>> open(const runtime::MachineConfig& machine, runtime::World& world,
                                                  const std::vector<std::string>& links);
    ~SimLines();
    SimLines(const SimLines&) = delete;
    SimLines& operator=(const SimLines&) = delete;

    struct Line {
        std::string name, path;  ///< path: the link where there is one
        std::unique_ptr<modbus::PseudoTerminal> terminal;
    };
    [[nodiscard]] const std::vector<Line>& lines() const noexcept { return lines_; }
    /// Drives live on, what was asked is answered; nothing on a line that an event has cut.
    void step(Instant now);
    void add_to(std::vector<pollfd>& waiting) const;

private:
    explicit SimLines(runtime::World& world) : world_(world) {}
    [[nodiscard]] Result<void> link(const std::string& assignment);

    runtime::World& world_;
    std::vector<Line> lines_;
    std::vector<std::string> links_;
};

}  // namespace taktwerk::apps
