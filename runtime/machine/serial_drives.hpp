#pragma once
// The drives on serial lines: their lines, the outputs that watch over them, what they say in the recording.

#include <memory>
#include <string>
#include <vector>

#include "axes/drives/xp200/drive_line.hpp"
#include "core/result.hpp"
#include "modbus/line/serial_line.hpp"
#include "runtime/machine/machine_body.hpp"

namespace taktwerk::runtime {

class SerialDrives {
public:
    /// `serial_lines`: one per line of the configuration, nullptr where nobody needs it. An axis that believes to move while no line carries
    /// its speeds would be worse than none: an error.
    SerialDrives(MachineBody& body, const std::vector<modbus::SerialLine*>& serial_lines, std::vector<Error>& errors);

    /// The drive of `config.axes[axis]`; nullptr: it is on no line, or simulated.
    [[nodiscard]] std::unique_ptr<axes::DrivePort> drive_of(std::size_t axis);

    /// Service side.
    void step(Instant now);
    /// In the place of a line: what a recording has. False: there is no such drive.
    [[nodiscard]] bool replay(std::uint16_t drive, const axes::xp200::Sample& sample) noexcept;
    /// " of line 'rs485' (/dev/ttyUSB0, 38400 baud, 8E1)"; for words, not real-time.
    [[nodiscard]] std::string line_of(std::size_t axis) const;
    [[nodiscard]] bool has_lines() const noexcept { return !lines_.empty(); }

    // --- cycle ----------------------------------------------------------------------------------------------------------------
    /// What they have said since the last cycle, into the recording.
    void record() noexcept;
    /// What they are asked for, where that is new.
    void record_wishes() noexcept;
    /// Alarms of those that are silent or not ready for long.
    void watch() noexcept;
    /// The outputs that watch over the lines.
    void hold_watchdog_outputs() noexcept;

private:
    static constexpr int no_output = -1;
    struct Place {
        axes::xp200::Xp200Drive* drive = nullptr;
        std::uint16_t axis = 0;
        std::uint8_t station = 0;
        std::uint32_t recorded = 0;  // number of the newest sample in the recording
        std::uint32_t wish = 0;      // and of the newest wish
        Instant online{};            // last; before that since when it is waited for
        int watchdog = no_output;    // of io
    };
    MachineBody& body_;
    std::vector<std::unique_ptr<axes::xp200::DriveLine>> lines_;  // as config.serial; nullptr: nobody needs it
    std::vector<Place> drives_;
};

}  // namespace taktwerk::runtime
