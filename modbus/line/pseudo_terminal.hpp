#pragma once
// Stations on a pseudo-terminal: any Modbus program opens the path like a serial port and finds the simulated drives there. Frames end by their
// length where the function is known, else by silence: a pseudo-terminal has no byte times. Never waits; one thread, not real-time.

#include <memory>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "modbus/line/station.hpp"

namespace taktwerk::modbus {

class PseudoTerminal {
public:
    /// Error: serial.pseudo_terminal.
    static Result<std::unique_ptr<PseudoTerminal>> open(const LineSettings& settings);
    ~PseudoTerminal();
    PseudoTerminal(const PseudoTerminal&) = delete;
    PseudoTerminal& operator=(const PseudoTerminal&) = delete;

    /// What the program from outside opens: "/dev/pts/7".
    [[nodiscard]] const std::string& path() const noexcept { return path_; }
    /// For poll(2).
    [[nodiscard]] int descriptor() const noexcept { return master_; }
    /// Outlives this.
    void connect(Station& station) { stations_.push_back(&station); }
    /// From now on nothing that is said gets through, until it is plugged again.
    void cut(bool is) noexcept { cut_ = is; }
    /// Stations live on, what was asked is answered.
    void step(Instant now);

private:
    PseudoTerminal() = default;
    void answer(Instant now);

    int master_ = -1, slave_ = -1;  // the slave side stays open: else the master reads EIO between two clients
    std::string path_;
    LineSettings settings_;
    std::vector<Station*> stations_;
    Frame heard_;
    Instant last_byte_{};
    bool cut_ = false;
};

}  // namespace taktwerk::modbus
