#pragma once
// One serial line while a command lasts: the port, or the simulated line of a machine file in virtual time. Asks and waits for the answer.

#include <memory>

#include "core/clock.hpp"
#include "core/result.hpp"
#include "modbus/client/client.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::apps {

class LineSession {
public:
    /// A port of this PC. Errors: serial.open, serial.settings.
    static Result<std::unique_ptr<LineSession>> open(const std::string& device, const modbus::LineSettings& settings);
    /// Line `index` of a machine, with its drives, switched on two seconds ago.
    static std::unique_ptr<LineSession> simulate(const runtime::MachineConfig& machine, std::size_t index);
    ~LineSession();

    /// Waits for the answer, or that there is none. Error bus.interrupted: Ctrl-C.
    [[nodiscard]] Result<modbus::Answer> ask(const modbus::Request& request);
    /// False: Ctrl-C.
    bool wait(Duration time);
    /// From now on Ctrl-C holds nothing back.
    void finish_undisturbed() noexcept { undisturbed_ = true; }
    [[nodiscard]] Instant now() const noexcept;

private:
    LineSession();
    bool tick();

    struct Parts;
    std::unique_ptr<Parts> parts_;
    bool undisturbed_ = false;
};

}  // namespace taktwerk::apps
